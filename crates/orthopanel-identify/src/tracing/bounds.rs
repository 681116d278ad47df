//! Parameters that ended on a bound: then their value is the bound's, not the data's.

use orthopanel_model::{Piece, Scale};

use super::hypothesis::{FreeParameter, Hypothesis, Switched, ends_of_range, is_place};
use super::rough::ROUGHNESS;
use crate::error::spaced;
use crate::outcome::Verdict;

/// Effect and parameter on a bound, of the effects beyond the first `declared`; parameters of the names that are `untold` show in no
/// data of this kind.
pub(super) fn on_bound(hypothesis: &Hypothesis, declared: usize, piece: &Piece, untold: &[&str]) -> Option<String> {
    hypothesis.effects.iter().skip(declared).find_map(|on| of_effect(on, piece, untold))
}

/// What is said of it.
pub(super) fn note(parameter: &str) -> String {
    format!("{parameter} lies on its bound: the bound tells that value, not the data, so it explains nothing")
}

/// A sentence on each number that a search of records left on a bound. The first `declared` effects are the test file's, which left
/// these numbers out.
pub(super) fn notes_on_bound(hypothesis: &Hypothesis, declared: usize, verdict: Verdict) -> Vec<String> {
    let mut notes = Vec::new();
    for (index, on) in hypothesis.effects.iter().enumerate() {
        for free in on.free.iter().filter(|free| free.on_bound(on.values[free.at])) {
            let Some(told) = value_text(on, free) else { continue };
            let id = on.effect.id();
            let means = match (index < declared, verdict) {
                _ if id == ROUGHNESS => "no test by hand is so rough, so it stands for something else",
                (true, _) => {
                    "the test file declares it without this number, and the data do not tell it: give the number, or leave the \
                     effect out"
                }
                (false, Verdict::Unexplained) => "the bound tells that number, not the data",
                (false, _) => "the name fits, the number is the bound's",
            };
            notes.push(format!("{told} of {id} lies on the bound of what is looked for: {means}"));
        }
    }
    notes
}

/// Such as `stiffness = 1.0e0 N/m`; of a number that each record has of its own, with the record's.
fn value_text(on: &Switched, free: &FreeParameter) -> Option<String> {
    let (parameter, value) = (on.effect.parameters().get(free.parameter)?, on.values.get(free.at)?);
    let unit = spaced(parameter.unit);
    let record = free.record.map_or(String::new(), |record| format!(" in record {}", record + 1));
    Some(format!("{} = {value:.1e}{unit}{record}", parameter.name))
}

fn of_effect(on: &Switched, piece: &Piece, untold: &[&str]) -> Option<String> {
    let parameters = on.effect.parameters();
    if on.values.len() != parameters.len() {
        return None;
    }
    parameters.iter().zip(&on.values).find_map(|(parameter, &value)| {
        // A number of a record has no bounds, the end of a piece is a place, a spring without give is a clamp, and what was held was not looked for.
        let is_rigid = on.effect.id() == "support-compliance";
        let is_number = parameter.scale == Scale::Index;
        if is_number || is_place(parameter) || parameter.held_at.is_some() || untold.contains(&parameter.name) {
            return None;
        }
        // A parameter that ended on its bound was left there, and is no longer free: so all values are looked at.
        let [low, high] = ends_of_range(parameter.scale, parameter.range_looked_for(piece), value);
        let ends = low || high && !is_rigid;
        ends.then(|| format!("{} of {}", parameter.name, on.effect.id()))
    })
}
