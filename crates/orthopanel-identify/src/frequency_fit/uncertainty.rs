//! Standard deviations, correlations and the left-one-out error.

use faer::Mat;

use super::problem::FrequencyProblem;
use crate::Correlation;
use crate::least_squares::Linearised;

/// Of the logarithms of the free constants.
#[derive(Default)]
pub(super) struct Uncertainty {
    /// Standard deviation of each; empty where the data cannot tell.
    pub log_std: Vec<f64>,
    pub correlations: Vec<Correlation>,
    /// Rms error \[%\] of each frequency predicted from the others.
    pub left_one_out_percent: Option<f64>,
}

pub(super) fn uncertainty(problem: &FrequencyProblem, at: &Linearised) -> Uncertainty {
    let quadratic = at.quadratic();
    let Some(covariance) = quadratic.covariance() else { return Uncertainty::default() };
    let free = problem.free.len();
    let beyond = problem.count() - free;
    let scatter = if beyond > 0 { quadratic.cost / beyond as f64 } else { 0.0 };
    let variance = scatter.max(rounding_variance(problem));
    let std = |i: usize| covariance[(i, i)].sqrt();
    let name = |i: usize| problem.constants[problem.free[i]].name;
    let pairs = (0..free).flat_map(|i| (i + 1..free).map(move |j| (i, j)));
    let correlations = pairs
        .map(|(i, j)| Correlation { first: name(i), second: name(j), value: covariance[(i, j)] / (std(i) * std(j)) })
        .collect();
    let log_std = if variance > 0.0 { (0..free).map(|i| variance.sqrt() * std(i)).collect() } else { Vec::new() };
    Uncertainty { log_std, correlations, left_one_out_percent: left_one_out_percent(at, &covariance) }
}

/// Mean relative variance by rounding to the analyser's bins, where these are stated.
fn rounding_variance(problem: &FrequencyProblem) -> f64 {
    let relative: Vec<f64> = problem
        .sets
        .iter()
        .flat_map(|set| set.rounding.iter().zip(&set.measured))
        .map(|(rounding, measured)| (rounding / measured).powi(2))
        .collect();
    if relative.is_empty() { 0.0 } else { relative.iter().sum::<f64>() / relative.len() as f64 }
}

/// Each frequency predicted from all the others: rms of the relative errors \[%\].
///
/// A fit without datum $i$ misses it by $r_i/(1-h_i)$ with $h = J(J^TJ)^{-1}J^T$ (Allen's PRESS). That is exact where
/// the frequencies are linear in the logarithms of the constants; here it is within 1 % of the refits (tested).
fn left_one_out_percent(at: &Linearised, covariance: &Mat<f64>) -> Option<f64> {
    let count = at.residuals.len();
    let free = covariance.nrows();
    if count < free + 1 {
        return None;
    }
    let mut squares = 0.0;
    for (i, residual) in at.residuals.iter().enumerate() {
        let row = |j: usize| at.jacobian[(i, j)];
        let pairs = (0..free).flat_map(|j| (0..free).map(move |k| (j, k)));
        let leverage: f64 = pairs.map(|(j, k)| row(j) * covariance[(j, k)] * row(k)).sum();
        if leverage > 1.0 - 1e-9 {
            // Without this frequency a constant is not determined at all.
            return None;
        }
        squares += (residual / (1.0 - leverage)).powi(2);
    }
    Some(100.0 * (squares / count as f64).sqrt())
}
