//! A piece of physics that a base model may lack, and who it belongs to.

use super::{Action, EffectParameter, EffectSetting};
use crate::{ModelError, Piece};

/// Who an effect belongs to, and so whether it stays in a model of the panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Owner {
    /// The panel: the effect stays in the model file and in the FMU.
    Panel,
    /// The rig: sensor, suspension, clamp; taken out of the FMU.
    Rig,
    /// The measuring chain; taken out of the FMU.
    Channel,
}

impl Owner {
    /// The word in files: `panel`, `rig` or `channel`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Panel => "panel",
            Self::Rig => "rig",
            Self::Channel => "channel",
        }
    }
}

/// A piece of physics that changes a prediction.
pub trait Effect: Sync {
    /// Its id in files and reports.
    fn id(&self) -> &'static str;

    /// Who it belongs to.
    fn owner(&self) -> Owner;

    /// What it is, in words that a place may follow.
    fn in_words(&self) -> &'static str {
        self.id()
    }

    /// Its parameters; all lists of values stand in this order.
    fn parameters(&self) -> &'static [EffectParameter];

    /// What it does at these values of its parameters, in one record of a test.
    ///
    /// A parameter that has a value in each record ([`EffectParameter::each_record`]) is given that record's.
    ///
    /// # Errors
    /// [`ModelError::EffectNeeds`] where the test does not tell what the effect needs.
    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError>;

    /// What of the piece as the test file has it would show the same at these values, were it wrong.
    fn looks_like(&self, _values: &[f64], _piece: &Piece) -> Option<String> {
        None
    }

    /// The linear effect that this one looks like in the mean over hits, where it is not linear and shows between hits alone.
    fn linearised(&self) -> Option<&'static dyn Effect> {
        None
    }

    /// Checks number and bounds of values.
    ///
    /// # Errors
    /// [`ModelError::EffectValues`] for another number of them, [`ModelError::EffectParameter`] for one out of bounds.
    fn check(&self, values: &[f64], piece: &Piece) -> Result<(), ModelError> {
        let expected = self.parameters().len();
        if values.len() != expected {
            return Err(ModelError::EffectValues { effect: self.id(), found: values.len(), expected });
        }
        self.parameters().iter().zip(values).try_for_each(|(parameter, &value)| {
            if value.is_nan() && parameter.held_at.is_some_and(f64::is_nan) {
                return Ok(());
            }
            let (low, high) = parameter.range(piece);
            if (low..=high).contains(&value) {
                return Ok(());
            }
            let (name, unit) = (parameter.name, parameter.unit);
            Err(ModelError::EffectParameter { effect: self.id(), name, value, unit, low, high })
        })
    }
}
