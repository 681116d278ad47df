//! `hammer-offset`.

use super::{Action, Effect, EffectParameter, EffectSetting, Owner, Reference, Shift};
use crate::ModelError;

/// The hammer struck beside the place that is written down: an offset \[m\] along x, one in each record, and on a plate one along y.
///
/// Bounds: a tenth of the piece. Source: geometry; the force's shape row moves with its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct HammerOffset;

const ALONG: EffectParameter =
    EffectParameter::linear("offset", "m", [-0.1, 0.1], &[0.0]).about(0.0, 6e-3).of(Reference::Length).in_each_record();

const PARAMETERS: [EffectParameter; 2] = [ALONG, ALONG.across("offset_y").of(Reference::Width)];

impl Effect for HammerOffset {
    fn id(&self) -> &'static str {
        "hammer-offset"
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
        Ok(vec![Action::Place(Shift { of_response: false, offset: [x, y] })])
    }
}
