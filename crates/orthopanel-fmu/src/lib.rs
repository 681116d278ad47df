#![doc = include_str!("../README.md")]

mod boundary;
mod capabilities;
mod component;
mod error;
mod floating_point;
mod fmi2;
mod fmi3;
mod logging;
mod nominals;
mod panel;
mod port_names;
mod resource;
mod resource_location;
mod variables;
mod wide_stepper;

pub use capabilities::{
    FMI2_CO_SIMULATION, FMI2_MODEL_EXCHANGE, FMI3_CO_SIMULATION, FMI3_MODEL_EXCHANGE, LOG_CATEGORIES,
};
pub use error::FmuError;
pub use port_names::PortNames;
pub use resource::{GENERATOR, RESOURCE_FILE, RESOURCE_SCHEMA, Residual, Resource, content_token};
pub use variables::{Array, Dependency, Factor, Quantity, UNITS, Unit, Variable, VariableTable};
