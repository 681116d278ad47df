//! Which column of a text is what, as a test file tells it.

use std::{collections::BTreeMap, fmt};

/// `columns = {time = "Time (s)", force = 2, response = 3}`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub struct DeclaredColumns(pub BTreeMap<ColumnRole, ColumnName>);

/// What a column is declared to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ColumnRole {
    /// Times.
    Time,
    /// Frequencies.
    Frequency,
    /// The force of the hammer.
    Force,
    /// The motion.
    Response,
    /// Real part of a frequency response.
    Real,
    /// Imaginary part of a frequency response.
    Imag,
    /// Magnitude of a frequency response.
    Magnitude,
    /// Phase of a frequency response.
    Phase,
    /// Coherence.
    Coherence,
}

impl ColumnRole {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Time,
        Self::Frequency,
        Self::Force,
        Self::Response,
        Self::Real,
        Self::Imag,
        Self::Magnitude,
        Self::Phase,
        Self::Coherence,
    ];

    /// As in test files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Frequency => "frequency",
            Self::Force => "force",
            Self::Response => "response",
            Self::Real => "real",
            Self::Imag => "imag",
            Self::Magnitude => "magnitude",
            Self::Phase => "phase",
            Self::Coherence => "coherence",
        }
    }
}

/// Which column.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum ColumnName {
    /// By its number, from 1.
    Number(usize),
    /// By its name, as it stands above it.
    Name(String),
}

impl fmt::Display for ColumnName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "{name:?}"),
        }
    }
}
