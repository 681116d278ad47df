//! Modes that the test file may have named wrongly: a wrong name is a wrong equation, and bends all constants.

use orthopanel_data::ImpactTest;
use rayon::prelude::*;

use super::changed_pairs::{changed_pairs, near_pairs};
use super::noise::{self, Noise};
use super::other_readings::read_otherwise;
use super::problem::{FrequencyProblem, Renamed};
use super::seen_constants::minimise_what_is_seen;
use super::starting_values::starting_values;
use crate::IdentifyError;
use crate::free_constants::{FreeConstant, FreeConstants, RestingFreed};
use crate::least_squares::{Ending, Linearised, Quadratic, descend};
use crate::structures::{Shown, SpectrumLine};

/// A mode that misses its frequency by less is what it is called, or so near its neighbour that no list can tell.
const LARGE_MISS: f64 = 0.01;
/// A name that belongs to another line leaves some line further off than this, and lists whose names are right are met better.
const FAR_OFF: f64 = 0.03;
/// Another mode is meant where it misses by less than this part.
const FAR_NEARER: f64 = 0.25;
/// Other names are told where they leave less than this part of the sum of squares: a third of the error.
const FAR_BETTER: f64 = 1.0 / 9.0;
/// Scatters \[1\] of good lines, in turn: from where wrong ones still pull to what a good model leaves.
const SCATTERS: [f64; 3] = [2e-2, 1e-2, 4e-3];

/// A sentence for each line of a plate's list with another name, where the list with these names is met far better.
///
/// The constants are found again under Cauchy's error $\sum\ln(1+r^2/s^2)$, for which a line that stands out counts for
/// little, from where they were found and from what is usual: a line that then lies far from the mode it names and near another
/// may be that one. Where this leads to nothing, two lines are tried with each other's names, the likeliest pairs of a usual panel
/// first. Where the list is missed, but no line by much, two that are neighbours may have changed their names. What is told has
/// been tried: the whole identification under the new names leaves a third of the error or less.
pub(super) fn doubtful_names(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &[f64],
    at: &Linearised,
) -> Result<Vec<String>, IdentifyError> {
    let least = noise::BEYOND_CHANCE.powi(2) * Noise::stated(problem).variance * problem.count() as f64;
    let stands_out = at.residuals.iter().any(|residual| residual.abs() >= LARGE_MISS);
    let cost = at.quadratic().cost;
    if problem.structure.shown() == Shown::Wholly || !(stands_out || cost > least) {
        return Ok(Vec::new());
    }
    let whole = FrequencyProblem::of(test)?;
    let most = (FAR_BETTER * cost).min(FAR_OFF.powi(2) * problem.count() as f64);
    let best = |names: Vec<Vec<Renamed>>| best_of(test, &whole, names, most);
    let mut told = None;
    if stands_out {
        told = best(robust_names(problem, &whole, found)?);
        if told.is_none() {
            told = best(changed_pairs(&whole)?);
        }
    }
    match told.or_else(|| best(near_pairs(&whole))) {
        Some(tried) => tried.notes(test, &whole),
        None if stands_out => {
            let apart = lines_apart(test, problem, &whole, found)?;
            let is_far_off = at.residuals.iter().any(|residual| residual.abs() > FAR_OFF);
            if apart.is_empty() && is_far_off { read_otherwise(test, &whole, most) } else { Ok(apart) }
        }
        None => Ok(Vec::new()),
    }
}

/// Most lines that may stand apart, as a part of all.
const MOST_APART: f64 = 0.25;

/// The others are met where they are missed by no more than so many times what they scatter.
const OTHERS_MET: f64 = 1.5;

/// A sentence for each line that stands apart from others which are met, though it is no other mode's either.
fn lines_apart(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    whole: &FrequencyProblem,
    found: &[f64],
) -> Result<Vec<String>, IdentifyError> {
    // What the plate lacks moves several lines: only where all others are met does one stand apart.
    let most = OTHERS_MET.powi(2) * Noise::stated(problem).variance * problem.count() as f64;
    let mut best: Option<(f64, Vec<String>)> = None;
    for (more, parameters) in robust_minima(problem, whole, found)? {
        let Ok(predictions) = more.predictions(&parameters) else { continue };
        let (mut apart, mut others) = (Vec::new(), 0.0);
        for (set, predicted) in more.sets.iter().zip(&predictions) {
            let lines = set.measured.iter().zip(set.modes.nodes()).zip(&predicted.modes);
            for ((measured, nodes), mode) in lines {
                let miss = mode.frequency / measured - 1.0;
                if miss.abs() <= LARGE_MISS {
                    others += miss * miss;
                    continue;
                }
                apart.push(format!(
                    "piece {}, {measured} Hz named {nodes:?}: the other frequencies put that mode at {:.1} Hz; look at this \
                     frequency and at its mode's shape again",
                    test.pieces[set.piece].name, mode.frequency
                ));
            }
        }
        let few = !apart.is_empty() && apart.len() as f64 <= MOST_APART * whole.count() as f64;
        if few && others < best.as_ref().map_or(most, |(least, _)| *least) {
            best = Some((others, apart));
        }
    }
    Ok(best.map_or_else(Vec::new, |(_, apart)| apart))
}

/// The same where no search ended under the names that the test has: `error` \[% rms\] is that of the last step.
pub(super) fn names_with_a_minimum(test: &ImpactTest, error: f64) -> Result<Vec<String>, IdentifyError> {
    let whole = FrequencyProblem::of(test)?;
    let cost = (0.01 * error).powi(2) * whole.count() as f64;
    let most = (FAR_BETTER * cost).min(FAR_OFF.powi(2) * whole.count() as f64);
    let told = best_of(test, &whole, changed_pairs(&whole)?, most);
    told.map_or_else(|| read_otherwise(test, &whole, most), |tried| tried.notes(test, &whole))
}

/// Neighbours that are tried with each other's names where no name is in clear doubt.
const FEW_PAIRS: usize = 2;

/// What is said of neighbours that are met better, though not far better, with each other's names than `found` is.
///
/// With errors of one unknown size in all lines the odds of the names are $(Q/Q')^{d/2}$, $Q$ and $Q'$ the sums of squares that they leave and $d$ the lines
/// beyond the constants.
pub(super) fn neighbours_met_better(test: &ImpactTest, problem: &FrequencyProblem, cost: f64) -> Option<String> {
    let whole = FrequencyProblem::of(test).ok()?;
    let pairs = near_pairs(&whole);
    let tried = pairs.into_par_iter().take(FEW_PAIRS).filter_map(|names| Tried::of(test, &whole, names));
    let best = tried.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let free = problem.constants.count().max(best.problem.constants.count());
    let odds = (cost / best.cost).powf(0.5 * whole.count().saturating_sub(free) as f64);
    let lines: Vec<String> = best
        .names
        .iter()
        .map(|&Renamed { set, line, .. }| {
            let own = &whole.sets[set];
            format!("{} Hz named {:?}", own.measured[line], own.modes.nodes()[line])
        })
        .collect();
    (odds > 1.0).then(|| {
        format!(
            "{} lie near each other and may have each other's names: read so, a plate meets the list to {:.2} % rms (odds of {odds:.1} to 1); look at \
             the shapes of both",
            lines.join(" and "),
            100.0 * (best.cost / whole.count() as f64).sqrt()
        )
    })
}

/// The first names that leave less than `most` of the sum of squares: the likeliest come first, two side by side.
fn best_of(test: &ImpactTest, whole: &FrequencyProblem, names: Vec<Vec<Renamed>>, most: f64) -> Option<Tried> {
    names.chunks(2).find_map(|few| {
        let tried = few.par_iter().filter_map(|names| Tried::of(test, whole, names.clone()));
        tried.filter(|tried| tried.cost < most).min_by(|a, b| a.cost.total_cmp(&b.cost))
    })
}

/// Other names, and what is left under them.
struct Tried {
    names: Vec<Renamed>,
    problem: FrequencyProblem,
    values: Vec<Vec<f64>>,
    cost: f64,
}

impl Tried {
    fn of(test: &ImpactTest, whole: &FrequencyProblem, names: Vec<Renamed>) -> Option<Self> {
        let mut problem = whole.read_as(test, &names, None).ok()?;
        let start = starting_values(&problem).ok()?;
        let minimum = minimise_what_is_seen(&mut problem, &start).ok()?;
        let cost = problem.linearised(&minimum.predictions, &problem.constants).quadratic().cost;
        let values = minimum.predictions.into_iter().map(|set| set.values).collect();
        Some(Self { names, problem, values, cost })
    }

    fn notes(&self, test: &ImpactTest, whole: &FrequencyProblem) -> Result<Vec<String>, IdentifyError> {
        let mut notes = Vec::new();
        for &Renamed { set, line, nodes } in &self.names {
            let spectrum = self.problem.sets[set].modes.spectrum(&self.values[set])?;
            let at = |nodes: [usize; 2]| {
                let named = spectrum.iter().find(|line| line.nodes == nodes);
                named.map_or("elsewhere".to_owned(), |line| format!("at {:.1} Hz", line.frequency))
            };
            let (measured, named) = (whole.sets[set].measured[line], whole.sets[set].modes.nodes()[line]);
            notes.push(format!(
                "piece {}, {measured} Hz named {named:?}: the other frequencies put that mode {}, and {nodes:?} {}; look at \
                 this mode's shape again",
                test.pieces[whole.sets[set].piece].name,
                at(named),
                at(nodes),
            ));
        }
        Ok(notes)
    }
}

/// The names that lines near another mode should have, by robust searches from several starts.
fn robust_names(
    problem: &FrequencyProblem,
    whole: &FrequencyProblem,
    found: &[f64],
) -> Result<Vec<Vec<Renamed>>, IdentifyError> {
    let mut names: Vec<Vec<Renamed>> = Vec::new();
    for (more, minimum) in robust_minima(problem, whole, found)? {
        let proposed = proposed_names(&more, &minimum)?;
        if !proposed.is_empty() && !names.contains(&proposed) {
            names.push(proposed);
        }
    }
    Ok(names)
}

/// The robust minima from where the constants were found, from what is usual, and from that at the size that half of the lines
/// want: a single wrong line pulls the size of all.
fn robust_minima(
    problem: &FrequencyProblem,
    whole: &FrequencyProblem,
    found: &[f64],
) -> Result<Vec<(FrequencyProblem, Vec<f64>)>, IdentifyError> {
    let RestingFreed { constants, parameters, usual_stds } = problem.constants.with_resting_freed(found);
    let usual = at_usual_values(&constants, &whole.constants, &starting_values(whole)?);
    let of = |constants: &FreeConstants| FrequencyProblem {
        structure: problem.structure,
        constants: constants.clone(),
        sets: problem.sets.clone(),
    };
    let more = of(&constants);
    let median = at_median_size(&more, &usual);
    let mut minima = Vec::new();
    for start in [Some(parameters), Some(usual), median].into_iter().flatten() {
        if let Some(minimum) = robust_minimum(&more, &start, &usual_stds)? {
            minima.push((of(&constants), minimum));
        }
    }
    Ok(minima)
}

/// Parameters with the factor on all moduli that half of the lines want more and half less.
fn at_median_size(more: &FrequencyProblem, parameters: &[f64]) -> Option<Vec<f64>> {
    if !more.constants.moduli_are_free() {
        return None;
    }
    let predictions = more.predictions(parameters).ok()?;
    let lines = more.sets.iter().zip(&predictions);
    let lines = lines.flat_map(|(set, at)| set.measured.iter().zip(&at.modes));
    let mut ratios: Vec<f64> = lines.map(|(measured, mode)| (measured / mode.frequency).ln()).collect();
    ratios.sort_by(f64::total_cmp);
    let log_factor = 2.0 * ratios.get(ratios.len() / 2)?;
    let scaled = |(index, parameter): (usize, &f64)| {
        let is_modulus = more.constants.is_modulus(more.constants.free[index].constant);
        if is_modulus { parameter + log_factor } else { *parameter }
    };
    Some(parameters.iter().enumerate().map(scaled).collect())
}

/// The usual start in the order of these parameters.
fn at_usual_values(constants: &FreeConstants, all: &FreeConstants, start: &[f64]) -> Vec<f64> {
    let usual = |(index, free): (usize, &FreeConstant)| {
        let at = all.free.iter().position(|other| other == free);
        let at = at.or_else(|| all.free.iter().position(|other| other.constant == constants.free[index].constant));
        at.map_or(f64::NAN, |at| start[at])
    };
    constants.free.iter().enumerate().map(usual).collect()
}

fn robust_minimum(
    more: &FrequencyProblem,
    start: &[f64],
    usual_stds: &[f64],
) -> Result<Option<Vec<f64>>, IdentifyError> {
    let mut parameters = start.to_vec();
    for scatter in SCATTERS {
        let Ok(predictions) = more.predictions(&parameters) else { return Ok(None) };
        let nearby = more.near(&predictions)?.map_or_else(|| more.on(&more.sets), |sets| more.on(&sets));
        let robust = |trial: &[f64]| -> Result<Quadratic, IdentifyError> {
            Ok(cauchy(&nearby.linearise(trial)?, trial, start, usual_stds, scatter))
        };
        let Ok((minimum, _)) = descend(robust, &parameters, &more.constants.bounds(), Ending::WITH_JUMPS) else {
            return Ok(None);
        };
        parameters = minimum.parameters;
    }
    Ok(Some(parameters))
}

/// The lines that lie far from the mode they name and near another.
fn proposed_names(more: &FrequencyProblem, parameters: &[f64]) -> Result<Vec<Renamed>, IdentifyError> {
    let Ok(predictions) = more.predictions(parameters) else { return Ok(Vec::new()) };
    let mut names = Vec::new();
    for (index, (set, predicted)) in more.sets.iter().zip(predictions).enumerate() {
        let spectrum = set.modes.spectrum(&predicted.values)?;
        let named = set.modes.nodes();
        for (line, (measured, own)) in set.measured.iter().zip(&predicted.modes).enumerate() {
            let miss = |frequency: f64| (frequency / measured - 1.0).abs();
            let nearest = spectrum.iter().min_by(|a, b| miss(a.frequency).total_cmp(&miss(b.frequency)));
            let meant = |near: &&SpectrumLine| {
                let most = LARGE_MISS.min(FAR_NEARER * miss(own.frequency));
                near.nodes != named[line] && miss(near.frequency) < most
            };
            if let Some(near) = nearest.filter(|_| miss(own.frequency) > LARGE_MISS).filter(meant) {
                names.push(Renamed { set: index, line, nodes: near.nodes });
            }
        }
    }
    Ok(names)
}

/// Cauchy's error of the lines, and of the last parameters what they lie beside the usual ones.
fn cauchy(at: &Linearised, parameters: &[f64], usual: &[f64], usual_stds: &[f64], scatter: f64) -> Quadratic {
    let count = parameters.len();
    let mut sum = Quadratic::zero(count);
    for (i, residual) in at.residuals.iter().enumerate() {
        let ratio2 = (residual / scatter).powi(2);
        let weight = (1.0 + ratio2).sqrt().recip();
        let row: Vec<(usize, f64)> = (0..count).map(|j| (j, weight * at.jacobian[(i, j)] / scatter)).collect();
        sum.add_row(weight * residual / scatter, &row);
        sum.cost += ratio2.ln_1p() - (weight * residual / scatter).powi(2);
    }
    for (j, std) in (count - usual_stds.len()..count).zip(usual_stds) {
        sum.add_row((parameters[j] - usual[j]) / std, &[(j, std.recip())]);
    }
    sum.mirror();
    sum
}
