//! Files, signals and spectra, held against pyuff, pyFRF and signals made by hand.
//!
//! One program for all of a crate's tests: each of its own would be linked apart, for minutes. One file alone:
//! `cargo test --release -p orthopanel-data --test all FILE::`.
#![allow(clippy::print_stdout)]

mod arrays;
mod channels;
mod csv_files;
mod force_noise;
mod hit_agreement;
mod hits;
mod lab_cases;
mod lab_dialects;
mod lab_questions;
mod limits;
mod node_numbers;
mod overload;
mod recorded_accelerances;
mod roving_tests;
mod spectra;
mod support;
mod test_file;
mod text_columns;
mod unequal_hits;
mod universal_files;
mod wrong_sample;
