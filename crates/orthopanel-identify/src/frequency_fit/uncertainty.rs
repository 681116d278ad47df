//! Standard deviations, correlations and the left-one-out error.

use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Side};

use super::noise::{Noise, rounding_variance};
use super::problem::{FrequencyProblem, SetPrediction};
use crate::Correlation;
use crate::free_constants::RestingFreed;
use crate::least_squares::Linearised;
use crate::structures::Shown;

/// Of the parameters.
#[derive(Default)]
pub(super) struct Uncertainty {
    /// Standard deviation of each; empty where the data cannot tell.
    pub std: Vec<f64>,
    pub correlations: Vec<Correlation>,
    /// Rms error \[%\] of each frequency predicted from the others.
    pub left_one_out_percent: Option<f64>,
}

/// `predictions` are the modes at `parameters`, and `at` what follows from them.
pub(super) fn uncertainty(
    problem: &FrequencyProblem,
    predictions: &[SetPrediction],
    parameters: &[f64],
    at: &Linearised,
) -> Uncertainty {
    let quadratic = at.quadratic();
    let Some(covariance) = quadratic.covariance() else { return Uncertainty::default() };
    let free = problem.constants.count();
    let variance = match problem.structure.shown() {
        Shown::Wholly => residual_variance(problem, at),
        Shown::InPart => Noise::left(problem, at).wide_variance(),
    };
    let correlations = problem.constants.correlations(&covariance);
    let std = if variance > 0.0 {
        let stated = with_unseen(problem, predictions, parameters, variance);
        let covariance = stated.unwrap_or_else(|| faer::Scale(variance) * &covariance);
        (0..free).map(|i| covariance[(i, i)].sqrt()).collect()
    } else {
        Vec::new()
    };
    Uncertainty { std, correlations, left_one_out_percent: left_one_out_percent(at, &covariance) }
}

/// Covariance of the parameters, then of the constants that rest, each of which may lie beside what is usual: what is not
/// known of them is not known of the others either. `None` where none rests.
pub(super) fn with_unseen(
    problem: &FrequencyProblem,
    predictions: &[SetPrediction],
    parameters: &[f64],
    variance: f64,
) -> Option<Mat<f64>> {
    if problem.constants.resting.is_empty() {
        return None;
    }
    let RestingFreed { constants, usual_stds, .. } = problem.constants.with_resting_freed(parameters);
    let mut normal = problem.linearised(predictions, &constants).quadratic().normal;
    for i in 0..constants.count() {
        (0..constants.count()).for_each(|j| normal[(i, j)] /= variance);
    }
    for (index, std) in (parameters.len()..).zip(usual_stds) {
        normal[(index, index)] += std.powi(-2);
    }
    Some(normal.llt(Side::Lower).ok()?.inverse())
}

/// Variance of the relative residuals: their scatter, or the rounding to the analyser's bins, whichever is larger.
pub(super) fn residual_variance(problem: &FrequencyProblem, at: &Linearised) -> f64 {
    let beyond = problem.count().saturating_sub(problem.constants.count());
    let scatter = if beyond > 0 { at.quadratic().cost / beyond as f64 } else { 0.0 };
    scatter.max(rounding_variance(problem))
}

/// Each frequency predicted from all the others: rms of the relative errors \[%\].
///
/// A fit without datum $i$ misses it by $r_i/(1-h_i)$ with $h = J(J^TJ)^{-1}J^T$ (Allen's PRESS). That is exact where
/// the frequencies are linear in the logarithms of the constants; here it is within 1 % of the refits (tested).
pub(super) fn left_one_out_percent(at: &Linearised, covariance: &Mat<f64>) -> Option<f64> {
    let count = at.residuals.len();
    let free = covariance.nrows();
    if free == 0 || count < free + 1 {
        return None;
    }
    let mut squares = 0.0;
    for (i, residual) in at.residuals.iter().enumerate() {
        let leverage = leverage(at, covariance, i);
        if leverage > 1.0 - 1e-9 {
            // Without this frequency a constant is not determined at all.
            return None;
        }
        squares += (residual / (1.0 - leverage)).powi(2);
    }
    Some(100.0 * (squares / count as f64).sqrt())
}

/// $h_i = a_i^TCa_i$: how much of line $i$ the fit takes from that line itself.
pub(super) fn leverage(at: &Linearised, covariance: &Mat<f64>, line: usize) -> f64 {
    let row = |j: usize| at.jacobian[(line, j)];
    let free = covariance.nrows();
    let pairs = (0..free).flat_map(|j| (0..free).map(move |k| (j, k)));
    pairs.map(|(j, k)| row(j) * covariance[(j, k)] * row(k)).sum()
}
