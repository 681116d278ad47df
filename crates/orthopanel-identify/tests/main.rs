//! Identification and tracing, held against the paper and against records made by code of their own.
//!
//! One program for all of a crate's tests: each of its own would be linked apart, for minutes. One file alone:
//! `cargo test --release -p orthopanel-identify --test all FILE::`.
#![allow(clippy::print_stdout)]

mod arrays;
mod contradictions;
mod coverage;
mod coverage_of_hits;
mod damping_bound;
mod damping_laws;
mod hard_records;
mod honest_lists;
mod inference;
mod known_beforehand;
mod lab_records;
mod list_readings;
mod made_records;
mod measured_beam;
mod other_units;
mod paper_frequencies;
mod plate_changed_names;
mod plate_edges;
mod plate_few_frequencies;
mod plate_frequencies;
mod plate_records;
mod plate_shifted_names;
mod support;
mod time_history;
mod time_history_made_records;
mod tracing;
mod tracing_accelerances;
mod tracing_declared;
mod tracing_each_effect;
mod tracing_frequencies;
mod tracing_masses;
mod tracing_rough;
mod undeclared_window;
mod val_list_places;
