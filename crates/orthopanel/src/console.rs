//! The one writer to the terminal: answers go to standard output, messages to standard error.
//!
//! A reader that has gone away (`| head`) and a stream that was closed from the start are no errors. An answer that is
//! cut short otherwise, as on a full disk, is one; messages are for people alone, and what cannot be said is not.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{ErrorKind, Write as _, stderr, stdout};

use serde::Serialize;

use crate::error::CommandError;
use crate::json;

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

/// `text` with every character that steers a terminal made visible, such as `\u{1b}`; line ends and tabs stay.
fn harmless(text: &str) -> Cow<'_, str> {
    escaped(text, is_harmful, for_people)
}

/// As [`harmless`], of what must stay on one line.
pub fn harmless_line(text: &str) -> Cow<'_, str> {
    escaped(text, is_harmful_in_line, for_people)
}

/// `text` with each character that `is_harmful` says of written as `written` has it.
pub fn escaped(text: &str, is_harmful: fn(char) -> bool, written: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(is_harmful) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        if is_harmful(character) { escaped += &written(character) } else { escaped.push(character) }
    }
    Cow::Owned(escaped)
}

/// Control characters (C0, DEL, C1), which move the cursor, colour and retitle, and those that turn the direction of
/// writing, behind which a name shows as another.
pub fn is_harmful(character: char) -> bool {
    is_harmful_in_line(character) && !matches!(character, '\n' | '\t')
}

fn is_harmful_in_line(character: char) -> bool {
    character.is_control() || matches!(orthopanel_model::printable(character.encode_utf8(&mut [0; 4])), Cow::Owned(_))
}

fn for_people(character: char) -> String {
    character.escape_unicode().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_made_visible() {
        let name = "a\u{1b}[2J\u{7}\u{9b}1m\u{202e}b\u{2069}\u{7f}\r";
        let shown = "a\\u{1b}[2J\\u{7}\\u{9b}1m\\u{202e}b\\u{2069}\\u{7f}\\u{d}";
        assert_eq!(harmless(name), shown);
        assert_eq!(harmless("two\n\tlines, \u{3b6} \u{d7}"), "two\n\tlines, \u{3b6} \u{d7}");
        assert_eq!(harmless_line("a\nerror: \t"), "a\\u{a}error: \\u{9}");
    }
}
