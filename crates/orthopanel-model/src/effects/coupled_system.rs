//! Stiffness, mass and damping of a panel with effects, and its modes.

use faer::Mat;

use super::beam_base::InShapes;
use super::low_modes::{FarAnswers, LowModes};
use super::{ElementLaw, PointElement};
use crate::dense::{Cholesky, dot, symmetric_eigen};
use crate::order::{sorted, sorted_modes};
use crate::{Damping, ModelError};

/// $\omega$, $\zeta$ and all coordinates of a mode.
pub(super) type FoundMode = (f64, f64, Vec<f64>);

/// Stiffness, mass and damping in the coordinates of a [`CoupledPanel`](super::coupled_panel::CoupledPanel).
pub(super) struct System {
    pub(super) stiffness: Mat<f64>,
    pub(super) mass: Mat<f64>,
    pub(super) damping: Mat<f64>,
    /// Where the residual shapes begin.
    pub(super) residuals: usize,
    /// Coordinates that stand for the panel; the resonators' and those of a core follow.
    pub(super) panel: usize,
    /// A frequency squared of the size of the lowest.
    pub(super) shift: f64,
}

impl System {
    /// Of the modes alone.
    pub(super) fn without_elements(low: &LowModes, damping: &Damping) -> Self {
        let size = low.modes.len();
        let mut system = Self {
            stiffness: Mat::zeros(size, size),
            mass: Mat::identity(size, size),
            damping: Mat::zeros(size, size),
            residuals: size,
            panel: size,
            shift: low.modes.get(low.rigid).map_or(1.0, |mode| mode.2),
        };
        for (m, &(.., lambda)) in low.modes.iter().enumerate() {
            system.stiffness[(m, m)] = lambda;
            let zeta = if m < low.rigid { 0.0 } else { damping.ratio(m + 1 - low.rigid) };
            system.damping[(m, m)] = 2.0 * zeta * lambda.sqrt();
        }
        system
    }

    /// With these elements, which the first rows of `answers` belong to.
    pub(super) fn new(low: &LowModes, answers: &FarAnswers, elements: &[PointElement], damping: &Damping) -> Self {
        let ([first, second], again) = (&answers.series, &answers.second);
        let (count, twice) = (elements.len(), again.mass.nrows());
        let size = count + twice;
        let symmetric = |once: &Mat<f64>, mixed: &Mat<f64>, both: &dyn Fn(usize, usize) -> f64| {
            Mat::from_fn(size, size, |i, j| match (i.checked_sub(count), j.checked_sub(count)) {
                (None, None) => once[(i, j)],
                (None, Some(j)) => mixed[(i, j)],
                (Some(i), None) => mixed[(j, i)],
                (Some(i), Some(j)) => both(i, j),
            })
        };
        let stiffness = symmetric(first, &again.seen, &|i, j| again.coupled[(i, j)]);
        let mass = symmetric(second, &again.coupled, &|i, j| again.mass[(i, j)]);
        let far = |element: usize| {
            let once = (0..count).map(|b| first[(element, b)]);
            once.chain((0..twice).map(|b| again.seen[(element, b)])).collect()
        };
        Self::beyond(low, (size, &stiffness, &mass, None), (elements, &answers.near, far), damping)
    }

    /// With shapes beyond the modes, and these elements, which their first rows belong to.
    pub(super) fn in_shapes(low: &LowModes, shapes: &InShapes, elements: &[PointElement], damping: &Damping) -> Self {
        let InShapes { near, far, stiffness, mass, lost } = shapes;
        let far_of = |element: usize| far.col_as_slice(element).to_vec();
        Self::beyond(low, (far.nrows(), stiffness, mass, lost.as_ref()), (elements, near, far_of), damping)
    }

    /// With `count` coordinates beyond the modes, of these stiffnesses and masses; `lost` is taken from the stiffness of all. Where an element sits
    /// the modes have its column of `near`, and the others have `far`.
    fn beyond(
        low: &LowModes,
        (count, stiffness, mass, lost): (usize, &Mat<f64>, &Mat<f64>, Option<&Mat<f64>>),
        (elements, near, far): (&[PointElement], &Mat<f64>, impl Fn(usize) -> Vec<f64>),
        damping: &Damping,
    ) -> Self {
        let mut system = Self::without_elements(low, damping);
        let modes = system.panel;
        let resonators = elements.iter().filter(|element| matches!(element.law, ElementLaw::Resonator { .. })).count();
        let (panel, size) = (modes + count, modes + count + resonators);
        system.grow(size);
        system.panel = panel;
        for (a, b) in (0..count).flat_map(|a| (0..count).map(move |b| (a, b))) {
            system.stiffness[(modes + a, modes + b)] = stiffness[(a, b)];
            system.mass[(modes + a, modes + b)] = mass[(a, b)];
        }
        if let Some(lost) = lost {
            for (a, b) in (0..panel).flat_map(|a| (0..panel).map(move |b| (a, b))) {
                system.stiffness[(a, b)] -= lost[(a, b)];
            }
        }
        let mut resonators = panel..size;
        for (number, element) in elements.iter().enumerate() {
            let mut row = [near.col_as_slice(number), &far(number)].concat();
            row.resize(size, 0.0);
            system.join(element.law, row, &mut resonators);
        }
        system
    }

    /// Adds an element that sits where the coordinates have these values; a resonator takes the next of its coordinates.
    pub(super) fn join(&mut self, law: ElementLaw, mut row: Vec<f64>, resonators: &mut impl Iterator<Item = usize>) {
        match law {
            ElementLaw::Mass { mass: 0.0 } => {}
            ElementLaw::Mass { mass } => add(&mut self.mass, mass, &row),
            ElementLaw::Spring { stiffness, damping } => {
                add(&mut self.stiffness, stiffness, &row);
                add(&mut self.damping, damping, &row);
            }
            ElementLaw::Resonator { mass, frequency, zeta } => {
                let Some(own) = resonators.next() else { return };
                let omega = frequency * std::f64::consts::TAU;
                self.mass[(own, own)] += mass;
                row[own] = -1.0;
                add(&mut self.stiffness, mass * omega * omega, &row);
                add(&mut self.damping, 2.0 * zeta * mass * omega, &row);
            }
        }
    }

    /// $\omega$, $\zeta$ and all coordinates of each mode, rising, those that coincide part by part. As in [`crate::ritz_modes()`], by the inverse
    /// of a shifted stiffness; a mass matrix that negative masses make indefinite leaves modes without meaning, which go.
    pub(super) fn solve(&self) -> Result<Vec<FoundMode>, ModelError> {
        let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
        for part in uncoupled(&[&self.stiffness, &self.mass], &self.independent()) {
            self.solve_part(&part, &mut found)?;
        }
        // A coordinate without mass has none but rounding, and follows the others at once.
        let least = 1e-13 * found.iter().fold(0.0, |most: f64, (theta, _)| most.max(*theta));
        let damping = self.dampers();
        let omega = |theta: f64| {
            let lambda = 1.0 / theta - self.shift;
            // Rounding of a rigid mode.
            if lambda > 1e-9 * self.shift { lambda.sqrt() } else { 0.0 }
        };
        let found = found.into_iter().filter(|(theta, _)| *theta > least);
        let modes: Vec<(f64, Vec<f64>)> = found.map(|(theta, whole)| (omega(theta), whole)).collect();
        let mut modes = sorted_modes(modes, |(omega, _)| *omega);
        let rigid = modes.iter().take_while(|(omega, _)| *omega == 0.0).count();
        turn(&mut modes[..rigid]);
        let modes = modes.into_iter().map(|(omega, whole)| {
            let lost: f64 = damping.iter().map(|&(i, j, value)| whole[i] * value * whole[j]).sum();
            // Below zero by rounding, where nothing is lost.
            let zeta = if omega > 0.0 { (lost / (2.0 * omega)).clamp(0.0, 0.7) } else { 0.0 };
            (omega, zeta, whole)
        });
        Ok(modes.collect())
    }

    /// Adds $1/(\omega^2+\sigma)$ and all coordinates of each mode in which some coordinates alone move.
    fn solve_part(&self, kept: &[usize], found: &mut Vec<(f64, Vec<f64>)>) -> Result<(), ModelError> {
        let size = kept.len();
        let part = |matrix: &Mat<f64>| Mat::from_fn(size, size, |i, j| matrix[(kept[i], kept[j])]);
        let shifted = part(&self.stiffness) + faer::Scale(self.shift) * part(&self.mass);
        let scale: Vec<f64> = (0..size).map(|i| shifted[(i, i)].sqrt().recip()).collect();
        if scale.iter().any(|value| !value.is_finite()) {
            return Err(ModelError::Eigenproblem);
        }
        let scaled = |matrix: Mat<f64>| Mat::from_fn(size, size, |i, j| scale[i] * matrix[(i, j)] * scale[j]);
        let factor = Cholesky::new(&scaled(shifted)).ok_or(ModelError::Eigenproblem)?;
        let mut flexibility = scaled(part(&self.mass));
        factor.solve_lower(&mut flexibility);
        let mut flexibility = flexibility.transpose().to_owned();
        factor.solve_lower(&mut flexibility);
        let symmetric = Mat::from_fn(size, size, |i, j| 0.5 * (flexibility[(i, j)] + flexibility[(j, i)]));
        let (thetas, mut vectors) = symmetric_eigen(&symmetric).ok_or(ModelError::Eigenproblem)?;
        factor.solve_upper(&mut vectors);
        for (column, &theta) in thetas.iter().enumerate().rev().filter(|(_, theta)| **theta > 0.0) {
            let norm = theta.sqrt().recip();
            let mut whole = vec![0.0; self.mass.nrows()];
            (0..size).for_each(|i| whole[kept[i]] = norm * scale[i] * vectors[(i, column)]);
            found.push((theta, whole));
        }
        Ok(())
    }

    /// The entries of the damping matrix that are not zero: most are.
    fn dampers(&self) -> Vec<(usize, usize, f64)> {
        let size = self.damping.nrows();
        let all = (0..size).flat_map(|j| (0..size).map(move |i| (i, j)));
        all.map(|(i, j)| (i, j, self.damping[(i, j)])).filter(|entry| entry.2 != 0.0).collect()
    }

    /// The damping matrix in these modes, less $2\zeta\omega$ on its diagonal; rigid modes have none.
    pub(super) fn couplings(&self, modes: &[FoundMode]) -> Vec<Vec<f64>> {
        let damping = self.dampers();
        // What rounding leaves of a rigid mode, or of the diagonal.
        let rounding = 1e-12 * self.shift.sqrt();
        let mut rows = vec![vec![0.0; modes.len()]; modes.len()];
        let mut forces = vec![0.0; self.damping.nrows()];
        for (m, (omega, zeta, shape)) in modes.iter().enumerate() {
            forces.fill(0.0);
            damping.iter().for_each(|&(i, j, value)| forces[i] += value * shape[j]);
            for (n, (other, _, along)) in modes.iter().enumerate().take(m + 1) {
                let whole = dot(&forces, along);
                let rest = if n == m { whole - 2.0 * zeta * omega } else { whole };
                let rest = if *omega == 0.0 || *other == 0.0 || rest.abs() <= rounding { 0.0 } else { rest };
                (rows[m][n], rows[n][m]) = (rest, rest);
            }
        }
        rows
    }

    /// Coordinates without the residual shapes that others hold already, as of two elements at one place.
    pub(super) fn independent(&self) -> Vec<usize> {
        let size = self.stiffness.nrows();
        let first = self.residuals;
        let mut kept: Vec<usize> = (0..first).collect();
        // By Cholesky's factor of the scaled stiffness with pivots, a row each: the shape of which most is left beside those before it is next.
        let candidates: Vec<usize> = (first..self.panel).collect();
        let scale: Vec<f64> = candidates.iter().map(|&i| self.stiffness[(i, i)].abs().sqrt().recip()).collect();
        let mut left = vec![1.0_f64; candidates.len()];
        let mut rows: Vec<Vec<f64>> = vec![vec![]; candidates.len()];
        let mut residual: Vec<usize> = Vec::new();
        for _ in 0..candidates.len() {
            let next = (0..candidates.len()).fold(0, |most, i| if left[i] > left[most] { i } else { most });
            if left[next] <= 1e-6 {
                break;
            }
            let (pivot, of_next) = (left[next].sqrt(), rows[next].clone());
            for i in 0..candidates.len() {
                let value = scale[i] * self.stiffness[(candidates[i], candidates[next])] * scale[next];
                let own = (value - dot(&rows[i], &of_next)) / pivot;
                rows[i].push(own);
                left[i] -= own * own;
            }
            left[next] = 0.0;
            residual.push(candidates[next]);
        }
        residual.sort_unstable();
        kept.extend(residual);
        kept.extend(self.panel..size);
        kept
    }
}

/// Turns rigid modes among themselves, so that none has the coordinate of one before it: translation comes before rotation. Which
/// of them a solution brings is its rounding.
fn turn(rigid: &mut [(f64, Vec<f64>)]) {
    for second in 1..rigid.len() {
        for first in 0..second {
            let (head, tail) = rigid.split_at_mut(second);
            let (one, other) = (&mut head[first].1, &mut tail[0].1);
            let size = one[first].hypot(other[first]);
            if size > 0.0 {
                let (cos, sin) = (one[first] / size, other[first] / size);
                for (one, other) in one.iter_mut().zip(other) {
                    (*one, *other) = (cos * *one + sin * *other, cos * *other - sin * *one);
                }
            }
        }
    }
}

fn add(matrix: &mut Mat<f64>, factor: f64, row: &[f64]) {
    for (i, a) in row.iter().enumerate() {
        for (j, b) in row.iter().enumerate() {
            matrix[(i, j)] += factor * a * b;
        }
    }
}

/// Those of these coordinates that the matrices couple, part by part: parities, where all is even.
pub(super) fn uncoupled(matrices: &[&Mat<f64>], coordinates: &[usize]) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = coordinates.iter().rev().copied().collect();
    let mut parts = Vec::new();
    while let Some(first) = left.pop() {
        let mut part = vec![first];
        let mut looked_at = 0;
        while let Some(&one) = part.get(looked_at) {
            looked_at += 1;
            left.retain(|&other| {
                let meets = matrices.iter().any(|matrix| matrix[(one, other)] != 0.0);
                if meets {
                    part.push(other);
                }
                !meets
            });
        }
        parts.push(sorted(part, |&coordinate| coordinate as f64));
    }
    parts
}
