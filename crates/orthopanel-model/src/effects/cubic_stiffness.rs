//! `cubic-stiffness`.

use super::suspension::Suspension;
use super::{
    Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Seat, Share, SuspensionMotion,
};
use crate::{ModelError, Place};

/// A suspension that stiffens: force $k_3w^3$ at each suspension point. Under a motion of amplitude $A$ its first
/// harmonic is that of a spring
/// $$k_{eq} = \tfrac34k_3A^2$$
/// (harmonic balance; Nayfeh and Mook, Nonlinear Oscillations (1979), section 2.3). $A$ is the record's own
/// [`SuspensionMotion::Amplitudes`]. Where hits are known, [`SuspensionMotion::InTime`], the force is worked out in time
/// instead, from each hit's own motion, and nothing is added here.
///
/// Limits of the harmonic balance: one amplitude stands for a motion of several modes that decays; further harmonics are left
/// out. It holds while $k_{eq}$ stays small beside the stiffness that the point sees, so start from the softest hit.
#[derive(Debug, Clone, Copy)]
pub(super) struct CubicStiffness;

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::log("k3", "N/m3", [1e6, 1e18], &[1e10, 1e9, 1e11, 1e13]).sized(1e10, 4.0)];

impl Effect for CubicStiffness {
    fn id(&self) -> &'static str {
        "cubic-stiffness"
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
        let &[k3] = values else { return Ok(vec![]) };
        let at = setting.suspension_for(self.id())?;
        let known = match &setting.record.suspension_motion {
            SuspensionMotion::InTime => return Ok(vec![]),
            SuspensionMotion::Amplitudes(known) if known.len() == at.len() => Some(known),
            _ => None,
        };
        let what =
            "the hits themselves (kind = \"time-history\"): a force that is not linear depends on their strength";
        let amplitudes = known.ok_or(ModelError::EffectNeeds { effect: self.id(), what })?;
        let spring = |(&place, amplitude): (&Place, &f64)| {
            let factor = 0.75 * amplitude * amplitude;
            let law = ElementLaw::Spring { stiffness: factor * k3, damping: 0.0 };
            let shares = vec![Share { number: 0, parameter: 0, factor }];
            Action::Element(PointElement { shares, ..PointElement::on_deflection(law, Seat::At(place)) })
        };
        Ok(at.iter().zip(amplitudes).map(spring).collect())
    }
}
