#![doc = include_str!("../README.md")]

mod acceleration_band;
mod archive;
mod documentation;
mod drawing;
mod error;
mod fmi_version;
mod fmu;
mod fmu_options;
mod frequency_doubt;
mod html;
mod library;
mod model_description;
mod origin;
mod reference;
mod samples;
mod source_fmu;
mod ssp;
mod terminals;

pub use error::ExportError;
pub use fmi_version::FmiVersion;
pub use fmu::{Fmu, FmuModes};
pub use fmu_options::FmuOptions;
pub use library::{Library, Platform, is_carried_library};
pub use orthopanel_fmu::{Connections, FmuError, Mount, PortNames, Residual};
pub use samples::parameter_samples;
pub use ssp::ParameterValues;
