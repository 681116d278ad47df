//! `cubic-stiffness`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Seat, Share};
use crate::{ModelError, Place};

/// A suspension that stiffens: force $k_3w^3$ at each suspension point. Under a motion of amplitude $A$ its first
/// harmonic is that of a spring
/// $$k_{eq} = \tfrac34k_3A^2$$
/// (harmonic balance; Nayfeh and Mook, Nonlinear Oscillations (1979), section 2.3). $A$ is
/// [`RecordSetting::suspension_amplitudes`](super::RecordSetting::suspension_amplitudes), the record's own.
///
/// Limits: one amplitude stands for a motion of several modes that decays; further harmonics are left out. It holds
/// while $k_{eq}$ stays small beside the stiffness that the point sees, so start from the softest hit.
#[derive(Debug, Clone, Copy)]
pub(super) struct CubicStiffness;

const PARAMETERS: [EffectParameter; 1] = [EffectParameter::log("k3", "N/m3", [1e6, 1e18], &[1e12, 1e10, 1e14])];

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

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[k3] = values else { return Ok(vec![]) };
        let at = setting.suspension_for(self.id())?;
        let amplitudes = &setting.record.suspension_amplitudes;
        if amplitudes.len() != at.len() {
            let what =
                "the amplitude of each suspension point in each record, which this version does not work out from hits";
            return Err(ModelError::EffectNeeds { effect: self.id(), what });
        }
        let spring = |(&place, amplitude): (&Place, &f64)| {
            let factor = 0.75 * amplitude * amplitude;
            let law = ElementLaw::Spring { stiffness: factor * k3, damping: 0.0 };
            let shares = vec![Share { number: 0, parameter: 0, factor }];
            Action::Element(PointElement { shares, ..PointElement::on_deflection(law, Seat::At(place)) })
        };
        Ok(at.iter().zip(amplitudes).map(spring).collect())
    }
}
