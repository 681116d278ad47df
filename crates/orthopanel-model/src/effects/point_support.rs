//! `point-support`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Seat};
use crate::{ModelError, Place};

/// A spring $k$ \[N/m\] to the ground at $x$ on the centre line, where nobody wrote down that the piece touches something: $Z = k$.
///
/// Limits: no dashpot, as damping ratios are free. Source: Hooke's law.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointSupport;

const PARAMETERS: [EffectParameter; 2] =
    [EffectParameter::log("stiffness", "N/m", [1.0, 1e9], &[1e4, 1e5, 1e6]).sized(3e4, 5.0), EffectParameter::place()];

impl Effect for PointSupport {
    fn id(&self) -> &'static str {
        "point-support"
    }

    fn owner(&self) -> Owner {
        Owner::Rig
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[stiffness, x] = values else { return Ok(vec![]) };
        let spring = ElementLaw::Spring { stiffness, damping: 0.0 };
        Ok(vec![Action::Element(PointElement::on_deflection(spring, Seat::At(Place { x, y: 0.0 })))])
    }
}
