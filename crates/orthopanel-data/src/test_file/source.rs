//! The text of a test file, for messages: lines from spans.

use std::{
    ops::Range,
    path::{Path, PathBuf},
};

use toml::Spanned;

use super::wrong_type;
use crate::{DataError, Location, Position};

/// A test file's name and text.
pub(super) struct Source<'a> {
    path: &'a Path,
    text: &'a str,
    /// Byte of each line's end; `None` where there is no text.
    line_ends: Option<Vec<usize>>,
}

impl<'a> Source<'a> {
    pub(super) fn new(path: &'a Path, text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self { path, text, line_ends: Some(ends.map(|(at, _)| at).collect()) }
    }

    /// Of a test that is in no file.
    pub(super) fn in_memory() -> Self {
        Self { path: Path::new("the test in memory"), text: "", line_ends: None }
    }

    /// `key`, at the line where `span` begins.
    pub(super) fn at(&self, span: Range<usize>, key: impl Into<String>) -> Box<Location> {
        let line = |ends: &Vec<usize>| Position::Line(1 + ends.partition_point(|&end| end < span.start));
        let position = self.line_ends.as_ref().map_or(Position::Whole, line);
        Box::new(Location { file: self.path.to_path_buf(), position, key: key.into() })
    }

    /// `key`, where no line can be named.
    pub(super) fn whole(&self, key: impl Into<String>) -> Box<Location> {
        Box::new(Location { file: self.path.to_path_buf(), position: Position::Whole, key: key.into() })
    }

    /// What the TOML reader says, with its line.
    pub(super) fn syntax(&self, error: &toml::de::Error) -> DataError {
        let (message, span) = (error.message().trim(), error.span());
        let start = span.as_ref().map(|span| span.start);
        let (key, message) = match start.and_then(|start| wrong_type::in_plain_words(self.text, start, message)) {
            Some((key, message)) => (key, message),
            None => (String::new(), message.replace('\n', ": ")),
        };
        let at = span.map_or_else(|| self.whole(key.as_str()), |span| self.at(span, key.as_str()));
        DataError::Syntax { at, message }
    }

    /// Refuses a list that is too long.
    pub(super) fn at_most(
        &self,
        (found, what): (usize, &'static str),
        most: usize,
        at: impl FnOnce() -> Box<Location>,
        remedy: &'static str,
    ) -> Result<(), DataError> {
        if found <= most { Ok(()) } else { Err(DataError::TooMany { at: at(), found, what, most, remedy }) }
    }

    /// A number that must be finite and greater than zero.
    pub(super) fn positive(&self, number: &Spanned<f64>, key: &str, unit: &str) -> Result<f64, DataError> {
        let value = *number.get_ref();
        if value.is_finite() && value > 0.0 {
            return Ok(value);
        }
        let range = format!("must be a finite number of {unit}, greater than zero");
        Err(DataError::OutOfRange { at: self.at(number.span(), key), value, range })
    }

    /// Frequencies from and to \[Hz\].
    pub(super) fn band(&self, band: &Spanned<[f64; 2]>, key: &str) -> Result<[f64; 2], DataError> {
        let [from, to] = *band.get_ref();
        if from >= 0.0 && from < to && to.is_finite() {
            return Ok([from, to]);
        }
        let range = "a band is [from, to] in Hz, rising, from zero or above".into();
        let value = if from >= 0.0 { to } else { from };
        Err(DataError::OutOfRange { at: self.at(band.span(), key), value, range })
    }

    /// A number that must be finite.
    pub(super) fn finite(&self, number: &Spanned<f64>, key: &str) -> Result<f64, DataError> {
        let value = *number.get_ref();
        if value.is_finite() {
            return Ok(value);
        }
        Err(DataError::OutOfRange { at: self.at(number.span(), key), value, range: "must be a finite number".into() })
    }

    /// A file named in the text: beside the test file unless its path is absolute.
    pub(super) fn beside(&self, name: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name)
    }
}
