//! `size-error`.

use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, Owner, Shift};
use crate::{ModelError, Place};

/// The piece is longer, and on a plate wider, than the file says: by these parts \[1\] of what it says, negative where it is shorter.
///
/// A plate of length $a(1+e)$ and width $b(1+e')$ whose mass per area is as stated vibrates as one of $a$ and $b$ with other constants
/// ($E_x/(1+e)^4$, ..., but for rotary inertia, which errs by $2e$ of its part). So what shows beside constants is where hammer and sensor stand on it,
/// $x/(1+e)$ and $y/(1+e')$, and that all shapes are smaller, for $\mu\int W^2dx\,dy = 1$: the accelerance by $1/\left((1+e)(1+e')\right)$.
///
/// Limits: constants that are held, and the places of what stands on the panel, do not go with it. Prior: a tape measure, 0.3 %. Source: similarity
/// of eqs 2 to 5.
#[derive(Debug, Clone, Copy)]
pub(super) struct SizeError;

const LENGTH: EffectParameter =
    EffectParameter::linear("length", "1", [-0.05, 0.05], &[0.005, -0.005]).about(0.0, 3e-3);

const PARAMETERS: [EffectParameter; 2] = [LENGTH, LENGTH.across("width")];

impl Effect for SizeError {
    fn id(&self) -> &'static str {
        "size-error"
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[length, width] = values else { return Ok(vec![]) };
        // A place at an edge stays on the piece.
        let moved = |at: f64, by: f64, side: f64| (at / (1.0 + by)).clamp(-0.5 * side, 0.5 * side) - at;
        let shift = |of_response: bool, at: Option<Place>| {
            let Place { x, y } = at?;
            let offset = [moved(x, length, setting.piece.length), moved(y, width, setting.piece.width)];
            Some(Action::Place(Shift { of_response, offset }))
        };
        let smaller = ChannelFactor::Gain { gain: 1.0 / ((1.0 + length) * (1.0 + width)) };
        let record = &setting.record;
        let places = [shift(false, record.force_at), shift(true, record.response_at)].into_iter().flatten();
        Ok(places.chain([Action::Channel(smaller)]).collect())
    }
}
