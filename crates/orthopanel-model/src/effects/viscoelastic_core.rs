//! `viscoelastic-core`.

use super::{Action, CoreModulus, Effect, EffectParameter, EffectSetting, Owner};
use crate::ModelError;

/// A core whose shear modulus rises with frequency and takes energy: see [`CoreModulus`], parameters $\Delta$, $\tau$,
/// $\alpha$. $G_{zx}$, and with it $G_{yz}$ of a plate, is then the modulus at low frequency.
///
/// Source: Bagley and Torvik, J. Rheology 27 (1983) 201.
#[derive(Debug, Clone, Copy)]
pub(super) struct ViscoelasticCore;

/// Id of this effect.
pub const VISCOELASTIC_CORE: &str = "viscoelastic-core";

const PARAMETERS: [EffectParameter; 3] = [
    EffectParameter::log("strength", "1", [1e-3, 3.0], &[0.1, 0.5]).sized(0.12, 2.2),
    EffectParameter::log("tau", "s", [1e-6, 1.0], &[1e-4, 1e-3, 1e-5]).sized(1.8e-4, 2.5),
    EffectParameter::linear("alpha", "1", [0.1, 1.0], &[0.5, 0.8]).about(0.65, 0.15),
];

impl Effect for ViscoelasticCore {
    fn id(&self) -> &'static str {
        VISCOELASTIC_CORE
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[strength, tau, alpha] = values else { return Ok(vec![]) };
        Ok(vec![Action::Core(CoreModulus { strength, tau, alpha })])
    }
}
