//! What the exporter refuses.

use std::path::PathBuf;

use orthopanel_fmu::FmuError;
use thiserror::Error;

/// Errors of this crate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// No place where force goes in, or none where motion comes out.
    #[error("no {ports} port: an FMU needs at least one place of force and one of response")]
    NoPort {
        /// `force` or `response`.
        ports: &'static str,
    },
    /// A name that is no identifier.
    #[error(
        "name {name:?}: must be of letters, digits and _ (128 at most, no digit first), as floor_left: the model's identifier and its \
         library are called so"
    )]
    Name {
        /// The name.
        name: String,
    },
    /// Arrays in a version that has none.
    #[error("arrays: FMI 2.0 has none: export for FMI 3.0, or leave them out")]
    Arrays,
    /// Names of ports that stand in arrays.
    #[error("arrays: the places in one have no names of their own: leave out --arrays or the names")]
    NamesInArrays,
    /// More names than ports.
    #[error("{found} names for {places} {ports} ports: give one at most for each")]
    NamedPorts {
        /// `force` or `response`.
        ports: &'static str,
        /// Names given.
        found: usize,
        /// Places.
        places: usize,
    },
    /// A platform that FMI has no name for.
    #[error("platform {given:?}: must be one of {known}")]
    Platform {
        /// What was given.
        given: String,
        /// Those that are known.
        known: String,
    },
    /// A library that cannot be that of the platform.
    #[error("library for {platform}: {reason}")]
    Library {
        /// The platform.
        platform: String,
        /// Why not.
        reason: String,
    },
    /// Model and ports that do not fit.
    #[error(transparent)]
    Resource(#[from] FmuError),
    /// A file that cannot be written.
    #[error("{}: {source}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A text or archive that cannot be put together in memory.
    #[error("the FMU cannot be put together: {0}")]
    Assemble(String),
}
