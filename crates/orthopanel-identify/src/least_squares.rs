//! Levenberg-Marquardt on exact derivatives.

use faer::linalg::solvers::DenseSolveCore;
use faer::prelude::Solve;
use faer::{Mat, Side};

use crate::interruption::heed;

/// $\sum r_i^2$ near some parameters: its value, $J^Tr$ and $J^TJ$.
#[derive(Clone)]
pub(crate) struct Quadratic {
    /// $\sum r_i^2$.
    pub cost: f64,
    /// $J^Tr$.
    pub gradient: Vec<f64>,
    /// $J^TJ$.
    pub normal: Mat<f64>,
}

impl Quadratic {
    pub fn zero(size: usize) -> Self {
        Self { cost: 0.0, gradient: vec![0.0; size], normal: Mat::zeros(size, size) }
    }

    /// Adds one residual with its derivatives by some parameters, in rising order of these; fills the lower triangle.
    pub fn add_row(&mut self, residual: f64, derivatives: &[(usize, f64)]) {
        self.cost += residual * residual;
        for (i, &(row, by_row)) in derivatives.iter().enumerate() {
            self.gradient[row] += residual * by_row;
            for &(column, by_column) in &derivatives[..=i] {
                self.normal[(row, column)] += by_row * by_column;
            }
        }
    }

    /// Adds $[J\,r]^T[J\,r]$ of some residuals by some parameters, in rising order of these; fills the lower triangle.
    pub fn add_products(&mut self, products: &Mat<f64>, parameters: &[usize]) {
        let last = parameters.len();
        self.cost += products[(last, last)];
        for (i, &row) in parameters.iter().enumerate() {
            self.gradient[row] += products[(last, i)];
            for (j, &column) in parameters.iter().enumerate().take(i + 1) {
                self.normal[(row, column)] += products[(i, j)];
            }
        }
    }

    /// Copies the lower triangle onto the upper one.
    pub fn mirror(&mut self) {
        for row in 0..self.normal.nrows() {
            for column in 0..row {
                self.normal[(column, row)] = self.normal[(row, column)];
            }
        }
    }

    pub fn is_finite(&self) -> bool {
        let curvature = (0..self.gradient.len()).map(|index| self.normal[(index, index)]);
        self.cost.is_finite() && self.gradient.iter().copied().chain(curvature).all(f64::is_finite)
    }

    /// $(J^TJ)^{-1}$: the covariance of the parameters for residuals of variance one; `None` where it is singular.
    pub fn covariance(&self) -> Option<Mat<f64>> {
        Some(self.normal.llt(Side::Lower).ok()?.inverse())
    }
}

/// Residuals $r$ and their derivatives $\partial r_i/\partial p_j$, a row a residual.
pub(crate) struct Linearised {
    pub residuals: Vec<f64>,
    pub jacobian: Mat<f64>,
}

impl Linearised {
    pub fn quadratic(&self) -> Quadratic {
        let residuals = Mat::from_fn(self.residuals.len(), 1, |i, _| self.residuals[i]);
        let gradient = self.jacobian.transpose() * residuals;
        Quadratic {
            cost: self.residuals.iter().map(|r| r * r).sum(),
            gradient: (0..gradient.nrows()).map(|i| gradient[(i, 0)]).collect(),
            normal: self.jacobian.transpose() * &self.jacobian,
        }
    }
}

/// Where a search ended.
pub(crate) struct Minimum {
    pub parameters: Vec<f64>,
    pub at: Quadratic,
}

/// Why a search ended nowhere.
pub(crate) enum Stuck<E> {
    /// The model refused the start.
    Refused(E),
    /// Residuals or their derivatives at the start are no finite numbers.
    NotFinite,
    /// Too many iterations; the last cost.
    Iterations { count: usize, cost: f64 },
}

/// What is left of the damping after a step that went down.
const EASING: f64 = 0.1;

/// When a search ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ending {
    /// More iterations than these are none.
    pub most_iterations: usize,
    /// A step this small in logarithms ends a search.
    pub small_step: f64,
    /// Part of the sum of squares that is not worth another step.
    pub small_gain: f64,
    /// Size of the sum of squares that is not, however small the rest.
    pub little: f64,
    /// Damping of the first step, as a part of the curvature.
    pub first_damping: f64,
    /// Damping of a step after one that failed, at least: a smaller one would end where that ended.
    pub failed_damping: f64,
    /// No parameter moves further in one step.
    pub longest_step: f64,
}

impl Ending {
    /// For smooth residuals: after a step of 1e-8 the next would be a thousand times smaller still, and 1e-10 of the sum
    /// of squares moves a parameter by 1e-5 of its standard deviation.
    pub const SMOOTH: Self = Self {
        most_iterations: 100,
        small_step: 1e-8,
        small_gain: 1e-10,
        little: 0.0,
        first_damping: 1e-6,
        failed_damping: 0.0,
        longest_step: f64::INFINITY,
    };
    /// For residuals that jump where two modes change places: 1e-6 of the sum of squares moves a parameter by 1e-3 of its
    /// standard deviation, and at a jump steps shrink without end.
    pub const WITH_JUMPS: Self = Self {
        most_iterations: 40,
        small_step: 1e-5,
        small_gain: 1e-6,
        first_damping: 1e-4,
        failed_damping: 0.1,
        ..Self::SMOOTH
    };

    /// For a likelihood of so many data: a thousandth of what one parameter's standard deviation costs moves it by a
    /// thirtieth of that. Flat directions, as the damping of a mode that hardly shows, would else be followed for long.
    pub fn likelihood(data: f64) -> Self {
        // Where a mode hardly shows, the logarithm of its damping is no straight line for longer than this.
        Self { small_gain: Self::SMOOTH.small_gain.max(1e-3 / data.max(1.0)), longest_step: 1.0, ..Self::SMOOTH }
    }

    /// A search that is cut short: after so many iterations, or where a step promises `little`.
    pub const fn short(most_iterations: usize, little: f64) -> Self {
        Self { most_iterations, little, ..Self::SMOOTH }
    }

    /// Whether the next step from here, without damping, would promise little.
    pub fn is_reached(&self, at: &Quadratic, parameters: &[f64], bounds: &[(f64, f64)]) -> bool {
        let trial = damped_step(at, parameters, bounds, (0.0, self.longest_step));
        trial.is_some_and(|trial| self.is_little(promise(at, parameters, &trial), at.cost))
    }

    fn is_little(&self, promised: f64, cost: f64) -> bool {
        promised <= self.little.max(self.small_gain * cost)
    }
}

/// Minimises $\sum r_i^2$ from `start`; each parameter stays within its `(low, high)`.
///
/// The damping follows Nielsen: it falls with the gain ratio and grows ever faster on failure. A parameter is projected
/// on its bounds, so a search may end on one: the caller looks.
pub(crate) fn levenberg_marquardt<E>(
    linearise: impl Fn(&[f64]) -> Result<Quadratic, E>,
    start: &[f64],
    bounds: &[(f64, f64)],
) -> Result<Minimum, Stuck<E>> {
    levenberg_marquardt_until(linearise, start, bounds, Ending::SMOOTH)
}

/// The same with an ending of one's own.
pub(crate) fn levenberg_marquardt_until<E>(
    linearise: impl Fn(&[f64]) -> Result<Quadratic, E>,
    start: &[f64],
    bounds: &[(f64, f64)],
    ending: Ending,
) -> Result<Minimum, Stuck<E>> {
    let (minimum, settled) = descend(linearise, start, bounds, ending)?;
    let (count, cost) = (ending.most_iterations, minimum.at.cost);
    if settled { Ok(minimum) } else { Err(Stuck::Iterations { count, cost }) }
}

/// Goes down $\sum r_i^2$ as far as the ending lets it, and says whether it came to a minimum.
///
/// # Errors
/// [`Stuck::Refused`] where the start is refused, [`Stuck::NotFinite`] where nothing finite is known there.
pub(crate) fn descend<E>(
    linearise: impl Fn(&[f64]) -> Result<Quadratic, E>,
    start: &[f64],
    bounds: &[(f64, f64)],
    ending: Ending,
) -> Result<(Minimum, bool), Stuck<E>> {
    let mut parameters = start.to_vec();
    let mut at = linearise(&parameters).map_err(Stuck::Refused)?;
    // No step leads away from there, and none leads there: a trial that is not finite goes down nowhere.
    if !at.is_finite() {
        return Err(Stuck::NotFinite);
    }
    let (mut damping, mut growth) = (ending.first_damping, 2.0);
    for _ in 0..ending.most_iterations {
        heed();
        let Some(trial) = damped_step(&at, &parameters, bounds, (damping, ending.longest_step)) else {
            damping = (damping * growth).max(1e-12);
            growth *= 2.0;
            continue;
        };
        // Once that is nothing beside what is left, either end is the minimum.
        let promised = promise(&at, &parameters, &trial);
        let moved = trial.iter().zip(&parameters).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        if let Ok(next) = linearise(&trial) {
            let (before, after) = (at.cost, next.cost);
            // At the bottom both are equal but for rounding, and either is the minimum.
            if after <= before && next.is_finite() {
                let settled = moved < ending.small_step || ending.is_little(promised, before);
                (parameters, at) = (trial, next);
                (damping, growth) = (damping * EASING, 2.0);
                if settled {
                    return Ok((Minimum { parameters, at }, true));
                }
                continue;
            }
        }
        if moved < ending.small_step || ending.is_little(promised, at.cost) {
            return Ok((Minimum { parameters, at }, true));
        }
        damping = (damping * growth).max(ending.failed_damping);
        growth *= 2.0;
    }
    Ok((Minimum { parameters, at }, false))
}

/// The end of a step of Levenberg and Marquardt, within the bounds; `None` where the curvature is not positive.
fn damped_step(
    at: &Quadratic,
    parameters: &[f64],
    bounds: &[(f64, f64)],
    (damping, longest): (f64, f64),
) -> Option<Vec<f64>> {
    let mut normal = at.normal.clone();
    let mut gradient = Mat::from_fn(parameters.len(), 1, |i, _| at.gradient[i]);
    for (i, (&parameter, &(low, high))) in parameters.iter().zip(bounds).enumerate() {
        normal[(i, i)] *= 1.0 + damping;
        // On a bound and pressed against it: this one rests, so that the others do not answer to its step.
        let pressed = (parameter <= low && gradient[(i, 0)] > 0.0) || (parameter >= high && gradient[(i, 0)] < 0.0);
        if pressed {
            for j in 0..parameters.len() {
                normal[(i, j)] = 0.0;
                normal[(j, i)] = 0.0;
            }
            normal[(i, i)] = 1.0;
            gradient[(i, 0)] = 0.0;
        }
    }
    let step = normal.llt(Side::Lower).ok()?.solve(&gradient);
    let ends = parameters.iter().zip(bounds).enumerate();
    Some(ends.map(|(i, (p, &(low, high)))| (p - step[(i, 0)].clamp(-longest, longest)).clamp(low, high)).collect())
}

/// What a step to `trial` promises, to first order.
fn promise(at: &Quadratic, parameters: &[f64], trial: &[f64]) -> f64 {
    trial.iter().zip(parameters).zip(&at.gradient).map(|((new, old), g)| (old - new) * g).sum::<f64>().abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley as residuals (10 (y − x²), 1 − x): minimum zero at (1, 1).
    fn rosenbrock(p: &[f64]) -> Result<Quadratic, ()> {
        let (x, y) = (p[0], p[1]);
        let rows = [[-20.0 * x, 10.0], [-1.0, 0.0]];
        let residuals = vec![10.0 * (y - x * x), 1.0 - x];
        Ok(Linearised { residuals, jacobian: Mat::from_fn(2, 2, |i, j| rows[i][j]) }.quadratic())
    }

    #[test]
    fn val_rosenbrock_valley() {
        let open = [(-10.0, 10.0); 2];
        let Ok(minimum) = levenberg_marquardt(rosenbrock, &[-1.2, 1.0], &open) else { panic!("no minimum") };
        assert!(minimum.parameters.iter().all(|p| (p - 1.0).abs() < 1e-8), "{:?}", minimum.parameters);
    }

    #[test]
    fn a_start_without_finite_residuals_is_refused() {
        for lost in [f64::NAN, f64::INFINITY, 1e200] {
            let nowhere = |_: &[f64]| -> Result<Quadratic, ()> {
                Ok(Linearised { residuals: vec![lost], jacobian: Mat::from_fn(1, 1, |_, _| 1.0) }.quadratic())
            };
            assert!(matches!(levenberg_marquardt(nowhere, &[0.0], &[(-1.0, 1.0)]), Err(Stuck::NotFinite)), "{lost}");
        }
    }

    #[test]
    fn a_bound_holds_the_search() {
        let bounds = [(-10.0, 0.5), (-10.0, 10.0)];
        let Ok(minimum) = levenberg_marquardt(rosenbrock, &[-1.2, 1.0], &bounds) else { panic!("no minimum") };
        assert!((minimum.parameters[0] - 0.5).abs() < 1e-8);
    }
}
