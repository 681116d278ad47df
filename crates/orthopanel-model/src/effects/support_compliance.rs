//! `support-compliance`.

use super::{Action, Effect, EffectParameter, EffectSetting, FieldTerm, Owner};
use crate::{Boundary, End, ModelError, Support};

/// Clamped ends that yield: a spring against rotation \[N m/rad\] and one against translation \[N/m\] at each of them.
/// Infinite springs are the ideal clamp. On a plate the springs lie along all clamped edges, so many to a metre that an edge as long as the
/// plate is wide has these in all, and both rotations have the one spring.
///
/// Of a cantilever, a clamp's rotation and a mass at the tip shift all frequencies alike where
/// $m/(\rho A) = EI/k$: frequencies alone cannot tell them. Source: elastically restrained beams, Blevins, Formulas
/// for Natural Frequency and Mode Shape (1979), section 8.2.
#[derive(Debug, Clone, Copy)]
pub(super) struct SupportCompliance;

const PARAMETERS: [EffectParameter; 2] = [
    EffectParameter::log("rotation", "N m/rad", [1.0, 1e12], &[1e3, 1e4, 1e5, 1e2]).sized(3e4, 10.0),
    EffectParameter::log("translation", "N/m", [1e2, 1e15], &[1e6, 1e8, 1e10]).sized(1e8, 30.0),
];

impl Effect for SupportCompliance {
    fn id(&self) -> &'static str {
        "support-compliance"
    }

    fn owner(&self) -> Owner {
        Owner::Rig
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[rotation, translation] = values else { return Ok(vec![]) };
        let Boundary { left, right, front, back } = setting.boundary;
        if ![left, right, front, back].contains(&End::Clamped) {
            return Err(ModelError::EffectNeeds { effect: self.id(), what: "an edge that is clamped ([boundary])" });
        }
        Ok(vec![Action::Field(FieldTerm::Support(Support { translation, rotation }))])
    }
}
