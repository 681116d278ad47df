//! The constants and the effects of a hypothesis, with their standard deviations.

use orthopanel_model::Estimate;

use crate::hypothesis::Role;
use crate::posterior::Judged;
use crate::traced_effect::{TracedEffect, TracedParameter};

/// What a hypothesis says.
pub(super) struct Estimates {
    /// Of the structure, in its order.
    pub constants: Vec<Estimate>,
    /// All effects, and why each is there.
    pub effects: Vec<(TracedEffect, Role)>,
}

impl Estimates {
    pub(super) fn of(Judged { hypothesis, posterior, .. }: &Judged) -> Self {
        let values = hypothesis.values_with_deviations(&posterior.point.z, &posterior.covariance);
        let mut values = values.into_iter().map(|(value, std)| Estimate { value, std });
        let constants = values.by_ref().take(hypothesis.constant_numbers().count()).collect();
        let effects = hypothesis.parts.iter().map(|part| {
            let mut parameters: Vec<TracedParameter> = Vec::new();
            for (parameter, value) in part.parameters().zip(values.by_ref()) {
                // On the centre line, or across the whole width.
                if parameter.across && value.std.is_none() && (value.value == 0.0 || value.value.is_nan()) {
                    continue;
                }
                match parameters.last_mut() {
                    // A value more of a parameter that each record has of its own.
                    Some(last) if last.name == parameter.name => last.values.push(value),
                    _ => {
                        let (name, unit) = (parameter.name, parameter.unit);
                        parameters.push(TracedParameter { name, unit, values: vec![value] });
                    }
                }
            }
            let (id, owner) = (part.effect.id(), part.effect.owner());
            (TracedEffect { id, owner, parameters }, part.role)
        });
        Self { constants, effects: effects.collect() }
    }

    /// The effects of panel, rig and measuring chain.
    pub(super) fn of_test(self) -> Vec<TracedEffect> {
        self.effects.into_iter().filter(|(_, role)| *role != Role::Nuisance).map(|(effect, _)| effect).collect()
    }

    /// The effects that the base lacks.
    pub(super) fn undeclared(self) -> Vec<TracedEffect> {
        self.effects.into_iter().filter(|(_, role)| *role == Role::Found).map(|(effect, _)| effect).collect()
    }
}

/// The ids of the undeclared effects of a hypothesis joined by ` + `; `base` for none.
pub(super) fn id(judged: &Judged) -> String {
    let names = judged.names();
    if names.is_empty() { "base".to_owned() } else { names.join(" + ") }
}
