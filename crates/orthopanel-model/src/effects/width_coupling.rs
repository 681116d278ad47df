//! `width-coupling`.

use super::{Action, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// The orthotropic plate in place of the beam, where width lets modes bend across or twist. Its further constants as
/// ratios: $E_y/E_x$, $\nu_{xy}$, $G_{xy}/E_x$, $G_{yz}/G_{zx}$; they start at what isotropic faces give, and a core that is
/// as stiff across as along, or less, as honeycomb is across its ribbons.
///
/// Source: Mindlin, J. Appl. Mech. 18 (1951) 31; eq. 2 of the paper.
#[derive(Debug, Clone, Copy)]
pub(super) struct WidthCoupling;

const PARAMETERS: [EffectParameter; 4] = [
    EffectParameter::log("e_y_ratio", "1", [0.02, 50.0], &[1.0]).sized(1.0, 1.5),
    EffectParameter::linear("nu_xy", "1", [0.0, 0.9], &[0.3]).about(0.3, 0.1),
    EffectParameter::log("g_xy_ratio", "1", [0.005, 5.0], &[0.385]).sized(0.385, 1.5),
    EffectParameter::log("g_yz_ratio", "1", [0.05, 20.0], &[1.0, 0.5]).sized(0.7, 1.6),
];

impl Effect for WidthCoupling {
    fn id(&self) -> &'static str {
        "width-coupling"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[e_y, nu_xy, g_xy, g_yz] = values else { return Ok(vec![]) };
        Ok(vec![Action::Plate([e_y, nu_xy, g_xy, g_yz])])
    }
}
