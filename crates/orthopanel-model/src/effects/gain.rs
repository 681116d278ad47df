//! `gain`.

use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// One factor \[1\] on all records: a wrong sensitivity of hammer or sensor.
///
/// A rigid line fixes it only where the piece's mass is known. Source: the ratio of two sensitivities.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gain;

/// A sensitivity in a wrong unit may be any power of ten off.
pub(super) const ANY_FACTOR: [f64; 2] = [1e-9, 1e9];

/// A factor beyond is that of a unit, about which is asked before anything is traced.
pub(super) const NO_UNIT: [f64; 2] = [0.05, 20.0];

/// Id of this effect.
pub const GAIN: &str = "gain";

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::log("gain", "1", ANY_FACTOR, &[1.0, 0.9, 1.1]).looked_for_in(NO_UNIT).sized(1.0, 1.12).factor()];

impl Effect for Gain {
    fn id(&self) -> &'static str {
        GAIN
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[gain] = values else { return Ok(vec![]) };
        Ok(vec![Action::Channel(ChannelFactor::Gain { gain })])
    }
}
