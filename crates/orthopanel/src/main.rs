#![doc = include_str!("../README.md")]

mod arguments;
mod commands;
mod contradicted;
mod driving_force;
mod error;
mod evidence;
mod force_file;
mod identified;
mod importer;
mod measured_pairs;
mod model_file;
mod notes;
mod output;
mod pictures;
mod progress;
mod record_options;
mod report;
mod section_3_5;
mod tables;
mod time_response;
mod traced;
mod whole_accelerance;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    // clap itself answers --help and --version, and leaves with 2 on bad usage.
    match commands::execute(commands::Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("orthopanel: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
