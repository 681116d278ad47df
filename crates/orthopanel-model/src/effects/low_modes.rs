//! The lowest modes of a structure, and what all its others do under forces that stand still.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use faer::Mat;

use super::row::{Row, coordinate_rows};
use crate::dense::{dot, product};
use crate::ritz_modes::{checked_coefficients, ritz_modes};
use crate::static_deflection::StaticSolution;
use crate::structure::{Block, Structure};
use crate::{ModelError, RitzMode};

/// The lowest modes of a structure at some values of its constants: rigid ones first, then rising.
#[derive(Debug, Default)]
pub(crate) struct LowModes {
    /// Block, coordinates and $\omega^2$ of each.
    pub modes: Vec<(usize, Vec<f64>, f64)>,
    /// How many are rigid.
    pub rigid: usize,
    beyond: OnceLock<Vec<Beyond>>,
    /// What forces at ports do, found last: a search moves what stands on a panel more often than its constants.
    answered: Mutex<Vec<Arc<Answered>>>,
}

/// Sets of ports that are kept: a sensor that loads a panel has one at each of its places.
const KEPT: usize = 8;

/// What the modes beyond [`LowModes`] do under unit forces in some rows.
pub(super) struct FarAnswers {
    /// $\phi_m(p)$ of the low modes: a row a mode, a column a row $p$.
    pub near: Mat<f64>,
    /// $C_0 = \sum\phi_m(p)\phi_m(q)/\omega_m^2$ over the modes beyond, a row a row $p$ and a column one that forces act in, and $C_1$ with
    /// $\omega_m^4$ between the latter.
    pub series: [Mat<f64>; 2],
    /// What follows where something swings in the first of these rows; none where nothing does.
    pub second: SecondShapes,
    of: [Arc<Answered>; 2],
}

impl FarAnswers {
    /// $\sum\phi_m\phi_m(p)/\omega_m^2$ of a row that a force acts in, in the coordinates of each block.
    pub(super) fn shape(&self, row: usize) -> Vec<Vec<f64>> {
        let first = self.of[0].pushed;
        let (of, column) = if row < first { (&self.of[0], row) } else { (&self.of[1], row - first) };
        of.moved.iter().map(|moved| moved.col_as_slice(column).to_vec()).collect()
    }
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

/// Rows, in the first of which forces act.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub elements: &'a [Row],
    pub ports: &'a [Row],
    /// Where no force acts.
    pub watched: &'a [Row],
    /// So many of the elements have second shapes.
    pub twice: usize,
}

/// The modes of a block beyond the lowest.
#[derive(Debug)]
struct Beyond {
    /// Numbers of the low modes in this block, and their shapes, a column each; $M$ times these.
    own: Vec<usize>,
    shapes: Mat<f64>,
    images: Mat<f64>,
    whole: StaticSolution,
}

/// What forces in some rows do.
#[derive(Debug)]
struct Answered {
    rows: Vec<Row>,
    /// Rows that forces act in: the first ones.
    pushed: usize,
    near: Mat<f64>,
    /// Of each block the rows, a column each; what the modes beyond do under the forces, and $M$ times that.
    forces: Vec<Mat<f64>>,
    moved: Vec<Mat<f64>>,
    swinging: Vec<Mat<f64>>,
    series: [Mat<f64>; 2],
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
        Self::sorted(modes.into_iter().map(kept).collect(), rigid)
    }

    /// Block, coordinates and $\omega^2$ of each, of which the first are rigid.
    pub(super) fn sorted(modes: Vec<(usize, Vec<f64>, f64)>, rigid: usize) -> Self {
        Self { modes, rigid, ..Self::default() }
    }

    /// What the modes beyond these do in some rows, with second shapes of the first few: without them, by the structure's stiffness and these modes
    /// alone. What the basis is known to lack of $C_0$ and $C_1$ is added. `structure` and `values` are those of which these are the modes.
    pub(super) fn far_answers(
        &self,
        structure: &dyn Structure,
        values: &[f64],
        asked: Asked,
    ) -> Result<FarAnswers, ModelError> {
        let pushed = asked.elements.len() + asked.ports.len();
        let beyond = if pushed > 0 { self.beyond(structure, values)? } else { &[] };
        let standing = Arc::new(self.answered((structure, values), (asked.elements, asked.elements.len()), beyond)?);
        let seen = self.at_ports((structure, values), asked, beyond)?;
        let sum = |one: &[Mat<f64>], other: &[Mat<f64>]| -> Option<Mat<f64>> {
            let products = one.iter().zip(other).map(|(a, b)| product(a.transpose(), b.as_ref()));
            products.reduce(|sum, product| sum + product)
        };
        let none = || Mat::zeros(seen.rows.len(), asked.elements.len());
        let mut across = sum(&seen.forces, &standing.moved).unwrap_or_else(none);
        if let Some(lacking) = structure.static_remainders(values, [&seen.rows, asked.elements]) {
            across += lacking;
        }
        let swung = sum(&seen.swinging, &standing.moved).unwrap_or_else(|| Mat::zeros(seen.pushed, standing.pushed));
        let of_ports = across.subrows(0, seen.pushed);
        let mut answers = FarAnswers {
            near: faer::concat![[standing.near, seen.near]],
            series: [
                faer::concat![[standing.series[0], of_ports.transpose()], [across, seen.series[0]]],
                faer::concat![[standing.series[1], swung.transpose()], [swung, seen.series[1]]],
            ],
            second: SecondShapes {
                seen: Mat::zeros(standing.rows.len() + seen.rows.len(), asked.twice),
                coupled: Mat::zeros(pushed, asked.twice),
                mass: Mat::zeros(asked.twice, asked.twice),
            },
            of: [standing, seen],
        };
        if asked.twice > 0 {
            let [standing, seen] = &answers.of;
            for (index, (block, beyond)) in structure.blocks().iter().zip(beyond).enumerate() {
                let again = beyond.moved(standing.swinging[index].subcols(0, asked.twice).to_owned());
                let second = &mut answers.second;
                let along = |a: &Mat<f64>, b: &Mat<f64>| -> Mat<f64> {
                    let of = |matrix: &Mat<f64>| product(matrix.transpose(), again.as_ref());
                    faer::concat![[of(a)], [of(b)]]
                };
                second.seen += along(&standing.forces[index], &seen.forces[index]);
                second.coupled += along(&standing.swinging[index], &seen.swinging[index]);
                second.mass += product(again.transpose(), block.mass.times(&again).as_ref());
            }
        }
        let rows = [asked.elements, asked.ports, asked.watched].concat();
        self.close((structure, values), (&rows, asked.elements.len()), &mut answers);
        Ok(answers)
    }

    /// The modes beyond these in each block.
    fn beyond(&self, structure: &dyn Structure, values: &[f64]) -> Result<&[Beyond], ModelError> {
        if let Some(beyond) = self.beyond.get() {
            return Ok(beyond);
        }
        let coefficients = checked_coefficients(structure, values)?;
        let of_block = |(index, block): (usize, &Block)| -> Result<Beyond, ModelError> {
            let own: Vec<usize> = (0..self.modes.len()).filter(|&m| self.modes[m].0 == index).collect();
            let shapes = Mat::from_fn(block.size(), own.len(), |i, m| self.modes[own[m]].1[i]);
            let images = block.mass.times(&shapes);
            Ok(Beyond { own, shapes, images, whole: StaticSolution::new(block, &coefficients)? })
        };
        let beyond = structure.blocks().iter().enumerate().map(of_block).collect::<Result<_, _>>()?;
        Ok(self.beyond.get_or_init(|| beyond))
    }

    /// At the ports, and where no force acts: kept for when they are asked for again.
    fn at_ports(
        &self,
        of: (&dyn Structure, &[f64]),
        asked: Asked,
        beyond: &[Beyond],
    ) -> Result<Arc<Answered>, ModelError> {
        let rows = [asked.ports, asked.watched].concat();
        let lock = || self.answered.lock().unwrap_or_else(PoisonError::into_inner);
        let is_asked = |answered: &&Arc<Answered>| {
            let is_of_rows = answered.rows == rows && answered.pushed == asked.ports.len();
            is_of_rows && answered.moved.len() == beyond.len()
        };
        if let Some(answered) = lock().iter().find(is_asked) {
            return Ok(Arc::clone(answered));
        }
        let mut answered = self.answered(of, (&rows, asked.ports.len()), beyond)?;
        let (structure, values) = of;
        if let Some(lacking) = structure.inertial_remainders(values, [asked.ports; 2]).first() {
            answered.series[1] += lacking;
        }
        let answered = Arc::new(answered);
        let mut kept = lock();
        kept.truncate(KEPT - 1);
        kept.insert(0, Arc::clone(&answered));
        Ok(answered)
    }

    /// In rows, in the first of which forces act.
    fn answered(
        &self,
        (structure, values): (&dyn Structure, &[f64]),
        (rows, pushed): (&[Row], usize),
        beyond: &[Beyond],
    ) -> Result<Answered, ModelError> {
        let mut answered = Answered {
            rows: rows.to_vec(),
            pushed,
            near: Mat::zeros(self.modes.len(), rows.len()),
            forces: vec![],
            moved: vec![],
            swinging: vec![],
            series: [Mat::zeros(rows.len(), pushed), Mat::zeros(pushed, pushed)],
        };
        for (index, block) in structure.blocks().iter().enumerate() {
            let forces = coordinate_rows(structure, (index, block.size()), rows)?.transpose().to_owned();
            let Some(beyond) = beyond.get(index) else {
                for (m, mode) in self.modes.iter().enumerate().filter(|(_, mode)| mode.0 == index) {
                    (0..rows.len()).for_each(|p| answered.near[(m, p)] = dot(forces.col_as_slice(p), &mode.1));
                }
                continue;
            };
            let seen = product(beyond.shapes.transpose(), forces.as_ref());
            for (i, &m) in beyond.own.iter().enumerate() {
                (0..rows.len()).for_each(|p| answered.near[(m, p)] = seen[(i, p)]);
            }
            let moved = beyond.moved(forces.subcols(0, pushed).to_owned());
            let swinging = block.mass.times(&moved);
            answered.series[0] += product(forces.transpose(), moved.as_ref());
            answered.series[1] += product(moved.transpose(), swinging.as_ref());
            answered.forces.push(forces);
            answered.moved.push(moved);
            answered.swinging.push(swinging);
        }
        if let Some(lacking) = structure.static_remainders(values, [rows, &rows[..pushed]]) {
            answered.series[0] += lacking;
        }
        Ok(answered)
    }

    /// Puts the exact static flexibility in place of the basis' own, where the structure knows it; adds what the basis is known to lack of $C_1$ and
    /// the further terms between the first `elements` of the rows and all.
    fn close(
        &self,
        (structure, values): (&dyn Structure, &[f64]),
        (rows, elements): (&[Row], usize),
        answers: &mut FarAnswers,
    ) {
        let near = &answers.near;
        let [far, inertia] = &mut answers.series;
        let pushed = far.ncols();
        let second = &mut answers.second;
        let twice = second.mass.ncols();
        let lacking =
            if elements > 0 { structure.inertial_remainders(values, [rows, &rows[..elements]]) } else { vec![] };
        for (power, lacking) in lacking.iter().enumerate() {
            let of_few = lacking.subcols(0, twice);
            match power {
                0 => {
                    let mut along = inertia.subcols_mut(0, elements);
                    along += lacking.subrows(0, pushed);
                    let ports = elements..pushed;
                    let mut across = inertia.submatrix_mut(0, ports.start, elements, ports.len());
                    across += lacking.subrows(ports.start, ports.len()).transpose();
                    second.seen += of_few;
                }
                1 => second.coupled += of_few.subrows(0, pushed),
                _ => second.mass += of_few.subrows(0, twice),
            }
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

impl Beyond {
    /// $\sum\phi_m\phi_m^Tf/\omega_m^2$ over the modes beyond the lowest, a column a force: the deflection under the part of the forces that
    /// moves none of the lowest.
    fn moved(&self, forces: Mat<f64>) -> Mat<f64> {
        // A force on a line of symmetry moves nothing that is odd about it.
        if (0..forces.ncols()).all(|force| forces.col_as_slice(force).iter().all(|value| *value == 0.0)) {
            return forces;
        }
        let shares = product(self.shapes.transpose(), forces.as_ref());
        let mut moved = self.whole.of(forces - product(self.images.as_ref(), shares.as_ref()));
        moved -= product(self.shapes.as_ref(), product(self.images.transpose(), moved.as_ref()).as_ref());
        moved
    }
}
