#![doc = include_str!("../README.md")]

mod arguments;
mod commands;
mod console;
mod error;
mod model_files;
mod progress;
mod record_options;
mod reference_option;
mod terminal;

use std::ffi::OsString;

use clap::Parser;
use error::{BAD_INPUT, CommandError, DONE};

/// Runs the command with these words, the first of which is the program's name; gives its exit status.
///
/// It prints on standard output and standard error. It may be called more than once in a process, but not by two threads at once: one
/// terminal has one command.
pub fn main(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    outcome(&words).unwrap_or_else(|error| {
        console::say_each(&format!("orthopanel: {error}"));
        error.exit_code()
    })
}

fn outcome(words: &[OsString]) -> Result<u8, CommandError> {
    match commands::Arguments::try_parse_from(words) {
        Ok(arguments) => commands::execute(arguments, &told(words)).map(|()| DONE),
        // Bad usage repeats the arguments: plain text, in which nothing steers the terminal.
        Err(answer) if answer.use_stderr() => {
            console::say_lines(&answer.render().to_string());
            Ok(BAD_INPUT)
        }
        // --help and --version.
        Err(answer) => console::print_help(&answer).map(|()| DONE),
    }
}

/// The words after the program's name, as a manifest tells them.
fn told(words: &[OsString]) -> Vec<String> {
    words.iter().skip(1).map(|word| word.to_string_lossy().into_owned()).collect()
}
