//! `suspension`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Seat};
use crate::ModelError;

/// A spring $k$ \[N/m\] and a dashpot $c$ \[N s/m\] to the ground at every suspension point: $Z = k + cs$.
///
/// Source: the paper's test pieces hang on threads (section 4); a soft rest adds $k$ and $c$ where it touches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Suspension;

const PARAMETERS: [EffectParameter; 2] = [
    EffectParameter::log("stiffness", "N/m", [1.0, 1e7], &[1e3, 1e4, 1e5]).sized(3e3, 3.0),
    EffectParameter::log("damping", "N s/m", [1e-3, 1e3], &[1.0, 0.1]).sized(3.0, 3.0),
];

impl Effect for Suspension {
    fn id(&self) -> &'static str {
        "suspension"
    }

    fn owner(&self) -> Owner {
        Owner::Rig
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[stiffness, damping] = values else { return Ok(vec![]) };
        let law = ElementLaw::Spring { stiffness, damping };
        let at = setting.suspension_for(self.id())?;
        Ok(at.iter().map(|&place| Action::Element(PointElement::on_deflection(law, Seat::At(place)))).collect())
    }
}
