//! The FMU as a file: its description, byte for byte, and what lies beside it.
//!
//! One program for all of a crate's tests: each of its own would be linked apart, for minutes. One file alone:
//! `cargo test --release -p orthopanel-export --test all FILE::`.

mod fmu_file;
mod golden_xml;
