//! Standard deviations, correlations and the left-one-out error.

use super::problem::FrequencyProblem;
use super::{Search, minimise};
use crate::{Correlation, IdentifyError};

/// Of the logarithms of the free constants.
pub(super) struct Uncertainty {
    /// Standard deviation of each; empty where the data cannot tell.
    pub log_std: Vec<f64>,
    pub correlations: Vec<Correlation>,
}

pub(super) fn uncertainty(problem: &FrequencyProblem, found: &[f64]) -> Result<Uncertainty, IdentifyError> {
    let at = problem.linearise(found)?;
    let none = Uncertainty { log_std: Vec::new(), correlations: Vec::new() };
    let Some(covariance) = at.covariance() else { return Ok(none) };
    let free = problem.free.len();
    let beyond = problem.count() - free;
    let scatter = if beyond > 0 { at.cost() / beyond as f64 } else { 0.0 };
    let variance = scatter.max(rounding_variance(problem));
    let std = |i: usize| covariance[(i, i)].sqrt();
    let name = |i: usize| problem.constants[problem.free[i]].name;
    let pairs = (0..free).flat_map(|i| (i + 1..free).map(move |j| (i, j)));
    let correlations = pairs
        .map(|(i, j)| Correlation { first: name(i), second: name(j), value: covariance[(i, j)] / (std(i) * std(j)) })
        .collect();
    let log_std = if variance > 0.0 { (0..free).map(|i| variance.sqrt() * std(i)).collect() } else { Vec::new() };
    Ok(Uncertainty { log_std, correlations })
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
pub(super) fn left_one_out_percent(problem: &FrequencyProblem, found: &[f64]) -> Result<Option<f64>, IdentifyError> {
    if problem.count() < problem.free.len() + 1 || problem.free.is_empty() {
        return Ok(None);
    }
    let mut squares = 0.0;
    for set in 0..problem.sets.len() {
        for mode in 0..problem.sets[set].measured.len() {
            let mut without = problem.clone();
            without.sets[set].fitted[mode] = false;
            let refitted = minimise(&without, found, Search::LeastSquares)?;
            let predicted = without.sets[set].predict(&without.values(&refitted))?;
            squares += (predicted[mode].frequency / without.sets[set].measured[mode] - 1.0).powi(2);
        }
    }
    Ok(Some(100.0 * (squares / problem.count() as f64).sqrt()))
}
