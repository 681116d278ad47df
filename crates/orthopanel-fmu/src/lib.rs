#![doc = include_str!("../README.md")]

/// A text that importers read in the XML: the library inside an FMU, which writes none, does without.
macro_rules! described {
    ($($text:tt)*) => {
        if cfg!(feature = "compact") { String::new() } else { format!($($text)*) }
    };
}

mod boundary;
mod capabilities;
mod component;
mod connections;
mod error;
mod floating_point;
mod fmi2;
mod fmi3;
mod logging;
mod nominals;
mod panel;
mod port_names;
mod residual;
mod resource;
mod resource_location;
mod variables;
mod wide_stepper;

pub use capabilities::{
    FMI2_CO_SIMULATION, FMI2_MODEL_EXCHANGE, FMI3_CO_SIMULATION, FMI3_MODEL_EXCHANGE, LOG_CATEGORIES,
};
pub use connections::{Connections, Mount};
pub use error::FmuError;
pub use port_names::PortNames;
pub use residual::Residual;
pub use resource::{GENERATOR, RESOURCE_FILE, RESOURCE_SCHEMA, Resource, content_token};
pub use variables::{Array, Dependency, Factor, Quantity, UNITS, Unit, Variable, VariableTable};
