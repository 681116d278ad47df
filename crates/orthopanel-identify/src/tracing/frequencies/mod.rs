//! Tracing in lists of natural frequencies: the same question over modes.
//!
//! Noise is not told, so the criterion is that of an unknown variance, $n\ln(R/n) + k\ln n$ with the sum of squares $R$ of the
//! relative errors, and what is held out is one frequency after the other.

mod declared;
mod lacking;
mod list_fit;
mod list_problem;
mod parting;
mod report;
mod trust;
mod verdict;
mod width;

use orthopanel_data::{ImpactTest, Measurement, MeasurementData};
use orthopanel_model::{Effect, Owner, catalogue};
use rayon::prelude::*;

use super::hypothesis::{Hypothesis, PLATE, Switched, has_place};
use super::outcome::{NotTested, Tracing};
use crate::IdentifyError;
pub(super) use declared::identify_lists;
use list_fit::{ListFit, fit};
use list_problem::ListProblem;

/// Names the effect that the base model lacks in the natural frequencies of a test.
///
/// # Errors
/// As [`super::trace`].
pub(super) fn trace_frequencies(test: &ImpactTest, declared: &Hypothesis) -> Result<Tracing, IdentifyError> {
    let problem = ListProblem::of(test)?;
    let base = fit(&problem, declared, &problem.usual())?;
    if problem.count() <= base.size {
        let (found, needed) = (problem.count(), base.size + 1);
        let names = "and one more, to judge by".to_owned();
        return Err(IdentifyError::TooFewFrequencies { found, needed, names });
    }
    let constants = base.parameters[..problem.constants.count()].to_vec();
    let count: usize = test.measurements.iter().map(frequencies).sum();
    let mut fits = vec![base];
    let mut not_tested = Vec::new();
    let mut wants_more = Vec::new();
    for &effect in catalogue() {
        let id = effect.id();
        if declared.holds(effect) {
            continue;
        }
        let refused = |reason: &str| NotTested { id, reason: reason.to_owned() };
        if effect.owner() == Owner::Channel {
            not_tested.push(refused("natural frequencies do not pass through the measuring chain's gain and phase"));
            continue;
        }
        if has_place(effect) && problem.pieces() > 1 {
            not_tested.push(refused("each piece would have a place of its own: trace one piece in a test file"));
            continue;
        }
        let unknowns = problem.constants.count() + free_parameters(effect);
        if count < DATA_FOR_EACH * unknowns {
            let reason =
                format!("{count} frequencies for {unknowns} unknowns: measure {DATA_FOR_EACH} or more for each");
            not_tested.push(NotTested { id, reason });
            wants_more.push(id);
            continue;
        }
        if id == PLATE && !declared.effects.is_empty() {
            not_tested.push(refused("the effects that the test file declares act on beams"));
            continue;
        }
        if id == PLATE {
            match width::fit_plate(test, &problem) {
                Ok(found) => fits.push(found),
                Err(error) => not_tested.push(NotTested { id, reason: error.to_string() }),
            }
            continue;
        }
        match alone(&problem, declared, effect, &constants) {
            Ok(found) => fits.push(found),
            Err(error) => not_tested.push(NotTested { id, reason: error.to_string() }),
        }
    }
    report::report(test, &problem, fits, (not_tested, wants_more), declared.effects.len())
}

/// Frequencies for each unknown: with fewer an effect with a place or two parameters fits by chance.
const DATA_FOR_EACH: usize = 2;

fn free_parameters(effect: &dyn Effect) -> usize {
    match effect.id() {
        // The plate frees Poisson's ratio first; its other constants answer for themselves.
        PLATE => 1,
        _ => effect.parameters().iter().filter(|parameter| parameter.held_at.is_none()).count(),
    }
}

fn frequencies(measurement: &Measurement) -> usize {
    match &measurement.data {
        MeasurementData::NaturalFrequencies(data) => data.values.len(),
        _ => 0,
    }
}

/// Starts that are followed to their minimum.
const FOLLOWED: usize = 4;

/// The best of an effect's starts; a parameter that ends on its bound is left there, and no longer counts.
fn alone(
    problem: &ListProblem,
    declared: &Hypothesis,
    effect: &'static dyn Effect,
    constants: &[f64],
) -> Result<ListFit, IdentifyError> {
    let piece = problem.largest_piece();
    let lists = effect
        .parameters()
        .iter()
        .map(|parameter| parameter.held_at.map_or(parameter.starts(&piece), |held| vec![held]));
    let starts = lists.fold(vec![vec![]], |starts: Vec<Vec<f64>>, list| {
        starts.iter().flat_map(|start| list.iter().map(|&value| [&start[..], &[value]].concat())).collect()
    });
    let switched: Vec<Hypothesis> = starts
        .iter()
        .map(|start| {
            let at =
                |name: &str| effect.parameters().iter().position(|parameter| parameter.name == name).map(|i| start[i]);
            declared.and(Switched::new(effect, &piece, 1, at, |_| false))
        })
        .collect();
    let mut scored: Vec<(f64, &Hypothesis)> = switched
        .par_iter()
        .map(|hypothesis| {
            let parameters = [constants, &hypothesis.coordinates()].concat();
            let square = problem.weighed(&parameters, hypothesis).map(|list| list.iter().map(|r| r * r).sum());
            (square.unwrap_or(f64::INFINITY), hypothesis)
        })
        .collect();
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let fitted: Vec<Result<ListFit, IdentifyError>> = scored
        .into_par_iter()
        .take(FOLLOWED)
        .map(|(_, hypothesis)| {
            let found = fit(problem, hypothesis, constants)?;
            let mut rested = found.hypothesis.clone();
            if rested.rest_on_bounds() { fit(problem, &rested, constants) } else { Ok(found) }
        })
        .collect();
    let mut best: Option<ListFit> = None;
    let mut reason = None;
    for found in fitted {
        match found {
            Ok(found) if best.as_ref().is_none_or(|best| found.bic() < best.bic()) => best = Some(found),
            Ok(_) => {}
            Err(error) => reason = reason.or(Some(error)),
        }
    }
    best.ok_or_else(|| reason.unwrap_or_else(|| IdentifyError::Unsupported(format!("{}: no start", effect.id()))))
}
