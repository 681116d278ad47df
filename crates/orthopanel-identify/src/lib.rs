#![doc = include_str!("../README.md")]

mod accelerance_fit;
mod answer;
mod comparison;
mod coupled_damping;
mod curves;
mod declared_doubt;
mod declared_effects;
mod downhill_simplex;
mod effect_places;
mod entry;
mod error;
mod free_constants;
mod frequency_fit;
mod hit_strength;
mod hypothesis;
mod identification;
mod inference;
#[doc(hidden)]
pub mod interruption;
mod judge;
mod known_beforehand;
mod least_squares;
mod matching;
mod measured;
mod model_error;
mod outcome;
mod place_readings;
mod plate_of_ratios;
mod plate_start;
mod posterior;
mod predicted;
mod reference;
mod search;
mod search_progress;
mod settings;
mod shapes_of_list;
mod shared_error;
mod stacked;
mod starting_constants;
mod structures;
mod time_history;
mod to_check;
mod trace;
mod trace_rows;
mod traced_effect;
mod usual_ratios;
mod view;
mod whitening;

pub use accelerance_fit::DampingLaw;
pub use entry::identify;
pub use error::{IdentifyError, PriorContradiction};
pub use identification::{
    AcceleranceFit, Correlation, HiddenMode, Identification, IdentifiedConstant, ModeFit, NotIdentified, PieceFit,
};
pub use interruption::until;
pub use matching::{ModalAssurance, ModeMatch};
pub use measured::{MeasuredModes, MeasuredRecord, Pole, measured_modes};
pub use outcome::{
    Candidate, Detectable, EstimatedModelError, FittedError, NotTested, Progress, Removed, SharedModelError,
    TracedError, Tracing, Verdict,
};
pub use settings::{PaperWeights, Search, Settings};
pub use time_history::{
    ComparedSignals, ForceBetweenSamples, HistorySettings, HitComparison, Misfit, Stepping, compare_time_history,
};
pub use trace::{trace, trace_against, trace_with};
pub use trace_rows::TRACE_SCHEMA;
pub use traced_effect::{TracedEffect, TracedParameter};
