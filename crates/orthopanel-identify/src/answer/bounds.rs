//! Numbers that the data do not tell: that ended on a bound of what is looked for, or stay as they were thought of beforehand.

use orthopanel_model::{Piece, Scale, effect};

use crate::error::spaced;
use crate::hypothesis::Role;
use crate::posterior::Judged;

use super::estimates::Estimates;

/// Part of a range that counts as its end.
const MARGIN: f64 = 1e-3;

/// Variance of a coordinate, one beforehand, from which its number is what is usual, and not what the data say.
const PRIOR_ALONE: f64 = 0.5;

/// A sentence on each number that the test file leaves out of what it declares, and that the data do not tell.
pub(super) fn notes_on_prior_alone(judged: &Judged, estimates: &Estimates) -> Vec<String> {
    let mut notes = Vec::new();
    let precision = judged.hypothesis.precision();
    let mut coordinates = judged.hypothesis.free_constants()..;
    for (found, role) in &estimates.effects {
        for parameter in &found.parameters {
            for value in parameter.values.iter().filter(|value| value.std.is_some()) {
                let at = coordinates.next().unwrap_or_default();
                if *role == Role::Declared && precision[at] > 0.0 && judged.posterior.covariance[(at, at)] > PRIOR_ALONE
                {
                    let (name, unit, id) = (parameter.name, spaced(parameter.unit), found.id);
                    notes.push(format!("{name} = {:.1e}{unit} of {id} is what is usual: {LEFT_OUT}", value.value));
                }
            }
        }
    }
    notes
}

const LEFT_OUT: &str = "the test file declares it without this number, and the data do not tell it: give the number, or leave the effect out";

/// A sentence on each free number at an end of its range: then the bound tells it, not the data. A place at the end of the piece is a place.
pub(super) fn notes_on_bound(estimates: &Estimates, piece: &Piece) -> Vec<String> {
    let mut notes = Vec::new();
    let may_be_said = |role: &Role| matches!(role, Role::Declared | Role::Found);
    for (found, role) in estimates.effects.iter().filter(|(_, role)| may_be_said(role)) {
        let Ok(known) = effect(found.id) else { continue };
        for (parameter, found_of) in known.parameters().iter().zip(&found.parameters) {
            let (low, high) = parameter.range(piece);
            let part = |value: f64| match parameter.scale {
                Scale::Log => (value / low).ln() / (high / low).ln(),
                Scale::Linear | Scale::Index => (value - low) / (high - low),
            };
            let at_end = |value: f64| !(MARGIN..=1.0 - MARGIN).contains(&part(value));
            let free = found_of.values.iter().filter(|value| value.std.is_some() && at_end(value.value));
            if parameter.name == "x" {
                continue;
            }
            let means = if *role == Role::Declared { LEFT_OUT } else { "the name fits, the number is the bound's" };
            notes.extend(free.map(|value| {
                let (name, unit, id) = (parameter.name, spaced(parameter.unit), found.id);
                format!("{name} = {:.1e}{unit} of {id} lies on the bound of what is looked for: {means}", value.value)
            }));
        }
    }
    notes
}
