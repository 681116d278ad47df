//! Whether a declared number is wrong: a sensor's mass that the file tells too large comes back as a negative mass of the panel.

use rayon::prelude::*;

use super::fit::{Fit, fit};
use super::hypothesis::Switched;
use super::ranking::{Ranking, Search};
use super::record_problem::State;
use super::report::{deviations, traced};
use super::verdict::{CLEAR, MET};
use crate::IdentifyError;
use crate::error::spaced;

/// A declared effect with other numbers than the file's that the records ask for.
pub(super) struct Doubt {
    /// Its id.
    pub id: &'static str,
    /// The numbers that meet the records, with those of the file.
    pub sentence: String,
    /// Whether the chosen hypothesis is not clearly ahead of those numbers.
    pub is_rival: bool,
}

/// Each declared effect that lets the records be met, with nothing beside it, once its numbers are free.
///
/// # Errors
/// What the model refuses of a fit that was found.
pub(super) fn doubtful_numbers(search: &Search, ranking: &Ranking) -> Result<Vec<Doubt>, IdentifyError> {
    let begun: Vec<(usize, State)> =
        (0..search.declared()).filter_map(|index| Some((index, freed(search, index)?))).collect();
    let fitted = |(index, state): (usize, State)| Some((index, fit(search.records, state, 0).ok()?));
    let fits: Vec<(usize, Fit)> = begun.into_par_iter().filter_map(fitted).collect();
    let mut doubts = Vec::new();
    for (index, fit) in fits {
        let left = search.records.misfit_over_floor(&fit)?;
        if left <= MET {
            doubts.push(doubt(search, ranking, index, (&fit, left))?);
        }
    }
    Ok(doubts)
}

/// The base with all numbers of one of its effects free that a search may move; `None` where the file holds none of them.
fn freed(search: &Search, index: usize) -> Option<State> {
    let mut state = search.records.start.clone();
    let on = state.hypothesis.effects.get(index)?;
    let records = search.records.problem(0).records.len();
    let parameters = on.effect.parameters();
    let position = |name: &str| parameters.iter().position(|parameter| parameter.name == name);
    // A number of its own in each record is no single value that could be carried over: those are free already, or told one by one.
    if parameters.iter().any(|parameter| parameter.each_record) {
        return None;
    }
    let value = |name: &str| position(name).and_then(|at| on.values.get(at)).copied();
    let free = Switched::new(on.effect, &search.piece, records, value, |_| false);
    if free.free.len() == on.free.len() {
        return None;
    }
    state.hypothesis.effects[index] = free;
    Some(state)
}

fn doubt(search: &Search, ranking: &Ranking, index: usize, (fit, left): (&Fit, f64)) -> Result<Doubt, IdentifyError> {
    let std = deviations(search, ranking, fit)?;
    let all = traced(fit, &std, 0);
    let declared = &search.records.start.hypothesis.effects[index];
    let mut changed = Vec::new();
    for ((parameter, told), was) in all[index].parameters.iter().zip(declared.effect.parameters()).zip(&declared.values)
    {
        let Some(estimate) = parameter.values.first() else { continue };
        let unit = spaced(told.unit);
        if let Some(std) = estimate.std {
            changed.push(format!("{} = {:.4e} +- {std:.1e}{unit} in place of {was:.4e}", told.name, estimate.value));
        }
    }
    let sentence = format!(
        "the declared {} may have a wrong number: the records are met ({:.2} times the noise) with {}",
        declared.effect.id(),
        left.sqrt(),
        changed.join(", ")
    );
    let is_rival = ranking.scale.bic(fit.cost, fit.size) < ranking.bic(ranking.chosen) + CLEAR;
    Ok(Doubt { id: declared.effect.id(), sentence, is_rival })
}
