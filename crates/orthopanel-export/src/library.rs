//! The runtime that every FMU carries, and the folder in which importers of this platform look for it.

use orthopanel_fmu::MODEL_IDENTIFIER;

use crate::FmiVersion;

/// The library, built with this crate.
pub(crate) const LIBRARY: &[u8] = include_bytes!(env!("ORTHOPANEL_FMU_LIBRARY"));

/// Place of the library inside the archive.
pub(crate) fn path(version: FmiVersion) -> String {
    let extension = std::env::consts::DLL_EXTENSION;
    format!("binaries/{}/{MODEL_IDENTIFIER}.{extension}", platform(version))
}

/// Folder of the platform: FMI 2.0 names five by system and word length, FMI 3.0 all by architecture and system.
fn platform(version: FmiVersion) -> String {
    let (system, architecture) = (std::env::consts::OS, std::env::consts::ARCH);
    let system = if system == "macos" { "darwin" } else { system };
    match (version, system, architecture) {
        (FmiVersion::Fmi2, "linux", "x86_64") => "linux64".into(),
        (FmiVersion::Fmi2, "windows", "x86_64") => "win64".into(),
        (FmiVersion::Fmi2, "darwin", "x86_64") => "darwin64".into(),
        _ => format!("{architecture}-{system}"),
    }
}
