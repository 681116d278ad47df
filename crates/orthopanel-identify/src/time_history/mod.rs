//! A model driven with measured forces, and held against the measured accelerations (section 3.5, figures 9 to 12).

mod comparison;
mod force_between_samples;
mod spectrum;

pub use comparison::{ComparedSignals, HistorySettings, HitComparison, Misfit, compare_time_history};
pub use force_between_samples::{ForceBetweenSamples, Stepping};
