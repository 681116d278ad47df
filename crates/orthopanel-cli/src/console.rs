//! The one writer to the terminal: answers go to standard output, messages to standard error.
//!
//! A reader that has gone away (`| head`) and a stream that was closed from the start are no errors. An answer that is
//! cut short otherwise, as on a full disk, is one; messages are for people alone, and what cannot be said is not.

use std::fmt::Display;
use std::io::{ErrorKind, Write as _, stderr, stdout};

use orthopanel::harmless::{harmless, harmless_line};
use orthopanel::json;
use serde::Serialize;

use crate::error::CommandError;

/// Writes one message as one line on standard error.
pub fn say(message: impl Display) {
    let line = harmless_line(&message.to_string()).into_owned() + "\n";
    let _ = stderr().write_all(line.as_bytes());
}

/// Writes one message on standard error, with the lines to copy that it brings, each indented, below it.
pub fn say_each(message: &str) {
    let mut lines = message.split("\n    ");
    say(lines.next().unwrap_or_default());
    lines.for_each(|line| say(format_args!("    {line}")));
}

/// Writes a text of several lines on standard error.
pub fn say_lines(text: &str) {
    let _ = stderr().write_all(harmless(text).as_bytes());
}

/// Prints on standard output.
///
/// # Errors
/// [`CommandError::Answer`] where it is not written whole.
pub fn print(text: &str) -> Result<(), CommandError> {
    whole(stdout().lock().write_all(harmless(text).as_bytes()))
}

/// Prints one JSON object on standard output.
///
/// # Errors
/// As [`print()`].
pub fn print_json(value: &impl Serialize) -> Result<(), CommandError> {
    print(&json::line(value))
}

/// Prints what clap answers to `--help` and `--version`, in its colours.
///
/// # Errors
/// As [`print()`].
pub fn print_help(answer: &clap::Error) -> Result<(), CommandError> {
    whole(answer.print())
}

fn whole(written: std::io::Result<()>) -> Result<(), CommandError> {
    match written.and_then(|()| stdout().flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CommandError::Answer(error)),
        _ => Ok(()),
    }
}
