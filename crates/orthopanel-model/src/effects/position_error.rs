//! `position-error`.

use super::{Action, Effect, EffectParameter, EffectSetting, Owner, Reference, Shift};
use crate::ModelError;

/// The sensor sits beside the place that is written down: an offset \[m\] along x, and on a plate along y, the same in every
/// record. What the sensor carries (`sensor-mass`) moves with it.
///
/// Bounds: a tenth of the piece. Source: geometry; the response's shape row moves with its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct PositionError;

const ALONG: EffectParameter =
    EffectParameter::linear("offset", "m", [-0.1, 0.1], &[0.005, -0.005]).about(0.0, 1e-2).of(Reference::Length);

const PARAMETERS: [EffectParameter; 2] = [ALONG, ALONG.across("offset_y").of(Reference::Width)];

impl Effect for PositionError {
    fn id(&self) -> &'static str {
        "position-error"
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[x, y] = values else { return Ok(vec![]) };
        Ok(vec![Action::Place(Shift { of_response: true, offset: [x, y] })])
    }
}
