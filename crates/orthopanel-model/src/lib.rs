#![doc = include_str!("../README.md")]

mod accelerance;
mod block_krylov;
mod block_pencil;
mod boundary;
mod constant;
mod core_in_frequency;
#[cfg(not(feature = "compact"))]
mod correlation;
mod damping;
mod deflection_row;
mod dense;
#[cfg(not(feature = "compact"))]
mod draws;
mod effect_entry;
mod effects;
mod end;
mod error;
mod estimate;
mod identifier;
mod legendre;
pub mod limits;
mod mindlin_plate;
mod modal_model;
mod modal_sensitivity;
mod model_text;
mod nodes;
mod order;
mod panel_mode;
mod panel_model;
mod panel_modes;
mod panel_statics;
mod piece;
mod ports;
mod printable;
mod reduced_structure;
mod residual_modes;
mod response;
mod ritz_modes;
mod side_by_side;
mod skyline;
mod sparse_rows;
mod static_deflection;
mod structure;
mod structure_kind;
mod structure_modes;
mod time_model;
mod timoshenko_beam;
mod uniform_loads;
mod wide;

pub use boundary::Boundary;
pub use constant::Constant;
#[cfg(not(feature = "compact"))]
pub use correlation::CorrelationMatrix;
pub use damping::Damping;
pub use deflection_row::{DeflectionRow, RigidMotion};
pub use effect_entry::EffectEntry;
pub use effects::{
    Action, CUBIC_STIFFNESS, ChannelFactor, CoreFit, CoreModulus, EXPONENTIAL_WINDOW, Effect, EffectParameter,
    EffectSetting, EffectState, ElementLaw, FOOT_SIDE, Field, FieldTerm, GAIN, ModesAtLine, ModifiedPanel, OwnModes,
    Owner, PointElement, Prior, RECORD_GAIN, ReceptanceModel, ReceptanceSetup, RecordSetting, RelaxingLines,
    RelaxingMode, RelaxingModes, SENSOR_MASS, STIFFNESS_LOSS, Scale, Seat, SeenModes, Shift, SuspensionMotion,
    VISCOELASTIC_CORE, catalogue, effect, natural_frequencies,
};
pub use end::End;
pub use error::{ModelError, Readable};
pub use estimate::Estimate;
pub use identifier::is_identifier;
pub use mindlin_plate::{MindlinPlate, ModeKind, ModeName, NamedShapes, PLATE_CONSTANTS};
pub use modal_model::{ModalModel, Mode};
pub use modal_sensitivity::{ModeSensitivity, SensitiveModes, sensitive_modes};
pub use panel_mode::PanelMode;
pub use panel_model::{MODEL_SCHEMA, PanelModel};
pub use panel_modes::ModeRange;
pub use piece::{Piece, Place};
pub use ports::Ports;
pub use printable::printable;
pub use reduced_structure::ReducedStructure;
pub use residual_modes::Attachments;
pub use response::{CubicForces, ForceRecord, ModalStepper, cubic_support_forces};
pub use ritz_modes::{modes_below, ritz_modes, ritz_modes_near};
pub use skyline::SymmetricMatrix;
pub use structure::{Block, Motion, RitzMode, ShearMoment, Structure};
pub use structure_kind::StructureKind;
pub use time_model::TimeModel;
pub use timoshenko_beam::{
    BEAM_CONSTANTS, BeamConstants, BeamElements, BeamMode, BeamTerms, ExactBeam, SHEAR_COEFFICIENT, ShearLoss,
    StaticFlexibility, Support, TimoshenkoBeam,
};
