//! `exponential-window`.

use super::{Action, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// The analyser multiplied the response by $e^{-t/\tau}$, and the file does not say so.
///
/// The transform of the windowed response is $Y(s+1/\tau)$, so with $Y = H F$ what the record holds is
/// $$\frac{H(s+1/\tau)\,F(s+1/\tau)}{F(s)} \approx e^{-t_0/\tau}\,H(s+1/\tau)$$
/// for a pulse at $t_0$ ([`RecordSetting::hit_time`](super::RecordSetting::hit_time)) that is short beside $\tau$; the next
/// term is of the size (pulse's width over $\tau$)². It holds on any line $s = \sigma + j\omega$, since a further known
/// window only adds its own $\sigma$. Every mode loses $1/\tau$ of decay rate alike, which damping ratios do not.
///
/// Source: modulation theorem of the Laplace transform.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExponentialWindow;

/// Id of this effect.
pub const EXPONENTIAL_WINDOW: &str = "exponential-window";

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::log("tau", "s", [1e-3, 100.0], &[0.3, 0.1, 1.0]).sized(0.5, 2.5)];

impl Effect for ExponentialWindow {
    fn id(&self) -> &'static str {
        EXPONENTIAL_WINDOW
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[tau] = values else { return Ok(vec![]) };
        Ok(vec![Action::Window { tau }])
    }
}
