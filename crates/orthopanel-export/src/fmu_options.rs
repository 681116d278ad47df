//! How an FMU is made.

use orthopanel_fmu::{Connections, PortNames, Residual};

use crate::{FmiVersion, Library};

/// How an FMU is made.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuOptions {
    /// Model name, model identifier and file name of the library: importers tell FMUs apart by it, so two in one vehicle have two. A name
    /// as in C.
    pub name: String,
    /// One line on what it is.
    pub description: String,
    /// Version of the standard.
    pub version: FmiVersion,
    /// All forces as one array and each kind of output as another, not a variable each; FMI 3.0 alone has arrays.
    pub arrays: bool,
    /// Names of the ports, which stand in those of variables.
    pub names: PortNames,
    /// What stands for the modes left out.
    pub residual: Residual,
    /// Mounts, and inputs and outputs beside those of the ports.
    pub connections: Connections,
    /// Libraries of other platforms, or one in place of this platform's own.
    pub libraries: Vec<Library>,
}

impl Default for FmuOptions {
    fn default() -> Self {
        Self {
            name: "panel".into(),
            description: "Panel: force in, acceleration, velocity and displacement out".into(),
            version: FmiVersion::Fmi2,
            arrays: false,
            names: PortNames::default(),
            residual: Residual::default(),
            connections: Connections::default(),
            libraries: Vec::new(),
        }
    }
}
