//! What the effects of a test do to the structure itself, the same in every record.

use super::{Action, CoreModulus, EffectSetting, EffectState, FieldTerm, ShearPatch};
use crate::{BeamTerms, ModelError};

/// Terms spread over the beam, and a core that depends on frequency.
#[derive(Default)]
pub(crate) struct SpreadEffects {
    /// None where none of it is spread along x.
    pub terms: Option<BeamTerms>,
    pub patches: Vec<ShearPatch>,
    pub core: Option<CoreModulus>,
    /// A plate in place of the beam: its ratios.
    pub plate: Option<[f64; 4]>,
    /// Side \[m\] of the feet on which all stands that stands on a plate, where it is not the usual one.
    pub foot: Option<f64>,
}

impl SpreadEffects {
    /// Of these effects.
    pub(crate) fn of(effects: &[EffectState], setting: &EffectSetting) -> Result<Self, ModelError> {
        let mut spread = Self::default();
        for effect in effects {
            for action in effect.acting_in(setting)? {
                match action {
                    Action::Field(FieldTerm::ShearPatch(patch)) => spread.patches.push(patch),
                    Action::Field(FieldTerm::RotaryFactor(factor)) => {
                        spread.terms.get_or_insert_default().rotary_factor = factor;
                    }
                    Action::Field(FieldTerm::ShearLoss(loss)) => {
                        spread.terms.get_or_insert_default().losses.push(loss);
                    }
                    Action::Field(FieldTerm::Support(springs)) => {
                        spread.terms.get_or_insert_default().support = Some(springs);
                    }
                    Action::Core(core) => spread.core = Some(core),
                    Action::Plate(ratios) => spread.plate = Some(ratios),
                    Action::Foot(side) => spread.foot = Some(side),
                    Action::Element(_) | Action::Channel(_) | Action::Place(_) | Action::Window { .. } => {}
                }
            }
        }
        if spread.plate.is_some() && (spread.core.is_some() || spread.terms.is_some()) {
            return Err(ModelError::Unsupported(
                "width-coupling beside another effect that is spread over the panel: take one of them out".into(),
            ));
        }
        Ok(spread)
    }
}
