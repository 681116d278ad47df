//! Which constants of a plate the frequencies show: freed one by one, the best seen first, and the rest reported.

use std::sync::Arc;

use super::first_constants::{Resting, first_minimum};
use super::hidden_constants::{carried, is_open, total_standard_deviations, widest, with_freed, worst_hidden};
use super::minimum::{Minimum, least_squares};
use super::noise::{BEYOND_CHANCE, Noise};
use super::problem::{FrequencyProblem, FrequencySet};
use super::uncertainty::left_one_out_percent;
use crate::IdentifyError;
use crate::free_constants::{FreeConstant, FreeConstants, HALF_95, Rest};
use crate::least_squares::{Ending, Linearised, descend};

/// A constant that worsens the prediction of frequencies left out by more than this factor is fitted to chance: one
/// parameter too many costs some 5 %, a mode beside a veering that one constant moves alone twice as much and more.
const WORSE_PREDICTION: f64 = 1.25;
/// A quick search tells the error of that prediction to some per cent: one that is worse by this factor still is refused
/// without a search on the whole basis.
const HOPELESS: f64 = 1.2;
/// That quick search ends sooner: what has not settled by then stands at a jump.
const LOOK: Ending = Ending { most_iterations: 12, ..Ending::WITH_JUMPS };

/// The minimum over the constants that the data show; the others rest.
///
/// $E_x$ and $G_{zx}$ come first, the others resting beside them as is usual for a panel; where the data do not show these two,
/// one modulus alone. Then the one that the data would show best is freed, as long as its interval is narrower than its
/// bounds and than a factor of seven, and the prediction of frequencies left out does not suffer. So a search never wanders
/// along a direction that the data leave open. One that the freedom of others has hidden rests again.
pub(super) fn minimise_what_is_seen(problem: &mut FrequencyProblem, start: &[f64]) -> Result<Minimum, IdentifyError> {
    let all = problem.constants.clone();
    let mut minimum = first_minimum(problem, &all, start)?;
    let mut waiting: Vec<usize> = problem.constants.resting.iter().map(|(constant, _)| *constant).collect();
    while let Some(next) = best_seen(problem, &all, &minimum, &waiting) {
        waiting.retain(|constant| *constant != next);
        let before = problem.constants.clone();
        let reached = Reached::of(problem, &minimum);
        problem.constants = with_freed(&before, &all, next);
        let start = freed_parameters(&before, &minimum.parameters, &problem.constants);
        let trial = match quick_trial(problem, &start, minimum.quick.as_ref()) {
            Some(quick) if !pays(problem, &quick, next, &reached, HOPELESS * WORSE_PREDICTION) => None,
            Some(quick) => least_squares(problem, &quick.parameters, minimum.quick.as_ref()).ok(),
            None => least_squares(problem, &start, None).ok(),
        };
        match trial.filter(|trial| pays(problem, trial, next, &reached, WORSE_PREDICTION)) {
            Some(trial) => minimum = trial,
            None => problem.constants = before,
        }
    }
    let_hidden_rest(problem, &all, minimum)
}

/// The minimum without those constants that the data do not show.
pub(super) fn let_hidden_rest(
    problem: &mut FrequencyProblem,
    all: &FreeConstants,
    mut minimum: Minimum,
) -> Result<Minimum, IdentifyError> {
    while let Some(hidden) = worst_hidden(problem, &minimum) {
        let before = problem.constants.clone();
        let at_rest = |problem: &mut FrequencyProblem, rest: Rest| {
            problem.constants = before.clone();
            problem.constants.rest(hidden, rest);
            let from = carried(&before, &minimum.parameters, &problem.constants);
            least_squares(problem, &from, None)
        };
        let as_usual = at_rest(problem, Resting::of(all).beside(&before, hidden))?;
        let value = shared_value(&before, &minimum.parameters, hidden);
        // As many lines as constants are met wherever one rests, and speak against nothing.
        let may_speak = problem.count() > all.count();
        let value = value.filter(|_| may_speak && is_spoken_against(problem, &before, &minimum, &as_usual));
        minimum = match value {
            Some(value) => at_rest(problem, Rest::Held(value))?,
            None => as_usual,
        };
    }
    // The size of all is told by the last modulus, if that is told.
    let last = problem.constants.free.first().map(|free| free.constant);
    let stds = total_standard_deviations(problem, &minimum);
    if let Some(last) = last.filter(|_| stds.iter().enumerate().any(|(i, std)| *std > widest(&problem.constants, i))) {
        let piece = problem.constants.free[0].piece.unwrap_or(0);
        let value = problem.constants.values(&minimum.parameters, piece)[last];
        problem.constants.rest(last, Rest::Held(value));
        minimum = least_squares(problem, &[], None)?;
    }
    Ok(minimum)
}

/// The value of a constant that all pieces share.
fn shared_value(constants: &FreeConstants, parameters: &[f64], constant: usize) -> Option<f64> {
    let index = constants.free.iter().position(|free| free.constant == constant && free.piece.is_none())?;
    Some(constants.value(index, parameters[index]))
}

/// Whether what is usual of a constant, `at_rest`, lies outside its 95 % interval where it was `free`: an interval too wide for a
/// result may still leave it out, and to rest there would cost the others.
fn is_spoken_against(problem: &FrequencyProblem, free: &FreeConstants, at: &Minimum, at_rest: &Minimum) -> bool {
    let [there, here] = [(&problem.constants, at_rest), (free, at)]
        .map(|(constants, at)| problem.linearised(&at.predictions, constants));
    let noise = Noise::left(problem, &here);
    there.quadratic().cost - here.quadratic().cost > HALF_95.powi(2) * noise.wide_variance()
}

/// The minimum of a quick search alone.
fn quick_trial(problem: &FrequencyProblem, start: &[f64], quick: Option<&Arc<[FrequencySet]>>) -> Option<Minimum> {
    let nearby = problem.on(quick?);
    let linearise = |parameters: &[f64]| nearby.linearise(parameters).map(|at| at.quadratic());
    let (found, _) = descend(linearise, start, &problem.constants.bounds(), LOOK).ok()?;
    let predictions = nearby.predictions(&found.parameters).ok()?;
    Some(Minimum { parameters: found.parameters, predictions, quick: None })
}

/// How well the frequencies were met and predicted before a constant was freed.
struct Reached {
    /// Rms error \[%\] of frequencies left out; `None` without enough of them.
    prediction: Option<f64>,
    /// Whether more is left than what frequencies scatter.
    misses: bool,
}

impl Reached {
    fn of(problem: &FrequencyProblem, at: &Minimum) -> Self {
        let at = problem.linearised(&at.predictions, &problem.constants);
        let mean = at.quadratic().cost / problem.count() as f64;
        Self {
            prediction: prediction_error(&at),
            misses: mean > BEYOND_CHANCE.powi(2) * Noise::stated(problem).variance,
        }
    }
}

/// Whether a constant just freed is seen, lies inside its bounds, and does not worsen the prediction by more than a factor.
///
/// Where no frequency can be left out, it pays if those that there are could not be met without it.
fn pays(problem: &FrequencyProblem, trial: &Minimum, freed: usize, reached: &Reached, factor: f64) -> bool {
    let constants = &problem.constants;
    let at = problem.linearised(&trial.predictions, constants);
    // While constants that rest leave a large miss, this is no noise.
    let noise = if reached.misses { Noise::stated(problem) } else { Noise::left(problem, &at) };
    let stds = noise.standard_deviations(&at);
    let mut own = (0..constants.count()).filter(|&index| constants.free[index].constant == freed);
    let seen = own.all(|index| !is_open(constants, index, trial.parameters[index], stds[index]));
    seen && match (reached.prediction, prediction_error(&at)) {
        (Some(before), Some(after)) => after <= factor * before,
        _ => reached.misses,
    }
}

/// Rms error \[%\] of frequencies left out; `None` without enough of them.
pub(super) fn prediction_error(at: &Linearised) -> Option<f64> {
    at.quadratic().covariance().and_then(|matrix| left_one_out_percent(at, &matrix))
}

/// The waiting constant that the data would show best, if they would show it.
fn best_seen(problem: &FrequencyProblem, all: &FreeConstants, at: &Minimum, waiting: &[usize]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for &constant in waiting {
        let (constants, _) = as_if_freed(problem, all, &at.parameters, &[constant]);
        let stds = Noise::stated(problem).standard_deviations(&problem.linearised(&at.predictions, &constants));
        let own = (0..constants.count()).filter(|&index| constants.free[index].constant == constant);
        let ratio = own.map(|index| stds[index] / widest(&constants, index)).fold(0.0, f64::max);
        if ratio <= 1.0 && best.is_none_or(|(_, least)| ratio < least) {
            best = Some((constant, ratio));
        }
    }
    best.map(|(constant, _)| constant)
}

/// The constants with more of them free, and the parameters at the values that all have.
pub(super) fn as_if_freed(
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

/// Parameters of `to` at the values that the constants have in `from`.
fn freed_parameters(from: &FreeConstants, parameters: &[f64], to: &FreeConstants) -> Vec<f64> {
    let value = |free: &FreeConstant| from.values(parameters, free.piece.unwrap_or(0))[free.constant];
    to.free.iter().enumerate().map(|(index, free)| to.parameter(index, value(free))).collect()
}
