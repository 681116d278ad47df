//! What the effects of a test do to the structure itself, the same in every record.

use super::{Action, CoreModulus, EffectSetting, EffectState, FieldTerm};
use crate::{BeamTerms, ModelError};

/// Terms spread over the beam, and a core that depends on frequency.
#[derive(Default)]
pub(crate) struct SpreadEffects {
    /// None where the beam is even.
    pub terms: Option<BeamTerms>,
    /// Position among [`crate::Structure::term_derivatives`], and column.
    pub parameters: Vec<(usize, usize)>,
    /// With the column of its first parameter.
    pub core: Option<(CoreModulus, usize)>,
    /// A plate in place of the beam: its ratios, with the column of the first.
    pub plate: Option<([f64; 4], usize)>,
}

impl SpreadEffects {
    /// Of these effects; `first` is the column of the first effect's first value.
    pub(crate) fn of(effects: &[EffectState], setting: &EffectSetting, first: usize) -> Result<Self, ModelError> {
        let mut spread = Self::default();
        let mut terms = BeamTerms::default();
        let (mut rotary, mut losses, mut support, mut waves) = (vec![], vec![], vec![], vec![]);
        for (effect, start) in effects.iter().zip(EffectState::starts(effects, first)) {
            for action in effect.effect.act(&effect.values_in(setting.record.number)?, setting)? {
                match action {
                    Action::Field(FieldTerm::RotaryFactor(factor), numbers) => {
                        terms.rotary_factor = factor;
                        rotary = numbers.iter().map(|number| start + number).collect();
                    }
                    Action::Field(FieldTerm::ShearLoss(loss), numbers) => {
                        terms.losses.push(loss);
                        losses.extend(numbers.iter().map(|number| start + number));
                    }
                    Action::Field(FieldTerm::Support(springs), numbers) => {
                        terms.support = Some(springs);
                        support = numbers.iter().map(|number| start + number).collect();
                    }
                    Action::Field(FieldTerm::CoreWave(number, amplitude), numbers) => {
                        let length = terms.core_waves.len().max(number + 1);
                        terms.core_waves.resize(length, 0.0);
                        terms.core_waves[number] += amplitude;
                        // Behind values that each record has of its own.
                        let column = |parameter: &usize| start + effect.position(*parameter, setting.record.number);
                        waves.extend(numbers.iter().map(|parameter| (number, column(parameter))));
                    }
                    Action::Core(core) => spread.core = Some((core, start)),
                    Action::Plate(ratios) => spread.plate = Some((ratios, start)),
                    Action::Element(_) | Action::Channel(..) | Action::Place(_) | Action::Window { .. } => {}
                }
            }
        }
        if spread.plate.is_some() && (spread.core.is_some() || rotary.len() + losses.len() + support.len() > 0) {
            return Err(ModelError::Unsupported(
                "width-coupling beside another effect that is spread over the panel: take one of them out".into(),
            ));
        }
        // In the order of the beam's own terms: the rotary factor is there always.
        let before = 1 + losses.len() + support.len();
        let later = losses.into_iter().chain(support).enumerate().map(|(i, column)| (i + 1, column));
        let waves = waves.into_iter().map(|(number, column)| (before + number, column));
        spread.parameters = rotary.into_iter().map(|column| (0, column)).chain(later).chain(waves).collect();
        spread.terms = (!spread.parameters.is_empty()).then_some(terms);
        Ok(spread)
    }
}
