//! The library inside every FMU, called as importers call it.
//!
//! One program for all of a crate's tests: each of its own would be linked apart, for minutes. One file alone:
//! `cargo test --release -p orthopanel-fmu --test all FILE::`.

mod c_functions;
mod resources;
mod threads;
mod tunable_parameters;
mod wrong_calls;
