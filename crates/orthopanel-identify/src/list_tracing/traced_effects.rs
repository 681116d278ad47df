//! The effects of a hypothesis as they are told.

use orthopanel_model::Estimate;

use super::hypothesis::{Hypothesis, Switched};
use crate::outcome::{TracedEffect, TracedParameter};

/// All effects of a hypothesis; `std` are those of its coordinates.
pub(super) fn effects_of(hypothesis: &Hypothesis, std: &[Option<f64>]) -> Vec<TracedEffect> {
    let mut rest = std;
    let mut effects = Vec::new();
    for on in &hypothesis.effects {
        let (own, later) = rest.split_at(on.free.len().min(rest.len()));
        rest = later;
        effects.push(TracedEffect { id: on.effect.id(), owner: on.effect.owner(), parameters: parameters(on, own) });
    }
    effects
}

fn parameters(on: &Switched, std: &[Option<f64>]) -> Vec<TracedParameter> {
    let estimate = |(at, &value): (usize, &f64)| {
        let free = on.free.iter().position(|free| free.at == at);
        let std = free.and_then(|i| Some(std.get(i).copied().flatten()? * on.free[i].slope(value)));
        Estimate { value, std }
    };
    let estimates = on.values.iter().enumerate().map(estimate);
    let known = on.effect.parameters().iter().zip(estimates);
    known.map(|(of, value)| TracedParameter { name: of.name, unit: of.unit, values: vec![value] }).collect()
}
