//! `stiffness-loss`.

use super::{Action, Effect, EffectParameter, EffectSetting, FieldTerm, Owner, Reference, ShearPatch};
use crate::{ModelError, Place, ShearLoss};

/// A face come off the core: shear stiffness $k'G_{zx}A\,(1-\text{loss})$ for $|x-x_0| < \text{span}/2$,
/// the loss \[1\], span and $x_0$ \[m\].
///
/// A plate loses the same part of both shear stiffnesses, over a square of side span at $x_0$, $y_0$, or across its whole width where no $y_0$ is given.
///
/// Source: a disbond leaves the faces' bending and takes shear stiffness over its span. The faces' own sliding
/// modes inside a long disbond are not in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct StiffnessLoss;

/// Its id.
pub const STIFFNESS_LOSS: &str = "stiffness-loss";

const PARAMETERS: [EffectParameter; 4] = [
    EffectParameter::linear("loss", "1", [-0.5, 0.98], &[0.3, 0.8]).sized(0.4, 1.7),
    EffectParameter::linear("span", "m", [0.01, 1.0], &[0.1, 0.3, 0.04]).sized(0.06, 1.5).of(Reference::Length),
    EffectParameter::place(),
    // Not a number: across the whole width.
    EffectParameter::place_across().held_at(f64::NAN),
];

impl Effect for StiffnessLoss {
    fn id(&self) -> &'static str {
        STIFFNESS_LOSS
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn in_words(&self) -> &'static str {
        "shear stiffness lost"
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[loss, span, x, y] = values else { return Ok(vec![]) };
        Ok(vec![Action::Field(if y.is_nan() {
            FieldTerm::ShearLoss(ShearLoss { loss, span, at: x })
        } else {
            FieldTerm::ShearPatch(ShearPatch { loss, span, at: Place { x, y } })
        })])
    }
}
