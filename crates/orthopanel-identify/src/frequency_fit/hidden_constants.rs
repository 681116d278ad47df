//! Constants that the data do not show: their intervals reach beyond what is known of them.

use super::minimum::Minimum;
use super::noise::Noise;
use super::problem::FrequencyProblem;
use super::uncertainty::with_unseen;
use crate::free_constants::{FreeConstant, FreeConstants, HALF_95};

/// A modulus is not seen where the standard deviation of its logarithm is above this: its interval spans a factor of 7.
const WIDEST_LOG_STD: f64 = 0.5;
/// A ratio that is known this well is a result though its interval reaches beyond its bound: it is known to lie near it.
const NARROW_RATIO: f64 = 0.05;

/// The free constant that the data show least, where they do not show it; the last modulus stays, for it has the size of all.
pub(super) fn worst_hidden(problem: &FrequencyProblem, at: &Minimum) -> Option<usize> {
    let constants = &problem.constants;
    let moduli = constants.free_constants().into_iter().filter(|&constant| constants.is_modulus(constant)).count();
    let stds = total_standard_deviations(problem, at);
    let hidden = (0..constants.count()).filter_map(|index| {
        let constant = constants.free[index].constant;
        let ratio = stds[index] / widest(constants, index);
        let is_hidden = is_open(constants, index, at.parameters[index], stds[index]);
        (is_hidden && (moduli > 1 || !constants.is_modulus(constant))).then_some((constant, ratio))
    });
    hidden.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(constant, _)| constant)
}

/// Standard deviation of each parameter: what is not known of the constants that rest is not known of these either.
pub(super) fn total_standard_deviations(problem: &FrequencyProblem, at: &Minimum) -> Vec<f64> {
    let constants = &problem.constants;
    let linearised = problem.linearised(&at.predictions, constants);
    let noise = Noise::left(problem, &linearised);
    with_unseen(problem, &at.predictions, &at.parameters, noise.wide_variance()).map_or_else(
        || noise.standard_deviations(&linearised),
        |covariance| (0..constants.count()).map(|index| covariance[(index, index)].sqrt()).collect(),
    )
}

/// Whether data leave a parameter open: its interval is wider than its bounds, or reaches beyond one of them.
pub(super) fn is_open(constants: &FreeConstants, index: usize, at: f64, std: f64) -> bool {
    let (low, high) = constants.bounds()[index];
    let is_ratio = !constants.is_modulus(constants.free[index].constant);
    let reaches_beyond = at - HALF_95 * std < low || at + HALF_95 * std > high;
    std > widest(constants, index)
        || constants.on_bound(index, at)
        || (is_ratio && std > NARROW_RATIO && reaches_beyond)
}

/// The widest standard deviation of a parameter that still is a result.
pub(super) fn widest(constants: &FreeConstants, index: usize) -> f64 {
    let (low, high) = constants.bounds()[index];
    let range = (high - low) / (2.0 * HALF_95);
    if constants.constant(index).unit == "Pa" { range.min(WIDEST_LOG_STD) } else { range }
}

/// The constants with one more free, in the order of `all`.
pub(super) fn with_freed(constants: &FreeConstants, all: &FreeConstants, freed: usize) -> FreeConstants {
    let mut more = constants.clone();
    more.resting.retain(|(resting, _)| *resting != freed);
    let is_free = |constant: usize| constant == freed || constants.free.iter().any(|free| free.constant == constant);
    more.free = all.free.iter().filter(|free| is_free(free.constant)).copied().collect();
    more
}

/// The parameters that are left of a list for all constants.
pub(super) fn carried(all: &FreeConstants, parameters: &[f64], left: &FreeConstants) -> Vec<f64> {
    let kept = |free: &FreeConstant| left.free.contains(free);
    all.free.iter().zip(parameters).filter(|(free, _)| kept(free)).map(|(_, parameter)| *parameter).collect()
}
