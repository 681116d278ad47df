//! `rotary-inertia`.

use super::{Action, Effect, EffectParameter, EffectSetting, FieldTerm, Owner};
use crate::{ModelError, Piece};

/// Factor \[1\] on the rotary inertia $\rho t\,b\,t^2/12$ of evenly spread mass. Faces carry most of a sandwich's mass:
/// 2.4 for faces of 1 mm and a light core; at most 3, all mass in the skins.
///
/// Source: $\int\rho z^2dz$ over the section, in place of eq. 5's $\rho I$.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotaryInertia;

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::linear("factor", "1", [0.05, 4.0], &[1.5, 2.4, 1.0]).sized(2.0, 1.5).factor()];

impl Effect for RotaryInertia {
    fn id(&self) -> &'static str {
        "rotary-inertia"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    /// With the thickness $t'=t\sqrt r$ bending has $E t'^3$ and shear $G t'$: the constants that were found are $r^{3/2}$ and $r^{1/2}$ times those.
    fn looks_like(&self, values: &[f64], piece: &Piece) -> Option<String> {
        let &[factor] = values else { return None };
        Some(format!(
            "a thickness of {:.3e} m in place of {} m would show the same as {:.3} times the rotary inertia: the moduli in the plane would then be {:.3} \
             times those found, and those of shear through the thickness {:.3} times",
            piece.thickness * factor.sqrt(),
            piece.thickness,
            factor,
            factor.powf(-1.5),
            factor.powf(-0.5)
        ))
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[factor] = values else { return Ok(vec![]) };
        Ok(vec![Action::Field(FieldTerm::RotaryFactor(factor))])
    }
}
