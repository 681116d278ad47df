//! Effects that are switched on, and which of their parameters a search moves.

use std::collections::BTreeMap;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Effect, EffectState, ModelError, Piece, Scale};

use crate::IdentifyError;
use crate::declared_effects::{Declared, declared, first_setting};
pub(super) use crate::hypothesis::{has_place, is_place};

/// The plate in place of the beam.
pub(super) const PLATE: &str = "width-coupling";
/// Suspension springs that are not linear.
pub(super) const CUBIC: &str = "cubic-stiffness";
/// What has a mode of its own.
pub(super) const RESONATOR: &str = "resonator";
/// A window that was left on, of which the first number is its time constant.
pub(super) const WINDOW: &str = "exponential-window";

/// An effect with values for all its parameters.
#[derive(Clone)]
pub(super) struct Switched {
    pub effect: &'static dyn Effect,
    /// One a parameter; where each record has its own, one a record in its place.
    pub values: Vec<f64>,
    /// Those that a search moves.
    pub free: Vec<FreeParameter>,
}

/// A parameter that a search moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FreeParameter {
    /// Position in [`Switched::values`].
    pub at: usize,
    /// Position in the effect's parameters.
    pub parameter: usize,
    /// The record it belongs to, where each has its own.
    pub record: Option<usize>,
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

/// Down to this part of its start a parameter is looked for that is zero unless it pays.
const BELOW_ITS_START: f64 = 1e-2;
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
        records: usize,
        start: impl Fn(&str) -> Option<f64>,
        fixed: impl Fn(&str) -> bool,
    ) -> Self {
        let mut switched = Self { effect, values: vec![], free: vec![] };
        for (index, parameter) in effect.parameters().iter().enumerate() {
            let range = parameter.range_looked_for(piece);
            let usual = || parameter.held_at.or_else(|| parameter.starts(piece).first().copied()).unwrap_or(0.0);
            let value = start(parameter.name).unwrap_or_else(usual).clamp(range.0, range.1);
            let held = fixed(parameter.name) || parameter.held_at.is_some() || parameter.scale == Scale::Index;
            let copies = if parameter.each_record { records } else { 1 };
            for copy in 0..copies {
                if !held {
                    let at = switched.values.len();
                    let record = parameter.each_record.then_some(copy);
                    let scale = parameter.scale;
                    switched.free.push(FreeParameter { at, parameter: index, record, scale, range });
                }
                switched.values.push(value);
            }
        }
        switched
    }

    /// The same as declared: at any value that the effect may have.
    fn wherever(mut self, piece: &Piece, told: impl Fn(&str) -> Option<f64>) -> Self {
        let parameters = self.effect.parameters();
        for free in &mut self.free {
            free.range = parameters[free.parameter].range(piece);
        }
        if self.values.len() == parameters.len() {
            let told = parameters.iter().map(|parameter| told(parameter.name));
            self.values.iter_mut().zip(told).for_each(|(value, told)| *value = told.unwrap_or(*value));
        }
        self
    }

    /// Frees, from where they start, the parameters that the catalogue keeps at zero unless they pay; whether there are any.
    pub(super) fn free_what_is_kept(&mut self, piece: &Piece) -> bool {
        let before = self.free.len();
        for (index, parameter) in self.effect.parameters().iter().enumerate() {
            let is_free = self.free.iter().any(|free| free.parameter == index);
            // Values stand one a parameter only where no record has its own.
            if parameter.held_at.is_none() || is_free || self.values.len() != self.effect.parameters().len() {
                continue;
            }
            let Some(&start) = parameter.starts(piece).first() else { continue };
            // Where it does not show it goes down through the decades, and does not pay.
            let range = (BELOW_ITS_START * start, parameter.range(piece).1);
            self.values[index] = start;
            self.free.push(FreeParameter { at: index, parameter: index, record: None, scale: Scale::Log, range });
        }
        self.free.sort_by_key(|free| free.at);
        self.free.len() > before
    }

    /// How many parameters the effect has but for those that it keeps unless asked.
    pub(super) fn held_or_free(&self) -> usize {
        self.effect.parameters().iter().filter(|parameter| parameter.held_at.is_none()).count()
    }

    /// What the model takes.
    pub(super) fn state(&self, records: usize) -> Result<EffectState, ModelError> {
        EffectState::new(self.effect, self.values.clone(), records)
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

    /// The ids, joined; the base's is empty.
    pub(super) fn name(&self) -> String {
        self.effects.iter().map(|switched| switched.effect.id()).collect::<Vec<_>>().join(" + ")
    }

    /// The ids of the effects beyond the first `declared`, which the test file declares.
    pub(super) fn name_beyond(&self, declared: usize) -> String {
        let ids: Vec<&str> = self.effects.iter().skip(declared).map(|on| on.effect.id()).collect();
        if ids.is_empty() { "base".to_owned() } else { ids.join(" + ") }
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
    /// As [`declared`].
    pub(super) fn declared(test: &ImpactTest, piece: &Piece, records: usize) -> Result<Self, IdentifyError> {
        let switched = |Declared { effect, values }: Declared| {
            let names = effect.parameters().iter().map(|parameter| parameter.name);
            let told: BTreeMap<&str, f64> =
                names.zip(values).filter_map(|(name, value)| Some((name, value?))).collect();
            let value = |name: &str| told.get(name).copied();
            Switched::new(effect, piece, records, value, |name| told.contains_key(name)).wherever(piece, value)
        };
        Ok(Self { effects: declared(test, piece, records)?.into_iter().map(switched).collect() })
    }

    /// Whether each effect can act in this test at all, as where its clamp is: a search would pass over starts that fail.
    ///
    /// # Errors
    /// [`ModelError::EffectNeeds`] with what the test lacks, and what an effect refuses of its numbers.
    pub(super) fn check_that_each_acts(&self, test: &ImpactTest, piece: &Piece) -> Result<(), IdentifyError> {
        let setting = first_setting(test, piece);
        for on in &self.effects {
            // With a value in each record these are no values of one.
            if on.values.len() == on.effect.parameters().len() {
                on.effect.act(&on.values, &setting)?;
            }
        }
        Ok(())
    }

    /// Whether an effect is on and cannot be there once more.
    pub(super) fn holds(&self, effect: &dyn Effect) -> bool {
        !has_place(effect) && self.effects.iter().any(|on| on.effect.id() == effect.id())
    }

    /// Whether the effect that came last sits at a place of its own.
    pub(super) fn ends_with_a_place(&self) -> bool {
        self.effects.last().is_some_and(|on| has_place(on.effect))
    }

    /// Where along the piece the effect that came last sits.
    pub(super) fn last_place(&self) -> Option<f64> {
        let on = self.effects.last()?;
        let place = on.effect.parameters().iter().position(is_place)?;
        on.values.get(place).copied()
    }

    /// Whether a plate stands in place of the beam.
    pub(super) fn holds_plate(&self) -> bool {
        self.effects.iter().any(|on| on.effect.id() == PLATE)
    }

    /// Every free parameter with its effect.
    pub(super) fn each_free(&self) -> impl Iterator<Item = (&Switched, &FreeParameter)> {
        self.effects.iter().flat_map(|switched| switched.free.iter().map(move |free| (switched, free)))
    }

    pub(super) fn states(&self, records: usize) -> Result<Vec<EffectState>, ModelError> {
        self.effects.iter().map(|switched| switched.state(records)).collect()
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
