//! `high-pass`.

use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// A filter of first order in the response channel, as of AC coupling or a charge amplifier: $c = s/(s+\omega_c)$, with the
/// corner $\omega_c/2\pi$ \[Hz\].
///
/// Source: the RC network.
#[derive(Debug, Clone, Copy)]
pub(super) struct HighPass;

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::log("corner", "Hz", [1e-2, 1e3], &[5.0, 0.5, 30.0]).sized(5.0, 2.3)];

impl Effect for HighPass {
    fn id(&self) -> &'static str {
        "high-pass"
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[corner] = values else { return Ok(vec![]) };
        Ok(vec![Action::Channel(ChannelFactor::HighPass { corner })])
    }
}
