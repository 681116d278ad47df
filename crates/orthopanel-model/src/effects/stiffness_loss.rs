//! `stiffness-loss`.

use super::{Action, Effect, EffectParameter, EffectSetting, FieldTerm, Owner, Reference};
use crate::{ModelError, ShearLoss};

/// A face come off the core: shear stiffness $k'G_{zx}A\,(1-\text{loss})$ for $|x-x_0| < \text{span}/2$,
/// the loss \[1\], span and $x_0$ \[m\].
///
/// A plate loses the same part of both shear stiffnesses, across its whole width.
///
/// Source: a disbond leaves the faces' bending and takes shear stiffness over its span. The faces' own sliding
/// modes inside a long disbond are not in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct StiffnessLoss;

const PARAMETERS: [EffectParameter; 3] = [
    EffectParameter::linear("loss", "1", [-0.5, 0.98], &[0.3, 0.8]).sized(0.4, 1.7),
    EffectParameter::linear("span", "m", [0.01, 1.0], &[0.1, 0.3, 0.04]).sized(0.06, 1.5).of(Reference::Length),
    EffectParameter::place(),
];

impl Effect for StiffnessLoss {
    fn id(&self) -> &'static str {
        "stiffness-loss"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[loss, span, at] = values else { return Ok(vec![]) };
        Ok(vec![Action::Field(FieldTerm::ShearLoss(ShearLoss { loss, span, at }))])
    }
}
