//! Stiffness, mass and damping of a panel with effects, and its modes.

use faer::Mat;

use super::receptance::view::View;
use super::{ElementLaw, PointElement};
use crate::dense::{Cholesky, symmetric_eigen};
use crate::{Damping, ModelError};

/// $\omega$, $\zeta$ and all coordinates of a mode.
pub(super) type FoundMode = (f64, f64, Vec<f64>);

/// Stiffness, mass and damping in the coordinates of a [`DressedPanel`].
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
    pub(super) fn new(view: &View, elements: &[PointElement], damping: &Damping) -> Self {
        let (layout, numbers) = (view.layout, &view.numbers);
        let (modes, count) = (layout.modes, layout.active);
        let resonators = elements.iter().filter(|element| matches!(element.law, ElementLaw::Resonator { .. })).count();
        let (panel, size) = (modes + count, modes + count + resonators);
        let series = |k: usize, a: usize, b: usize| numbers[layout.series(k) + a * count + b];
        let mut system = Self {
            stiffness: Mat::zeros(size, size),
            mass: Mat::zeros(size, size),
            damping: Mat::zeros(size, size),
            residuals: modes,
            panel,
            shift: numbers.get(layout.rigid).copied().unwrap_or(1.0),
        };
        for (m, &lambda) in numbers.iter().enumerate().take(modes) {
            system.stiffness[(m, m)] = lambda;
            system.mass[(m, m)] = 1.0;
            let zeta = if m < layout.rigid { 0.0 } else { damping.ratio(m + 1 - layout.rigid) };
            system.damping[(m, m)] = 2.0 * zeta * lambda.sqrt();
        }
        for (a, b) in (0..count).flat_map(|a| (0..count).map(move |b| (a, b))) {
            system.stiffness[(modes + a, modes + b)] = series(0, a, b);
            system.mass[(modes + a, modes + b)] = series(1, a, b);
        }
        let mut resonators = panel..size;
        for (a, element) in elements.iter().enumerate() {
            let mut row = vec![0.0; size];
            (0..modes).for_each(|m| row[m] = numbers[layout.shape(m) + a]);
            (0..count).for_each(|b| row[modes + b] = series(0, a, b));
            system.join(element.law, row, &mut resonators);
        }
        system
    }

    /// Adds an element that sits where the coordinates have these values; a resonator takes the next of its coordinates.
    pub(super) fn join(&mut self, law: ElementLaw, mut row: Vec<f64>, resonators: &mut impl Iterator<Item = usize>) {
        match law {
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

    /// $\omega$, $\zeta$ and all coordinates of each mode, rising. As in [`crate::ritz_modes()`], by the inverse
    /// of a shifted stiffness; a mass matrix that negative masses make indefinite leaves modes without meaning, which go.
    pub(super) fn solve(&self) -> Result<Vec<FoundMode>, ModelError> {
        let kept = self.independent();
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
        // A coordinate without mass has none but rounding, and follows the others at once.
        let least = 1e-13 * thetas.last().copied().unwrap_or(0.0);
        let positive = (0..size).rev().filter(|&column| thetas[column] > least);
        let modes = positive.map(|column| {
            let norm = thetas[column].sqrt().recip();
            let mut whole = vec![0.0; self.mass.nrows()];
            (0..size).for_each(|i| whole[kept[i]] = norm * scale[i] * vectors[(i, column)]);
            let lambda = 1.0 / thetas[column] - self.shift;
            // Rounding of a rigid mode.
            let omega = if lambda > 1e-9 * self.shift { lambda.sqrt() } else { 0.0 };
            let lost = crate::structure::quadratic_form(&self.damping, &whole);
            // Below zero by rounding, where nothing is lost.
            let zeta = if omega > 0.0 { (lost / (2.0 * omega)).clamp(0.0, 0.7) } else { 0.0 };
            (omega, zeta, whole)
        });
        Ok(modes.collect())
    }

    /// The damping matrix in these modes, less $2\zeta\omega$ on its diagonal; rigid modes have none.
    pub(super) fn couplings(&self, modes: &[FoundMode]) -> Vec<Vec<f64>> {
        let row = |(m, (omega, zeta, shape)): (usize, &FoundMode)| {
            let forces: Vec<f64> = (0..shape.len())
                .map(|i| self.damping.col_as_slice(i).iter().zip(shape).map(|(damping, share)| damping * share).sum())
                .collect();
            let other = |(n, (other, _, along)): (usize, &FoundMode)| {
                let whole: f64 = forces.iter().zip(along).map(|(force, share)| force * share).sum();
                let rest = if n == m { whole - 2.0 * zeta * omega } else { whole };
                // What rounding leaves of a rigid mode, or of the diagonal.
                let rounding = 1e-12 * self.shift.sqrt();
                if *omega == 0.0 || *other == 0.0 || rest.abs() <= rounding { 0.0 } else { rest }
            };
            modes.iter().enumerate().map(other).collect()
        };
        modes.iter().enumerate().map(row).collect()
    }

    /// Coordinates without the residual shapes that others hold already, as of two elements at one place.
    pub(super) fn independent(&self) -> Vec<usize> {
        let size = self.stiffness.nrows();
        let first = self.residuals;
        let mut kept: Vec<usize> = (0..first).collect();
        let mut residual: Vec<usize> = Vec::new();
        for candidate in first..self.panel {
            let with: Vec<usize> = residual.iter().copied().chain([candidate]).collect();
            let scale = |i: usize| self.stiffness[(i, i)].abs().sqrt().recip();
            let block = Mat::from_fn(with.len(), with.len(), |i, j| {
                scale(with[i]) * self.stiffness[(with[i], with[j])] * scale(with[j])
            });
            let smallest = symmetric_eigen(&block).and_then(|(values, _)| values.first().copied()).unwrap_or(0.0);
            if smallest > 1e-6 {
                residual = with;
            }
        }
        kept.extend(residual);
        kept.extend(self.panel..size);
        kept
    }
}

fn add(matrix: &mut Mat<f64>, factor: f64, row: &[f64]) {
    for (i, a) in row.iter().enumerate() {
        for (j, b) in row.iter().enumerate() {
            matrix[(i, j)] += factor * a * b;
        }
    }
}
