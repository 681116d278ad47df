//! `record-gain`.

use super::gain::{ANY_FACTOR, NO_UNIT};
use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// A factor \[1\] on one record, `record` being its number from 1: an oblique hit, a loose sensor.
///
/// Source: the ratio of two sensitivities.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordGain;

/// Id of this effect.
pub const RECORD_GAIN: &str = "record-gain";

const PARAMETERS: [EffectParameter; 2] = [
    EffectParameter::log("gain", "1", ANY_FACTOR, &[0.9, 1.1]).looked_for_in(NO_UNIT).sized(1.0, 1.14).factor(),
    EffectParameter::record(),
];

impl Effect for RecordGain {
    fn id(&self) -> &'static str {
        RECORD_GAIN
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[gain, record] = values else { return Ok(vec![]) };
        if record.round() != setting.record.number as f64 {
            return Ok(vec![]);
        }
        Ok(vec![Action::Channel(ChannelFactor::Gain { gain })])
    }
}
