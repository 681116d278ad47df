//! Parameters that ended on a bound: then their value is the bound's, not the data's.

use super::list_fit::ListFit;
use crate::tracing::hypothesis::{Switched, ends_of_range, is_place};

/// Effect and parameter on a bound, of the effects beyond the first `declared`.
pub(super) fn on_bound(fit: &ListFit, declared: usize, piece: &orthopanel_model::Piece) -> Option<String> {
    fit.hypothesis.effects.iter().skip(declared).find_map(|on| of_effect(on, piece))
}

fn of_effect(on: &Switched, piece: &orthopanel_model::Piece) -> Option<String> {
    let parameters = on.effect.parameters();
    if on.values.len() != parameters.len() {
        return None;
    }
    parameters.iter().zip(&on.values).find_map(|(parameter, &value)| {
        // The end of a piece is a place, a spring without give is a clamp, and what was held was not looked for.
        let is_rigid = on.effect.id() == "support-compliance";
        if is_place(parameter) || parameter.held_at.is_some() || parameter.name == "zeta" {
            return None;
        }
        // A parameter that ended on its bound was left there, and is no longer free: so all values are looked at.
        let [low, high] = ends_of_range(parameter.scale, parameter.range(piece), value);
        let ends = low || high && !is_rigid;
        ends.then(|| format!("{} of {}", parameter.name, on.effect.id()))
    })
}
