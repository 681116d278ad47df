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
    /// A name that XML or an importer cannot carry.
    #[error("FMU name {name:?}: must have a visible character and no control characters")]
    Name {
        /// The name.
        name: String,
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
