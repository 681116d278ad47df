//! `cubic-stiffness`.

use super::suspension::Suspension;
use super::{Action, Effect, EffectParameter, EffectSetting, Owner, SuspensionMotion};
use crate::ModelError;

/// A suspension that stiffens: force $k_3w^3$ at each suspension point. It is worked out in time, from each hit's own motion
/// ([`cubic_support_forces`](crate::cubic_support_forces)), so where hits are known, [`SuspensionMotion::InTime`], nothing is added
/// here.
#[derive(Debug, Clone, Copy)]
pub(super) struct CubicStiffness;

/// Id of this effect.
pub const CUBIC_STIFFNESS: &str = "cubic-stiffness";

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::log("k3", "N/m3", [1e6, 1e18], &[1e10, 1e9, 1e11, 1e13]).sized(1e10, 4.0)];

impl Effect for CubicStiffness {
    fn id(&self) -> &'static str {
        CUBIC_STIFFNESS
    }

    fn owner(&self) -> Owner {
        Owner::Rig
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn linearised(&self) -> Option<&'static dyn Effect> {
        Some(&Suspension)
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        setting.suspension_for(self.id())?;
        let what =
            "the hits themselves (kind = \"time-history\"): a force that is not linear depends on their strength";
        match setting.record.suspension_motion {
            SuspensionMotion::InTime => Ok(vec![]),
            SuspensionMotion::Unknown => Err(ModelError::EffectNeeds { effect: self.id(), what }),
        }
    }
}
