#![doc = include_str!("../README.md")]

mod arguments;
mod commands;
mod console;
mod contradicted;
mod csv_text;
mod driving_force;
mod error;
mod evidence;
mod fmu_refusal;
mod force_file;
mod given_file;
mod identified;
mod importer;
mod json;
mod measured_pairs;
mod model_file;
mod notes;
mod origin;
mod outputs;
mod pictures;
mod progress;
mod record_options;
mod reference_option;
mod report;
mod section_3_5;
mod tables;
mod time_response;
mod traced;
mod whole_accelerance;

use std::process::ExitCode;

use clap::Parser;
use error::{BAD_INPUT, CommandError};

/// A trace takes and returns small matrices by the million, from several threads.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    outcome().unwrap_or_else(|error| {
        console::say_each(&format!("orthopanel: {error}"));
        ExitCode::from(error.exit_code())
    })
}

fn outcome() -> Result<ExitCode, CommandError> {
    match commands::Arguments::try_parse() {
        Ok(arguments) => commands::execute(arguments).map(|()| ExitCode::SUCCESS),
        // Bad usage repeats the arguments: plain text, in which nothing steers the terminal.
        Err(answer) if answer.use_stderr() => {
            console::say_lines(&answer.render().to_string());
            Ok(ExitCode::from(BAD_INPUT))
        }
        // --help and --version.
        Err(answer) => console::print_help(&answer).map(|()| ExitCode::SUCCESS),
    }
}
