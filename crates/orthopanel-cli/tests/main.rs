//! The command, run as its users run it.
//!
//! One program for all of a crate's tests: each of its own would be linked apart, for minutes. One file alone:
//! `cargo test --release -p orthopanel-cli --test all FILE::`.
#![allow(clippy::print_stdout)]

mod bad_input;
mod bad_records;
mod commands;
mod covariance;
mod declared_effects;
mod first_steps;
mod foreign_fmu;
mod limits;
mod outputs;
mod plate;
mod provenance;
mod readme;
mod records;
mod report;
mod report_of_trace;
mod section_3_5;
mod streams;
mod support;
mod trace;
mod trace_models;
