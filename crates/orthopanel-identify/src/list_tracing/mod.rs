//! Tracing in lists of natural frequencies: the same question over modes.
//!
//! Where the scatter is not told, the criterion is that of an unknown variance, $n\ln(R/n) + k\ln n$ with the sum of squares $R$ of the
//! relative errors, and what is held out is one frequency after the other. Whatever the ranking says, the verdict goes by what is missed
//! ([`trust`]).

mod across;
mod bounds;
mod declared;
mod further_list;
mod hypothesis;
mod lacking;
mod list_fit;
mod list_problem;
mod parting;
mod pieces_that_differ;
mod places;
mod repeats;
mod report;
mod scored_starts;
mod seen;
mod start_grid;
mod traced_effects;
mod trust;
mod verdict;
mod width;

use orthopanel_data::{ImpactTest, MeasurementData, limits};
use orthopanel_model::catalogue;
use rayon::prelude::*;

use crate::IdentifyError;
use crate::outcome::{NotTested, Progress, Tracing};
pub(crate) use declared::identify_lists;
use hypothesis::{Hypothesis, PLATE, RESONATOR, Switched, has_place, is_place};
use list_fit::{ListFit, fit};
use list_problem::ListProblem;
use places::{PlaceOf, over_places};
pub(crate) use repeats::without_repeats;
use scored_starts::left_by_each;
use seen::{never_shows, not_seen, only_seen};
use start_grid::StartGrid;
use verdict::CLEAR;

/// Names the effect that the base model lacks in the natural frequencies of a test.
///
/// # Errors
/// As [`crate::trace()`].
pub(crate) fn trace_lists(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    let declared = Hypothesis::declared(test)?;
    let (test, notes) = &without_repeats(test);
    let listed = |data: &MeasurementData| match data {
        MeasurementData::NaturalFrequencies(list) => list.values.len(),
        _ => 0,
    };
    let longest = test.measurements.iter().map(|of| listed(&of.data)).max().unwrap_or(0);
    if longest > limits::FREQUENCIES_TRACED {
        return Err(IdentifyError::TooManyFrequencies { found: longest, most: limits::FREQUENCIES_TRACED });
    }
    let most = limits::FREQUENCIES_TRACED_OF_PIECE;
    for (index, piece) in test.pieces.iter().enumerate() {
        let of_piece = test.measurements.iter().filter(|of| of.piece == index);
        let found = of_piece.map(|of| listed(&of.data)).sum();
        if found > most {
            return Err(IdentifyError::TooManyFrequenciesOfPiece { piece: piece.name.clone(), found, most });
        }
    }
    let problem = ListProblem::of(test)?;
    let (declared, held) = &only_seen(&problem, &problem.usual(), declared)?;
    let base = fit(&problem, declared, &problem.usual())?;
    if problem.count() <= base.size {
        let (found, needed) = (problem.count(), base.size + 1);
        let names = "and one more, to judge by".to_owned();
        return Err(IdentifyError::TooFewFrequencies { found, needed, names });
    }
    let constants = base.parameters[..problem.constants.count()].to_vec();
    let count = problem.count();
    let mut fits = vec![base];
    let mut not_tested = Vec::new();
    let mut wants_more = Vec::new();
    for (done, &effect) in catalogue().iter().enumerate() {
        let id = effect.id();
        progress(Progress { effect: id, done, of: catalogue().len() });
        if declared.holds(effect) {
            continue;
        }
        let refused = |reason: &str| NotTested { id, reason: reason.to_owned() };
        if let Some(reason) = never_shows(effect) {
            not_tested.push(refused(reason));
            continue;
        }
        if has_place(effect) && problem.pieces() > 1 {
            not_tested.push(refused("each piece would have a place of its own: trace one piece in a test file"));
            continue;
        }
        if id == PLATE && !declared.effects.is_empty() {
            not_tested.push(refused("the effects that the test file declares act on beams"));
            continue;
        }
        // More frequencies make nothing seen that no frequency shows: said first.
        let usual = Switched::new(effect, &problem.largest_piece(), |_| None, |_| false);
        let seen = if id == PLATE { Ok(Ok(usual)) } else { not_seen(&problem, &constants, declared, usual) };
        let seen = match seen {
            Ok(Ok(on)) => on,
            Ok(Err(reason)) => {
                not_tested.push(refused(reason));
                continue;
            }
            Err(error) => {
                not_tested.push(NotTested { id, reason: error.to_string() });
                continue;
            }
        };
        // The plate frees Poisson's ratio first; its other constants answer for themselves.
        let free = if id == PLATE { 1 } else { seen.free.len() };
        let unknowns = problem.constants.count() + declared.size() + free;
        if count < DATA_FOR_EACH * unknowns {
            let reason =
                format!("{count} frequencies for {unknowns} unknowns: measure {DATA_FOR_EACH} or more for each");
            not_tested.push(NotTested { id, reason });
            wants_more.push((id, free));
            continue;
        }
        let found = match id {
            PLATE => width::fit_plate(test, &problem),
            _ => alone(&problem, declared, &seen, &constants),
        };
        match found {
            Ok(found) if is_tuned_above(&found, problem.top()) => not_tested.push(refused(ABOVE)),
            Ok(found) if !found.bic().is_finite() || !found.left_out_percent().is_finite() => {
                not_tested.push(refused("its criterion is no finite number"));
            }
            Ok(found) => fits.push(found),
            Err(error) => not_tested.push(NotTested { id, reason: error.to_string() }),
        }
    }
    progress(Progress { effect: "places of what was found", done: catalogue().len(), of: catalogue().len() });
    let fits = in_all_places(&problem, fits, declared.effects.len());
    let mut found = report::report(test, &problem, fits, (not_tested, wants_more), declared.effects.len())?;
    found.notes.extend(notes.iter().chain(held).cloned());
    Ok(found)
}

/// With intervals over every place where it does as well: each effect that may be named.
fn in_all_places(problem: &ListProblem, fits: Vec<ListFit>, declared: usize) -> Vec<ListFit> {
    let least = fits.iter().map(ListFit::bic).fold(f64::INFINITY, f64::min);
    let piece = problem.largest_piece();
    let widened = |found: ListFit| {
        let place = found.hypothesis.effects.get(declared).and_then(|on| {
            let whole = Switched::new(on.effect, &piece, |_| None, |_| false);
            whole.free.into_iter().find(|free| is_place(&on.effect.parameters()[free.at]))
        });
        match place {
            Some(place) if found.bic() < least + CLEAR => {
                over_places(problem, found, PlaceOf { effect: declared, place })
            }
            _ => found,
        }
    };
    fits.into_par_iter().map(widened).collect()
}

const ABOVE: &str = "no resonator tuned within the listed frequencies meets them, and one tuned above these is a mass where it sits: see local-mass";

/// Whether the last effect is a resonator that acts as a mass up to `top` \[Hz\].
fn is_tuned_above(found: &ListFit, top: f64) -> bool {
    let resonator = found.hypothesis.effects.last().filter(|on| on.effect.id() == RESONATOR);
    resonator.is_some_and(|on| {
        let tuned = on.effect.parameters().iter().zip(&on.values).find(|(parameter, _)| parameter.name == "frequency");
        tuned.is_some_and(|(_, &frequency)| frequency > top)
    })
}

/// Frequencies for each unknown: with fewer an effect with a place or two parameters fits by chance.
const DATA_FOR_EACH: usize = 2;

/// Starts that are followed to their minimum.
const FOLLOWED: usize = 4;

/// The best of an effect's starts; a parameter that ends on its bound is left there, and no longer counts.
fn alone(
    problem: &ListProblem,
    declared: &Hypothesis,
    seen: &Switched,
    constants: &[f64],
) -> Result<ListFit, IdentifyError> {
    let effect = seen.effect;
    let piece = problem.largest_piece();
    let grid = StartGrid::of(seen, &piece, problem.longest(), &problem.listed());
    let switched: Vec<Hypothesis> = grid
        .starts()
        .map(|start| {
            let at =
                |name: &str| effect.parameters().iter().position(|parameter| parameter.name == name).map(|i| start[i]);
            let mut on = Switched::new(effect, &piece, at, |_| false);
            on.free.retain(|free| seen.free.contains(free));
            declared.and(on)
        })
        .collect();
    let followed = |problem: &ListProblem| -> Vec<Result<ListFit, IdentifyError>> {
        let left = match left_by_each(problem, (declared, constants), &switched) {
            Ok(left) => left,
            Err(error) => return vec![Err(error.into())],
        };
        let best = grid.valleys(&left).into_par_iter().take(FOLLOWED);
        best.map(|start| led(problem, &switched[start], constants)).collect()
    };
    let mut fitted = followed(problem);
    if problem.scatter().is_some() {
        // Weights sharpen the valleys between minima: without them the way is found, with them the minimum.
        let found: Vec<ListFit> = followed(&problem.unweighed()).into_iter().flatten().collect();
        let polished = |found: ListFit| rested(problem, &found.hypothesis, found.constants(problem));
        fitted.extend(found.into_par_iter().map(polished).collect::<Vec<_>>());
    }
    let (found, refused): (Vec<_>, Vec<_>) = fitted.into_iter().partition(Result::is_ok);
    let told = |found| mirrored(problem, found, declared.effects.len());
    let mut found: Vec<ListFit> = found.into_iter().flatten().map(told).collect();
    // What rests on a bound counts fewer parameters, and stands no nearer for that.
    found.sort_by(|a, b| a.missed().total_cmp(&b.missed()));
    let mut found = found.into_iter();
    let best = found.next().map(|best| ListFit { other_minima: found.collect(), ..best });
    let reason = refused.into_iter().find_map(Result::err);
    best.ok_or_else(|| reason.unwrap_or_else(|| IdentifyError::Unsupported(format!("{}: no start", effect.id()))))
}

/// From a start to its minimum: first the constants, which else leap in the first step and take the effect out of its valley.
fn led(problem: &ListProblem, start: &Hypothesis, constants: &[f64]) -> Result<ListFit, IdentifyError> {
    let mut held = start.clone();
    if let Some(on) = held.effects.last_mut() {
        on.free.clear();
    }
    let settled = fit(problem, &held, constants)?;
    rested(problem, start, settled.constants(problem))
}

fn rested(problem: &ListProblem, from: &Hypothesis, constants: &[f64]) -> Result<ListFit, IdentifyError> {
    let found = fit(problem, from, constants)?;
    let mut rested = found.hypothesis.clone();
    if rested.rest_on_bounds() { fit(problem, &rested, constants) } else { Ok(found) }
}

/// The same with its place at x > 0, where the frequencies are the same there.
fn mirrored(problem: &ListProblem, mut found: ListFit, from: usize) -> ListFit {
    let mut hypothesis = found.hypothesis.clone();
    let Some(on) = hypothesis.effects.get_mut(from) else { return found };
    let Some(at) = on.effect.parameters().iter().position(is_place) else { return found };
    let Some(x) = on.values.get_mut(at) else { return found };
    *x = -*x;
    let turned = *x > 0.0;
    let parameters = [found.constants(problem), &hypothesis.coordinates()].concat();
    let Ok(there) = problem.residuals(&parameters, &hypothesis) else { return found };
    found.mirrored = there.iter().zip(&found.residuals).all(|(a, b)| (a - b).abs() < ALIKE);
    if found.mirrored && turned {
        (found.hypothesis, found.parameters) = (hypothesis, parameters);
    }
    found
}

/// Relative difference of frequencies that are the same.
const ALIKE: f64 = 1e-8;
