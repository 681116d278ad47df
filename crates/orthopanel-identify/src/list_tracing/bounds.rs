//! Parameters that ended on a bound: then their value is the bound's, not the data's.

use orthopanel_model::{Piece, Scale};

use super::hypothesis::{Hypothesis, Switched, ends_of_range, is_place};

/// A damping ratio moves no frequency.
const UNTOLD: &str = "zeta";

/// Effect and parameter on a bound, of the effects beyond the first `declared`.
pub(super) fn on_bound(hypothesis: &Hypothesis, declared: usize, piece: &Piece) -> Option<String> {
    hypothesis.effects.iter().skip(declared).find_map(|on| of_effect(on, piece))
}

/// What is said of it.
pub(super) fn note(parameter: &str) -> String {
    format!("{parameter} lies on its bound: the bound tells that value, not the data, so it explains nothing")
}

fn of_effect(on: &Switched, piece: &Piece) -> Option<String> {
    let parameters = on.effect.parameters();
    parameters.iter().zip(&on.values).find_map(|(parameter, &value)| {
        // A number of a record has no bounds, the end of a piece is a place, a spring without give is a clamp, and what was held was not looked for.
        let is_rigid = on.effect.id() == "support-compliance";
        let is_number = parameter.scale == Scale::Index;
        if is_number || is_place(parameter) || parameter.held_at.is_some() || parameter.name == UNTOLD {
            return None;
        }
        // A parameter that ended on its bound was left there, and is no longer free: so all values are looked at.
        let [low, high] = ends_of_range(parameter.scale, parameter.range_looked_for(piece), value);
        let ends = low || high && !is_rigid;
        ends.then(|| format!("{} of {}", parameter.name, on.effect.id()))
    })
}
