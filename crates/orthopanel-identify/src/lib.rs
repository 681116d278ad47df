#![doc = include_str!("../README.md")]

mod accelerance_fit;
mod downhill_simplex;
mod elastic_constants;
mod entry;
mod error;
mod frequency_fit;
mod identification;
mod least_squares;
mod settings;
mod time_history;

pub use accelerance_fit::DampingLaw;
pub use entry::identify;
pub use error::IdentifyError;
pub use identification::{AcceleranceFit, Correlation, Identification, IdentifiedConstant, ModeFit, PieceFit};
pub use settings::{PaperWeights, Search, Settings};
pub use time_history::{
    ComparedSignals, ForceBetweenSamples, HistorySettings, HitComparison, Misfit, compare_time_history,
};
