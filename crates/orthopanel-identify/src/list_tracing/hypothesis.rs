//! Effects that are switched on, and which of their parameters a search moves.

use std::collections::BTreeMap;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Effect, EffectState, ModelError, Piece, Scale};

use crate::IdentifyError;
use crate::declared_effects::{Declared, declared};
pub(super) use crate::hypothesis::{has_place, is_place};

/// The plate in place of the beam.
pub(super) const PLATE: &str = "width-coupling";
/// What has a mode of its own.
pub(super) const RESONATOR: &str = "resonator";
/// An effect with values for all its parameters.
#[derive(Clone)]
pub(super) struct Switched {
    pub effect: &'static dyn Effect,
    /// One a parameter: a list has no records that could differ.
    pub values: Vec<f64>,
    /// Those that a search moves.
    pub free: Vec<FreeParameter>,
}

/// A parameter that a search moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FreeParameter {
    /// Position in the effect's parameters.
    pub at: usize,
    scale: Scale,
    pub range: (f64, f64),
}

impl FreeParameter {
    /// From a value to what the search moves: its logarithm where it spans decades.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        if self.scale == Scale::Log { value.ln() } else { value }
    }

    /// From what the search moves to the value.
    pub(super) fn value(&self, coordinate: f64) -> f64 {
        let value = if self.scale == Scale::Log { coordinate.exp() } else { coordinate };
        // exp(ln x) may pass a bound by rounding.
        value.clamp(self.range.0, self.range.1)
    }

    /// Derivative of the value by the coordinate.
    pub(super) fn slope(&self, value: f64) -> f64 {
        if self.scale == Scale::Log { value } else { 1.0 }
    }

    /// Bounds of the coordinate.
    pub(super) fn bounds(&self) -> (f64, f64) {
        (self.coordinate(self.range.0), self.coordinate(self.range.1))
    }

    /// Whether a value lies on a bound, to a part in a thousand of the range that the search moves through.
    pub(super) fn on_bound(&self, value: f64) -> bool {
        ends_of_range(self.scale, self.range, value).contains(&true)
    }
}

/// Part of a range that counts as its end.
const MARGIN: f64 = 1e-3;

/// Whether a value lies at the low and at the high end of a range, in the coordinate that a search moves.
pub(super) fn ends_of_range(scale: Scale, (low, high): (f64, f64), value: f64) -> [bool; 2] {
    let part = if scale == Scale::Log { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) };
    [part < MARGIN, part > 1.0 - MARGIN]
}

impl Switched {
    /// An effect at some values, `fixed` ones by their parameter's name; the others are free unless the catalogue keeps
    /// them.
    pub(super) fn new(
        effect: &'static dyn Effect,
        piece: &Piece,
        start: impl Fn(&str) -> Option<f64>,
        fixed: impl Fn(&str) -> bool,
    ) -> Self {
        let mut switched = Self { effect, values: vec![], free: vec![] };
        for (at, parameter) in effect.parameters().iter().enumerate() {
            let range = parameter.range_looked_for(piece);
            let usual = || parameter.held_at.or_else(|| parameter.starts(piece).first().copied()).unwrap_or(0.0);
            let value = start(parameter.name).unwrap_or_else(usual).clamp(range.0, range.1);
            let held = fixed(parameter.name) || parameter.held_at.is_some() || parameter.scale == Scale::Index;
            if !held {
                switched.free.push(FreeParameter { at, scale: parameter.scale, range });
            }
            switched.values.push(value);
        }
        switched
    }

    /// The same as declared: at any value that the effect may have.
    fn wherever(mut self, piece: &Piece, told: impl Fn(&str) -> Option<f64>) -> Self {
        let parameters = self.effect.parameters();
        for free in &mut self.free {
            free.range = parameters[free.at].range(piece);
        }
        let told = parameters.iter().map(|parameter| told(parameter.name));
        self.values.iter_mut().zip(told).for_each(|(value, told)| *value = told.unwrap_or(*value));
        self
    }

    /// How many parameters the effect has but for those that it keeps unless asked.
    pub(super) fn held_or_free(&self) -> usize {
        self.effect.parameters().iter().filter(|parameter| parameter.held_at.is_none()).count()
    }

    /// What the model takes.
    fn state(&self) -> Result<EffectState, ModelError> {
        EffectState::new(self.effect, self.values.clone(), 1)
    }
}

/// All effects that are switched on.
#[derive(Clone, Default)]
pub(super) struct Hypothesis {
    pub effects: Vec<Switched>,
}

impl Hypothesis {
    /// Modes that resonators bring.
    pub(super) fn own_modes(&self) -> usize {
        self.effects.iter().filter(|on| on.effect.id() == RESONATOR).count()
    }

    /// With one more effect.
    pub(super) fn and(&self, switched: Switched) -> Self {
        let mut more = self.clone();
        more.effects.push(switched);
        more
    }

    /// Number of free parameters.
    pub(super) fn size(&self) -> usize {
        self.effects.iter().map(|switched| switched.free.len()).sum()
    }

    /// What a search moves, effect by effect.
    pub(super) fn coordinates(&self) -> Vec<f64> {
        self.each_free().map(|(switched, free)| free.coordinate(switched.values[free.at])).collect()
    }

    /// Bounds of the same.
    pub(super) fn bounds(&self) -> Vec<(f64, f64)> {
        self.each_free().map(|(_, free)| free.bounds()).collect()
    }

    /// The same effects at other coordinates.
    pub(super) fn at(&self, coordinates: &[f64]) -> Self {
        let mut moved = self.clone();
        let mut coordinates = coordinates.iter();
        for switched in &mut moved.effects {
            for free in &switched.free {
                if let Some(&coordinate) = coordinates.next() {
                    switched.values[free.at] = free.value(coordinate);
                }
            }
        }
        moved
    }

    /// Leaves parameters that lie on a bound there: whether there were any.
    pub(super) fn rest_on_bounds(&mut self) -> bool {
        let before = self.size();
        for on in &mut self.effects {
            let values = &on.values;
            on.free.retain(|free| !free.on_bound(values[free.at]));
        }
        self.size() < before
    }

    /// The effects that a test file declares: what it tells of them is held, the rest is free.
    ///
    /// # Errors
    /// As [`declared`], and [`IdentifyError::Unsupported`] for a test without a piece.
    pub(super) fn declared(test: &ImpactTest) -> Result<Self, IdentifyError> {
        let largest = test.pieces.iter().map(|named| &named.piece).max_by(|a, b| a.mass().total_cmp(&b.mass()));
        let piece = largest.ok_or_else(|| IdentifyError::Unsupported("a test without a piece".to_owned()))?;
        let switched = |Declared { effect, values }: Declared| {
            let names = effect.parameters().iter().map(|parameter| parameter.name);
            let told: BTreeMap<&str, f64> =
                names.zip(values).filter_map(|(name, value)| Some((name, value?))).collect();
            let value = |name: &str| told.get(name).copied();
            Switched::new(effect, piece, value, |name| told.contains_key(name)).wherever(piece, value)
        };
        Ok(Self { effects: declared(test, piece, 1)?.into_iter().map(switched).collect() })
    }

    /// Whether an effect is on and cannot be there once more.
    pub(super) fn holds(&self, effect: &dyn Effect) -> bool {
        !has_place(effect) && self.effects.iter().any(|on| on.effect.id() == effect.id())
    }

    /// Every free parameter with its effect.
    pub(super) fn each_free(&self) -> impl Iterator<Item = (&Switched, &FreeParameter)> {
        self.effects.iter().flat_map(|switched| switched.free.iter().map(move |free| (switched, free)))
    }

    pub(super) fn states(&self) -> Result<Vec<EffectState>, ModelError> {
        self.effects.iter().map(Switched::state).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thousandth of the range is the end: of three decades that is 0.7 %, of a linear range a thousandth of its width.
    #[test]
    fn ends_are_those_of_what_a_search_moves() {
        let range = (1.0, 1e3);
        for (scale, value, ends) in [
            (Scale::Log, 1.006, [true, false]),
            (Scale::Log, 1.008, [false, false]),
            (Scale::Log, 995.0, [false, true]),
            (Scale::Linear, 1.008, [true, false]),
            (Scale::Linear, 995.0, [false, false]),
            (Scale::Linear, 999.5, [false, true]),
        ] {
            assert_eq!(ends_of_range(scale, range, value), ends, "{scale:?} {value}");
        }
    }
}
