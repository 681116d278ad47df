//! `sensor-resonance`.

use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// The accelerometer's own resonance: $c = \omega_0^2/(s^2 + 2\zeta\omega_0s + \omega_0^2)$, at the frequency $\omega_0/2\pi$ \[Hz\] with the
/// damping ratio $\zeta$ \[1\].
///
/// Source: the seismic accelerometer below its resonance; ISO 5347-14.
#[derive(Debug, Clone, Copy)]
pub(super) struct SensorResonance;

const PARAMETERS: [EffectParameter; 2] = [
    EffectParameter::log("frequency", "Hz", [100.0, 1e5], &[6e3, 1e4, 2e4]).sized(1.2e4, 1.5),
    EffectParameter::log("zeta", "1", [1e-3, 1.0], &[0.02, 0.1]).sized(0.03, 2.0),
];

impl Effect for SensorResonance {
    fn id(&self) -> &'static str {
        "sensor-resonance"
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[frequency, zeta] = values else { return Ok(vec![]) };
        Ok(vec![Action::Channel(ChannelFactor::Resonance { frequency, zeta })])
    }
}
