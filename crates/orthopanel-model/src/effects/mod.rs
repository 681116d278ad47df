//! Effects: pieces of physics that the base model may lack, one file each, and a piece with them.
//!
//! An effect is a name, an owner and a few parameters; [`Effect::act`] says what they do to a test. [`ModifiedPanel`] carries it
//! out in modes, [`ReceptanceModel`] line by line of a spectrum. [`catalogue()`] lists all.

mod action;
mod beam_base;
mod catalogue;
mod channel_factor;
mod core_fit;
mod core_modulus;
mod coupled_flexibility;
mod coupled_modes;
mod coupled_panel;
mod coupled_system;
mod foot;
mod known;
mod low_modes;
mod modified_panel;
mod parameter;
mod point_element;
mod receptance;
mod relaxing_lines;
mod relaxing_modes;
mod relaxing_panel;
mod row;
mod setting;
mod size_error;
mod spread_effects;
mod state;
mod uneven_beam;
mod wide_plate;

mod channel_delay;
mod cubic_stiffness;
mod edge_mass;
mod exponential_window;
mod gain;
mod hammer_offset;
mod high_pass;
mod local_mass;
mod position_error;
mod record_gain;
mod resonator;
mod rotary_inertia;
mod sensor_mass;
mod sensor_resonance;
mod stiffness_loss;
mod support_compliance;
mod suspension;
mod viscoelastic_core;
mod width_coupling;

pub use action::{Action, FieldTerm, ShearPatch, Shift};
pub use catalogue::{catalogue, effect};
pub use channel_factor::ChannelFactor;
pub use core_fit::CoreFit;
pub use core_modulus::CoreModulus;
pub(crate) use coupled_flexibility::{FarMode, FarModes, Flexibilities};
pub(crate) use coupled_modes::CoupledMode;
pub use coupled_modes::natural_frequencies;
pub(crate) use coupled_panel::{CoupledPanel, Even, PanelWithEffects, elements as point_elements};
pub use cubic_stiffness::CUBIC_STIFFNESS;
pub use exponential_window::EXPONENTIAL_WINDOW;
pub use foot::FOOT_SIDE;
pub use gain::GAIN;
pub use modified_panel::{ModifiedPanel, OwnModes, SeenModes};
use parameter::Reference;
pub use parameter::{EffectParameter, Prior, Scale};
pub use point_element::{ElementLaw, PointElement, Seat};
pub use receptance::{ReceptanceModel, ReceptanceSetup};
pub use record_gain::RECORD_GAIN;
pub use relaxing_lines::RelaxingLines;
pub use relaxing_modes::{ModesAtLine, RelaxingMode, RelaxingModes};
pub use sensor_mass::SENSOR_MASS;
pub use setting::{EffectSetting, RecordSetting, SuspensionMotion};
pub(crate) use spread_effects::SpreadEffects;
pub use state::EffectState;
pub use stiffness_loss::STIFFNESS_LOSS;
pub use uneven_beam::Field;
pub use viscoelastic_core::VISCOELASTIC_CORE;

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
