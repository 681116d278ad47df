//! Version of the FMI standard.

/// Version of the FMI standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FmiVersion {
    /// FMI 2.0, the one that most importers read.
    #[default]
    Fmi2,
    /// FMI 3.0.
    Fmi3,
}
