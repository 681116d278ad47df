//! Parameters that ended on a bound: then their value is the bound's, not the data's.

use super::list_fit::ListFit;
use crate::tracing::hypothesis::{Switched, is_place};

/// Part of a range that counts as its end.
const MARGIN: f64 = 1e-3;

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
        let (low, high) = parameter.range(piece);
        let part = if parameter.scale == orthopanel_model::Scale::Log {
            (value / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        };
        let ends = part < MARGIN || part > 1.0 - MARGIN && !is_rigid;
        ends.then(|| format!("{} of {}", parameter.name, on.effect.id()))
    })
}
