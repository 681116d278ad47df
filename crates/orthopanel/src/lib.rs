#![doc = include_str!("../README.md")]

mod analysis;
mod error;
mod evidence;
mod fmu_refusal;
mod identified;
mod interruption;
pub mod lot;
mod model;
mod motion;
mod observer;
mod provenance;
mod report;
mod run;
mod suffixes;
mod test;
mod traced;

// What the command needs beside the facade, and no one else: no promise.
#[doc(hidden)]
pub mod csv_text;
#[doc(hidden)]
pub mod driving_force;
#[doc(hidden)]
pub mod force_file;
#[doc(hidden)]
pub mod given_file;
#[doc(hidden)]
pub mod harmless;
#[doc(hidden)]
pub mod importer;
#[doc(hidden)]
pub mod json;
#[doc(hidden)]
pub mod measured_pairs;
#[doc(hidden)]
pub mod notes;
#[doc(hidden)]
pub mod outputs;
#[doc(hidden)]
pub mod pictures;
#[doc(hidden)]
pub mod section_3_5;
#[doc(hidden)]
pub mod tables;
#[doc(hidden)]
pub mod time_response;
#[doc(hidden)]
pub mod whole_accelerance;

pub use analysis::Analysis;
pub use error::Error;
pub use fmu_refusal::FmuRefusal;
pub use identified::Identified;
pub use model::{Model, StateSpace, is_fmu_name};
pub use observer::{Observer, Silent, Steps, Work};
/// The layer of records: what a [`Test`] is put together from.
pub use orthopanel_data as data;
pub use orthopanel_export::{FmiVersion, FmuOptions};
pub use orthopanel_identify::Settings;
pub use orthopanel_model::{ModeRange, Piece, Place, Ports};
pub use provenance::Provenance;
pub use run::{PlannedRun, Run, USUAL_MODES, holds_results};
pub use test::Test;
pub use traced::Traced;
