//! `channel-delay`.

use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// The response is sampled late by $T$ \[s\], early where negative: $c = e^{-sT}$.
///
/// Source: shift theorem of the Laplace transform.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChannelDelay;

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::linear("delay", "s", [-5e-3, 5e-3], &[1e-5, -1e-5, 1e-4]).signed(1.5e-5, 2.5)];

impl Effect for ChannelDelay {
    fn id(&self) -> &'static str {
        "channel-delay"
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[delay] = values else { return Ok(vec![]) };
        Ok(vec![Action::Channel(ChannelFactor::Delay { delay })])
    }
}
