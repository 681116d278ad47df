//! Which constants of a plate the frequencies show: freed one by one, the best seen first, and the rest reported.

use std::sync::Arc;

use faer::{Mat, Side};
use orthopanel_model::Constant;

use super::problem::{FrequencyProblem, FrequencySet};
use super::uncertainty::{left_one_out_percent, residual_variance};
use super::{Minimum, least_squares};
use crate::free_constants::{FreeConstant, FreeConstants};
use crate::least_squares::{Ending, Linearised, descend};
use crate::usual_plate::usual_rest;
use crate::{IdentifyError, NotIdentified};

/// Half of a 95 % interval in standard deviations.
const HALF_95: f64 = 1.96;
/// A modulus is not seen where the standard deviation of its logarithm is above this: its interval spans a factor of 7.
const WIDEST_LOG_STD: f64 = 0.5;
/// Relative standard deviation of a frequency, where neither a bin is stated nor a fit has told it yet.
const USUAL_SCATTER: f64 = 1e-3;
/// A constant that worsens the prediction of frequencies left out by more than this factor is fitted to chance: one
/// parameter too many costs some 5 %, a mode beside a veering that one constant moves alone twice as much and more.
const WORSE_PREDICTION: f64 = 1.25;
/// A quick search tells the error of that prediction to some per cent: one that is worse by this factor still is refused
/// without a search on the whole basis.
const HOPELESS: f64 = 1.2;
/// That quick search ends sooner: what has not settled by then stands at a jump.
const LOOK: Ending = Ending { most_iterations: 12, ..Ending::WITH_JUMPS };

/// The minimum over the constants that the data show, and those that they do not.
///
/// $E_x$ and $G_{zx}$ come first, the others resting beside them as is usual for a panel. Then the one that the data would
/// show best is freed, as long as its interval is narrower than its bounds and than a factor of seven, and the prediction
/// of frequencies left out does not suffer. So a search never wanders along a direction that the data leave open.
pub(super) fn minimise_what_is_seen(
    problem: &mut FrequencyProblem,
    start: &[f64],
) -> Result<(Minimum, Vec<NotIdentified>), IdentifyError> {
    let all = problem.constants.clone();
    let position = |name: &str| all.constants.iter().position(|constant| constant.name == name).unwrap_or(0);
    let mut waiting: Vec<usize> = Vec::new();
    for FreeConstant { constant, .. } in &all.free {
        if let Some(rest) = usual_rest(all.constants[*constant].name, position).filter(|_| !waiting.contains(constant))
        {
            problem.constants.rest(*constant, rest);
            waiting.push(*constant);
        }
    }
    let mut minimum = least_squares(problem, &carried(&all, start, &problem.constants), None)?;
    while let Some(next) = best_seen(problem, &all, &minimum, &waiting) {
        waiting.retain(|constant| *constant != next);
        let before = problem.constants.clone();
        let predicted = prediction_error(&problem.linearised(&minimum.predictions, &before));
        problem.constants = with_freed(&before, &all, next);
        let start = freed_parameters(&before, &minimum.parameters, &problem.constants);
        let trial = match quick_trial(problem, &start, minimum.quick.as_ref()) {
            Some(quick) if !pays(problem, &quick, next, HOPELESS * predicted) => None,
            Some(quick) => least_squares(problem, &quick.parameters, minimum.quick.as_ref()).ok(),
            None => least_squares(problem, &start, None).ok(),
        };
        match trial.filter(|trial| pays(problem, trial, next, predicted)) {
            Some(trial) => minimum = trial,
            None => problem.constants = before,
        }
    }
    let not_identified = reports(problem, &all, &minimum);
    Ok((minimum, not_identified))
}

/// The minimum of a quick search alone.
fn quick_trial(problem: &FrequencyProblem, start: &[f64], quick: Option<&Arc<[FrequencySet]>>) -> Option<Minimum> {
    let nearby = problem.on(quick?);
    let linearise = |parameters: &[f64]| nearby.linearise(parameters).map(|at| at.quadratic());
    let (found, _) = descend(linearise, start, &problem.constants.bounds(), LOOK).ok()?;
    let predictions = nearby.predictions(&found.parameters).ok()?;
    Some(Minimum { parameters: found.parameters, predictions, quick: None })
}

/// Whether a constant just freed is seen, lies inside its bounds, and does not worsen the prediction.
fn pays(problem: &FrequencyProblem, trial: &Minimum, freed: usize, before: f64) -> bool {
    let constants = &problem.constants;
    let at = problem.linearised(&trial.predictions, constants);
    let stds = standard_deviations(&at, residual_variance(problem, &at));
    let mut own = (0..constants.count()).filter(|&index| constants.free[index].constant == freed);
    let seen =
        own.all(|index| stds[index] <= widest(constants, index) && !constants.on_bound(index, trial.parameters[index]));
    seen && prediction_error(&at) <= WORSE_PREDICTION * before
}

/// Rms error \[%\] of frequencies left out; without enough of them it is unbounded.
fn prediction_error(at: &Linearised) -> f64 {
    let covariance = at.quadratic().covariance();
    covariance.and_then(|matrix| left_one_out_percent(at, &matrix)).unwrap_or(f64::INFINITY)
}

/// The waiting constant that the data would show best, if they would show it.
fn best_seen(problem: &FrequencyProblem, all: &FreeConstants, at: &Minimum, waiting: &[usize]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for &constant in waiting {
        let (constants, _) = as_if_freed(problem, all, &at.parameters, &[constant]);
        let stds =
            standard_deviations(&problem.linearised(&at.predictions, &constants), residual_variance_stated(problem));
        let own = (0..constants.count()).filter(|&index| constants.free[index].constant == constant);
        let ratio = own.map(|index| stds[index] / widest(&constants, index)).fold(0.0, f64::max);
        if ratio <= 1.0 && best.is_none_or(|(_, least)| ratio < least) {
            best = Some((constant, ratio));
        }
    }
    best.map(|(constant, _)| constant)
}

/// Variance of the relative residuals before a fit has told it.
fn residual_variance_stated(problem: &FrequencyProblem) -> f64 {
    let rounding = super::uncertainty::rounding_variance(problem);
    if rounding > 0.0 { rounding } else { USUAL_SCATTER.powi(2) }
}

/// The constants with more of them free, and the parameters at the values that all have.
fn as_if_freed(
    problem: &FrequencyProblem,
    all: &FreeConstants,
    parameters: &[f64],
    freed: &[usize],
) -> (FreeConstants, Vec<f64>) {
    let mut constants = problem.constants.clone();
    let mut at = parameters.to_vec();
    for &constant in freed {
        let more = with_freed(&constants, all, constant);
        at = freed_parameters(&constants, &at, &more);
        constants = more;
    }
    (constants, at)
}

/// The constants with one more free, in the order of `all`.
fn with_freed(constants: &FreeConstants, all: &FreeConstants, freed: usize) -> FreeConstants {
    let mut more = constants.clone();
    more.resting.retain(|(resting, _)| *resting != freed);
    let is_free = |constant: usize| constant == freed || constants.free.iter().any(|free| free.constant == constant);
    more.free = all.free.iter().filter(|free| is_free(free.constant)).copied().collect();
    more
}

/// Parameters of `to` at the values that the constants have in `from`.
fn freed_parameters(from: &FreeConstants, parameters: &[f64], to: &FreeConstants) -> Vec<f64> {
    let value = |free: &FreeConstant| from.values(parameters, free.piece.unwrap_or(0))[free.constant];
    to.free.iter().enumerate().map(|(index, free)| to.parameter(index, value(free))).collect()
}

/// The parameters that are left of a list for all constants.
fn carried(all: &FreeConstants, parameters: &[f64], left: &FreeConstants) -> Vec<f64> {
    let kept = |free: &FreeConstant| left.free.contains(free);
    all.free.iter().zip(parameters).filter(|(free, _)| kept(free)).map(|(_, parameter)| *parameter).collect()
}

/// Standard deviation of each parameter; what nothing shows gets a very large one.
fn standard_deviations(at: &Linearised, variance: f64) -> Vec<f64> {
    let normal = at.quadratic().normal;
    let count = normal.nrows();
    let Ok(decomposition) = normal.self_adjoint_eigen(Side::Lower) else { return vec![f64::INFINITY; count] };
    let (values, vectors) = (decomposition.S(), decomposition.U());
    // Rounding leaves a direction that nothing shows some 1e-16 of the largest.
    let floor = 1e-14 * (0..count).map(|k| values[k]).fold(f64::MIN_POSITIVE, f64::max);
    let of =
        |i: usize| (0..count).map(|k| variance * vectors[(i, k)].powi(2) / values[k].max(floor)).sum::<f64>().sqrt();
    (0..count).map(of).collect()
}

/// The widest standard deviation of a parameter that still is a result.
fn widest(constants: &FreeConstants, index: usize) -> f64 {
    let (low, high) = constants.bounds()[index];
    let range = (high - low) / (2.0 * HALF_95);
    if constants.constant(index).unit == "Pa" { range.min(WIDEST_LOG_STD) } else { range }
}

/// What is said of each constant that rests.
fn reports(problem: &FrequencyProblem, all: &FreeConstants, minimum: &Minimum) -> Vec<NotIdentified> {
    let Minimum { parameters, predictions, .. } = minimum;
    let resting: Vec<usize> = problem.constants.resting.iter().map(|(constant, _)| *constant).collect();
    let (constants, values) = as_if_freed(problem, all, parameters, &resting);
    let at = problem.linearised(predictions, &constants);
    let variance = residual_variance(problem, &problem.linearised(predictions, &problem.constants));
    let stds = standard_deviations(&at, variance);
    let direction = blind_direction(&constants, &at.quadratic().normal);
    let report = |&constant: &usize| {
        let index = constants.free.iter().position(|free| free.constant == constant).unwrap_or(0);
        let Constant { name, unit, .. } = constants.constants[constant];
        let end = |sign: f64| constants.value(index, values[index] + sign * HALF_95 * stds[index]);
        NotIdentified {
            name,
            unit,
            held_at: constants.value(index, values[index]),
            interval: [end(-1.0), end(1.0)],
            direction: direction.clone(),
        }
    };
    resting.iter().map(report).collect()
}

/// The direction of the least eigenvalue.
fn blind_direction(constants: &FreeConstants, normal: &Mat<f64>) -> Vec<(&'static str, f64)> {
    let Ok(decomposition) = normal.self_adjoint_eigen(Side::Lower) else { return Vec::new() };
    let vectors = decomposition.U();
    // Eigenvalues rise: the first is the least.
    constants.direction(|i| vectors[(i, 0)])
}
