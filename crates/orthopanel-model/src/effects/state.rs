//! Effects that are switched on, with the values of their parameters.

use super::{Action, Effect, EffectParameter, EffectSetting};
use crate::ModelError;

/// An effect that is switched on, at some values of its parameters.
#[derive(Clone)]
pub struct EffectState {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// One value a parameter, in order; where a parameter has a value in each record, one a record in its place.
    pub values: Vec<f64>,
    records: usize,
}

impl EffectState {
    /// An effect in a test of so many records. Values that are missing at the end are those at which their parameters are held.
    ///
    /// # Errors
    /// [`ModelError::EffectValues`] for another number of values than the parameters want.
    pub fn new(effect: &'static dyn Effect, mut values: Vec<f64>, records: usize) -> Result<Self, ModelError> {
        let times = |of: &EffectParameter| if of.each_record { records } else { 1 };
        let held: Vec<Option<f64>> =
            effect.parameters().iter().flat_map(|of| std::iter::repeat_n(of.held_at, times(of))).collect();
        let expected = held.len();
        values.extend(held.iter().skip(values.len()).map_while(|held| *held));
        if values.len() != expected {
            return Err(ModelError::EffectValues { effect: effect.id(), found: values.len(), expected });
        }
        Ok(Self { effect, values, records })
    }

    /// Where in the values a parameter of a record stands.
    fn position(&self, parameter: usize, record: usize) -> usize {
        let before = self.effect.parameters().iter().take(parameter);
        let start: usize = before.map(|parameter| if parameter.each_record { self.records } else { 1 }).sum();
        let each = self.effect.parameters().get(parameter).is_some_and(|parameter| parameter.each_record);
        if each { start + record.saturating_sub(1) } else { start }
    }

    /// The values as one record sees them.
    pub(super) fn values_in(&self, record: usize) -> Result<Vec<f64>, ModelError> {
        let at = |parameter: usize| self.values.get(self.position(parameter, record)).copied();
        let expected = self.effect.parameters().len();
        let found: Vec<f64> = (0..expected).map_while(at).collect();
        if found.len() == expected {
            return Ok(found);
        }
        Err(ModelError::EffectValues { effect: self.effect.id(), found: found.len(), expected })
    }

    /// What it does in the record of this setting.
    ///
    /// # Errors
    /// As [`Effect::act`].
    pub fn acting_in(&self, setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.effect.act(&self.values_in(setting.record.number)?, setting)
    }

    /// Refuses an effect off the centre line, which no beam can have.
    ///
    /// # Errors
    /// [`ModelError::EffectText`].
    pub(crate) fn on_centre_line(&self) -> Result<(), ModelError> {
        let off = self.effect.parameters().iter().zip(&self.values).find(|(of, value)| of.across && value.abs() > 0.0);
        off.map_or(Ok(()), |(parameter, value)| {
            let what = format!("{} = {value}: a beam has its effects on its centre line, leave it out", parameter.name);
            Err(ModelError::EffectText { effect: self.effect.id(), what })
        })
    }
}
