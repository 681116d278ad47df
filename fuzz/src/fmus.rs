//! The command's importer of FMUs, up to before a library is loaded.
#![allow(dead_code, reason = "the command's own files")]

#[path = "../../crates/orthopanel/src/importer/archive.rs"]
mod archive;
#[path = "../../crates/orthopanel/src/importer/description.rs"]
mod description;
#[path = "../../crates/orthopanel/src/importer/fmi2.rs"]
mod fmi2;
#[path = "../../crates/orthopanel/src/importer/fmi3.rs"]
mod fmi3;
#[path = "../../crates/orthopanel/src/importer/instance.rs"]
mod instance;
#[path = "../../crates/orthopanel/src/importer/log.rs"]
mod log;

/// An FMU: all its files are unpacked into memory.
pub fn fmu_archive(bytes: &[u8]) -> bool {
    let Ok(mut archive) = archive::Archive::new(bytes) else { return false };
    let names: Vec<String> = archive.names().map(String::from).collect();
    names.iter().all(|name| archive.take(name, u64::MAX).is_ok())
}

/// The description in an FMU: its variables, and the path of its library.
pub fn fmu_description(bytes: &[u8]) -> bool {
    let Ok(description) = description::Description::parse(bytes) else { return false };
    description.library().is_ok() && description.references().is_ok()
}
