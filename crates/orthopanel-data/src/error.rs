//! What the data layer refuses: where it stands in which file, the numbers in it, and the way out.

use std::{fmt, io, path::PathBuf};

use orthopanel_model::{ModelError, Readable};
use thiserror::Error;

/// Where in a file something is wrong.
///
/// Lists in `key` are counted from 1, as modes are: `measurement[2].values[4]` is mode 4 of the second measurement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The file, as it was named to the reader; of what stands in memory what messages call it.
    pub file: PathBuf,
    /// Line or byte, where one is known.
    pub position: Position,
    /// Path of the key in a test file; name of the record or column elsewhere; may be empty.
    pub key: String,
}

/// A place in a file's text or bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// The file as a whole.
    Whole,
    /// A line, from 1.
    Line(usize),
    /// A byte, from 0.
    Byte(usize),
}

impl Location {
    /// A file as a whole.
    pub(crate) fn whole(file: impl Into<PathBuf>) -> Box<Self> {
        Box::new(Self { file: file.into(), position: Position::Whole, key: String::new() })
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match self.position {
            Position::Whole => {}
            Position::Line(line) => write!(f, ":{line}")?,
            Position::Byte(byte) => write!(f, ", byte {byte}")?,
        }
        if self.key.is_empty() { Ok(()) } else { write!(f, ": {}", self.key) }
    }
}

/// Errors of this crate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DataError {
    /// A declared effect that is said to belong to another than it does.
    #[error("{at}: {given:?} given, but {effect} belongs to the {owner}: write owner = {owner:?}, or leave it out")]
    EffectOwner {
        /// The key.
        at: Box<Location>,
        /// Id of the effect.
        effect: String,
        /// The owner in the test file.
        given: String,
        /// The owner in the catalogue.
        owner: &'static str,
    },
    /// A file that cannot be opened or read.
    #[error("{at}: cannot be read: {source}")]
    Unreadable {
        /// The file, and the key that names it where a test file does.
        at: Box<Location>,
        /// What the system says.
        source: io::Error,
    },
    /// A test file that is no TOML, or a key of it that is unknown or has another type.
    #[error("{at}: {message}")]
    Syntax {
        /// Line of the fault.
        at: Box<Location>,
        /// What is wrong and what was expected.
        message: String,
    },
    /// A key that must be there.
    #[error("{at} is missing: {remedy}")]
    Missing {
        /// The key.
        at: Box<Location>,
        /// What to write.
        remedy: &'static str,
    },
    /// A key or value that contradicts another.
    #[error("{at}: {problem}")]
    Contradiction {
        /// The key.
        at: Box<Location>,
        /// What it contradicts, and the way out.
        problem: String,
    },
    /// A number outside its range.
    #[error("{at} = {}: {range}", Readable(*.value))]
    OutOfRange {
        /// The key.
        at: Box<Location>,
        /// The number.
        value: f64,
        /// The range, with its unit.
        range: String,
    },
    /// A name that is not in the list it must come from.
    #[error("{at} = {:?}: {remedy}", short(.name))]
    UnknownName {
        /// The key.
        at: Box<Location>,
        /// The name found.
        name: String,
        /// The names that would be right.
        remedy: String,
    },
    /// A name given twice.
    #[error("{at} = {:?}: the name stands before, give each its own", short(.name))]
    Duplicate {
        /// The second place of the name.
        at: Box<Location>,
        /// The name.
        name: String,
    },
    /// Natural frequencies that do not rise.
    #[error(
        "{at}: {piece}: mode {mode} ({} Hz) {relation} mode {before} ({} Hz): list natural frequencies in \
         rising order", Readable(*.value), Readable(*.previous), relation = if value < previous { "lies below" } else { "repeats" }, before = mode - 1
    )]
    Order {
        /// The key.
        at: Box<Location>,
        /// The piece's name.
        piece: String,
        /// The mode, from 1, that lies too low.
        mode: usize,
        /// Its frequency \[Hz\].
        value: f64,
        /// The frequency of the mode before it \[Hz\].
        previous: f64,
    },
    /// A list whose length does not fit another's.
    #[error("{at} has {found} entries: {remedy}")]
    Count {
        /// The key.
        at: Box<Location>,
        /// Entries found.
        found: usize,
        /// What would be right.
        remedy: String,
    },
    /// A list with more entries than are taken.
    #[error("{at}: {found} {what}, and at most {most} are taken: {remedy}")]
    TooMany {
        /// The key.
        at: Box<Location>,
        /// Entries found.
        found: usize,
        /// What they are.
        what: &'static str,
        /// The limit.
        most: usize,
        /// The way out.
        remedy: &'static str,
    },
    /// Files of records that are too large together.
    #[error(
        "{at}: the {files} files of records have {found} bytes together, and at most {most} are taken: put some of the places \
         into a test of their own"
    )]
    TooLarge {
        /// The test file.
        at: Box<Location>,
        /// Files, each once.
        files: usize,
        /// Their bytes.
        found: u64,
        /// The limit.
        most: u64,
    },
    /// A size or place that the model refuses.
    #[error("{at}: {source}")]
    Model {
        /// The key.
        at: Box<Location>,
        /// What the model says.
        source: ModelError,
    },
    /// A file whose content no reader knows.
    #[error("{at}: not a file of records; read are: {names}")]
    UnknownFormat {
        /// The file.
        at: Box<Location>,
        /// The formats that are read.
        names: String,
    },
    /// A file of another format, which Python brings into columns.
    #[error(
        "{at}: {format}, which is not read; Python makes columns of it (t, force and acc are in s, N and m/s2; give its own names):\
         \n    {}\n    {}", .python[0], .python[1]
    )]
    ForeignFormat {
        /// The file.
        at: Box<Location>,
        /// What it is.
        format: &'static str,
        /// Two lines of Python that convert it.
        python: [String; 2],
    },
    /// A header of a record that cannot be understood.
    #[error("{at}: {problem}")]
    Header {
        /// Where.
        at: Box<Location>,
        /// What stands there and what was expected.
        problem: String,
    },
    /// Text where a number must stand.
    #[error("{at}: {text:?} is no number")]
    BadNumber {
        /// Where.
        at: Box<Location>,
        /// The text, its first 40 characters.
        text: String,
    },
    /// A record with a value that is not a number, infinite, or 1e30 and more.
    #[error("{at}: point {point} is not a finite number below 1e30: take the record out, or export it again")]
    NotFinite {
        /// Start of the data, or the line.
        at: Box<Location>,
        /// The point, from 1.
        point: usize,
    },
    /// Data that end before the announced count.
    #[error("{at}: {needed} {unit} announced, the data end after {found}: the file is cut off")]
    Truncated {
        /// Where the data end.
        at: Box<Location>,
        /// `values` or `bytes`.
        unit: &'static str,
        /// Number announced.
        needed: usize,
        /// Number found.
        found: usize,
    },
    /// Data that go on after the announced count, with something other than zeros.
    #[error("{at}: {needed} {unit} announced, {found} are there: the count or the data are corrupt")]
    Surplus {
        /// Where the data should have ended.
        at: Box<Location>,
        /// `values` or `bytes`.
        unit: &'static str,
        /// Number announced.
        needed: usize,
        /// Number found.
        found: usize,
    },
    /// An array in memory whose shape does not fit that of the others.
    #[error("{at}: {found} {what}, where the others have {needed}: arrays of one measurement are of one shape")]
    Shape {
        /// The array.
        at: Box<Location>,
        /// Number found.
        found: usize,
        /// `hits`, `samples` or `lines`.
        what: &'static str,
        /// Number that the others have.
        needed: usize,
    },
    /// A file without what it is read for.
    #[error("{at}: no {what} in it")]
    NoRecords {
        /// The file.
        at: Box<Location>,
        /// What was looked for.
        what: &'static str,
    },
    /// Records that do not make up the channels of a measurement.
    #[error("{at}: {problem}")]
    Channels {
        /// The record.
        at: Box<Location>,
        /// What does not fit, and the way out.
        problem: String,
    },
    /// No hit of a measurement can be used.
    #[error("{}: no hit can be used: {reasons}", file.display())]
    NoUsableHit {
        /// The file of the hits.
        file: PathBuf,
        /// Each hit with its faults.
        reasons: String,
    },
}

impl DataError {
    /// Where it is wrong; `None` where a file has more than one fault.
    pub fn location(&self) -> Option<&Location> {
        match self {
            Self::EffectOwner { at, .. }
            | Self::Unreadable { at, .. }
            | Self::Syntax { at, .. }
            | Self::Missing { at, .. }
            | Self::Contradiction { at, .. }
            | Self::OutOfRange { at, .. }
            | Self::UnknownName { at, .. }
            | Self::Duplicate { at, .. }
            | Self::Order { at, .. }
            | Self::Count { at, .. }
            | Self::TooMany { at, .. }
            | Self::TooLarge { at, .. }
            | Self::Model { at, .. }
            | Self::UnknownFormat { at, .. }
            | Self::ForeignFormat { at, .. }
            | Self::Header { at, .. }
            | Self::BadNumber { at, .. }
            | Self::NotFinite { at, .. }
            | Self::Truncated { at, .. }
            | Self::Surplus { at, .. }
            | Self::Shape { at, .. }
            | Self::NoRecords { at, .. }
            | Self::Channels { at, .. } => Some(at),
            Self::NoUsableHit { .. } => None,
        }
    }
}

/// Enough of a text to know it by: what stands in a file may be a megabyte long.
pub(crate) fn short(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

/// Characters of a text that are shown.
const SHOWN: usize = 80;

/// So many texts that a person reads them, and how many more there are.
pub(crate) fn some_of(texts: &[String], between: &str) -> String {
    let told = texts.get(..LISTED.min(texts.len())).unwrap_or_default().join(between);
    match texts.len().saturating_sub(LISTED) {
        0 => told,
        more => format!("{told}{between}and {more} more"),
    }
}

/// Texts of a list that are told.
const LISTED: usize = 20;
