//! The lowest modes of a structure, and what all its others do under forces that stand still.

use faer::Mat;

use super::row::{Row, coordinate_rows};
use crate::dense::product;
use crate::ritz_modes::{checked_coefficients, ritz_modes};
use crate::static_deflection::deflected;
use crate::structure::{Block, Structure};
use crate::{ModelError, RitzMode};

/// The lowest modes of a structure at some values of its constants: rigid ones first, then rising.
#[derive(Debug, Clone)]
pub(crate) struct LowModes {
    /// Block, coordinates and $\omega^2$ of each.
    pub modes: Vec<(usize, Vec<f64>, f64)>,
    /// How many are rigid.
    pub rigid: usize,
}

/// What the modes beyond [`LowModes`] do under unit forces in some rows.
pub(super) struct FarAnswers {
    /// $\phi_m(p)$ of the low modes: a row a mode, a column a row $p$.
    pub near: Mat<f64>,
    /// $C_0 = \sum\phi_m(p)\phi_m(q)/\omega_m^2$ over the modes beyond, a row a row $p$ and a column one that forces act in, and $C_1$ with
    /// $\omega_m^4$ between the latter.
    pub series: [Mat<f64>; 2],
    /// $\sum\phi_m\phi_m(p)/\omega_m^2$ of each row, in the coordinates of each block.
    pub shapes: Vec<Vec<Vec<f64>>>,
    /// What follows where something swings in the first of these rows; none where nothing does.
    pub second: SecondShapes,
}

/// The shapes $\sum\phi_m\phi_m(p)/\omega_m^4$ of a few rows, by which forces at $s$ are answered to $s^4$: with $C_k =
/// \sum\phi_m(p)\phi_m(q)/\omega_m^{2+2k}$.
pub(super) struct SecondShapes {
    /// $C_1$: a row a row, a column one of the few.
    pub seen: Mat<f64>,
    /// $C_2$ between the rows that forces act in and the few.
    pub coupled: Mat<f64>,
    /// $C_3$ between the few.
    pub mass: Mat<f64>,
}

impl LowModes {
    /// The rigid modes and `count` flexible ones.
    pub(super) fn new(structure: &dyn Structure, values: &[f64], count: usize) -> Result<Self, ModelError> {
        Ok(Self::of(ritz_modes(structure, values, count)?))
    }

    /// These modes, which are the lowest, rigid ones first.
    pub(super) fn of(modes: Vec<RitzMode>) -> Self {
        let rigid = modes.iter().take_while(|mode| mode.angular_frequency == 0.0).count();
        let kept = |RitzMode { block, coordinates, angular_frequency }| (block, coordinates, angular_frequency.powi(2));
        Self { modes: modes.into_iter().map(kept).collect(), rigid }
    }

    /// What the modes beyond these do in some rows, under forces in the first of them, so many as are `pushed`, with second shapes of the first
    /// `twice`: without them, by the structure's stiffness and these modes alone. What the basis is known to lack of $C_0$ and $C_1$ is added.
    pub(super) fn far_answers(
        &self,
        structure: &dyn Structure,
        values: &[f64],
        rows: &[Row],
        [pushed, twice]: [usize; 2],
    ) -> Result<FarAnswers, ModelError> {
        let coefficients = checked_coefficients(structure, values)?;
        let (modes, count) = (self.modes.len(), rows.len());
        let mut answers = FarAnswers {
            near: Mat::zeros(modes, count),
            series: [Mat::zeros(count, pushed), Mat::zeros(pushed, pushed)],
            shapes: vec![vec![]; pushed],
            second: SecondShapes {
                seen: Mat::zeros(count, twice),
                coupled: Mat::zeros(pushed, twice),
                mass: Mat::zeros(twice, twice),
            },
        };
        for (index, block) in structure.blocks().iter().enumerate() {
            let own: Vec<usize> = (0..modes).filter(|&m| self.modes[m].0 == index).collect();
            let shapes = Mat::from_fn(block.size(), own.len(), |i, m| self.modes[own[m]].1[i]);
            let forces = coordinate_rows(structure, (index, block.size()), rows)?.transpose().to_owned();
            let seen = product(shapes.transpose(), forces.as_ref());
            for (i, &m) in own.iter().enumerate() {
                (0..count).for_each(|p| answers.near[(m, p)] = seen[(i, p)]);
            }
            if pushed == 0 {
                continue;
            }
            let moved = beyond(block, &coefficients, &shapes, &forces.subcols(0, pushed).to_owned())?;
            answers.series[0] += product(forces.transpose(), moved.as_ref());
            let swinging = block.mass.times(&moved);
            answers.series[1] += product(moved.transpose(), swinging.as_ref());
            if twice > 0 {
                let again = beyond(block, &coefficients, &shapes, &swinging.subcols(0, twice).to_owned())?;
                let second = &mut answers.second;
                second.seen += product(forces.transpose(), again.as_ref());
                second.coupled += product(swinging.transpose(), again.as_ref());
                second.mass += product(again.transpose(), block.mass.times(&again).as_ref());
            }
            for (p, shapes) in answers.shapes.iter_mut().enumerate() {
                shapes.push(moved.col_as_slice(p).to_vec());
            }
        }
        self.close(structure, values, rows, &mut answers);
        Ok(answers)
    }

    /// Puts the exact static flexibility in place of the basis' own, where the structure knows it, else adds what the basis
    /// is known to lack; adds what it lacks of $C_1$.
    fn close(&self, structure: &dyn Structure, values: &[f64], rows: &[Row], answers: &mut FarAnswers) {
        let near = &answers.near;
        let [far, inertia] = &mut answers.series;
        let pushed = far.ncols();
        let second = &mut answers.second;
        let twice = second.mass.ncols();
        for (power, lacking) in structure.inertial_remainders(values, &rows[..pushed]).iter().enumerate() {
            let of_few = lacking.subcols(0, twice);
            match power {
                0 => {
                    *inertia += lacking;
                    let mut seen = second.seen.subrows_mut(0, pushed);
                    seen += of_few;
                }
                1 => second.coupled += of_few,
                _ => second.mass += of_few.subrows(0, twice),
            }
        }
        if let Some(lacking) = structure.static_remainders(values, rows) {
            *far += lacking.subcols(0, pushed);
            return;
        }
        for (p, &first) in rows.iter().enumerate() {
            for (q, &second) in rows[..pushed].iter().enumerate() {
                if let Some(whole) = structure.static_flexibility(values, [first, second]) {
                    let flexible = self.modes.iter().enumerate().skip(self.rigid);
                    let summed: f64 = flexible.map(|(m, mode)| near[(m, p)] * near[(m, q)] / mode.2).sum();
                    far[(p, q)] = whole - summed;
                }
            }
        }
    }
}

/// $\sum\phi_m\phi_m^Tf/\omega_m^2$ over the modes of a block but these, a column a force: the deflection under the part of the
/// forces that moves none of these.
fn beyond(block: &Block, coefficients: &[f64], modes: &Mat<f64>, forces: &Mat<f64>) -> Result<Mat<f64>, ModelError> {
    let images = block.mass.times(modes);
    let pushed = forces - product(images.as_ref(), product(modes.transpose(), forces.as_ref()).as_ref());
    let mut moved = deflected(block, coefficients, pushed)?;
    moved -= product(modes.as_ref(), product(images.transpose(), moved.as_ref()).as_ref());
    Ok(moved)
}
