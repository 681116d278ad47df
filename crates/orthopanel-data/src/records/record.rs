//! What every reader returns.

use std::sync::Arc;

use num_complex::Complex64;

use crate::{Location, Position, Unit, units::Measured};

/// The records of one file, and what the reader had to say about them.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFile {
    /// The records, in the order of the file; at least one.
    pub records: Vec<Record>,
    /// What was skipped, mended or assumed, a sentence each.
    pub notes: Vec<String>,
    /// Places of the file's nodes, where it tells them.
    pub(crate) nodes: Vec<Node>,
}

/// A node of a universal file, as dataset 15 or 2411 places it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Node {
    /// Its number.
    pub(crate) number: i64,
    /// Its coordinates \[m\].
    pub(crate) at: [f64; 3],
}

/// One record: a function of time or frequency.
///
/// Every number in it is finite, and `abscissa` and `ordinate` are equally long and not empty. `abscissa` rises, but for listed times,
/// which stand as the file has them: they may be rounded until neighbours are the same.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Number among the file's records, from 1.
    pub number: usize,
    /// What the function is.
    pub kind: RecordKind,
    /// The file's words on it, without blank lines.
    pub title: String,
    /// Where the record begins.
    pub at: Box<Location>,
    /// Line of each point, where the file has one for each.
    pub(super) lines: Option<Arc<[usize]>>,
    /// Where and in which direction the ordinate was measured.
    pub response: Port,
    /// Where and in which direction the reference acts, for functions of two channels.
    pub reference: Port,
    /// Time \[s\] or frequency \[Hz\]; records of one file that stand at the same times share it.
    pub abscissa: Arc<[f64]>,
    /// Values, in the units of `numerator` over `denominator`.
    pub ordinate: Samples,
    /// What is measured along the ordinate.
    pub numerator: Axis,
    /// What the ordinate is divided by, for functions of two channels.
    pub denominator: Axis,
}

impl Record {
    /// Where a point of the record stands, from 0: its line, or where the record begins.
    pub(crate) fn at_point(&self, point: usize) -> Box<Location> {
        let line = self.lines.as_ref().and_then(|lines| lines.get(point));
        let position = line.map_or(self.at.position, |&line| Position::Line(line));
        Box::new(Location { position, ..(*self.at).clone() })
    }
}

/// What a record's function is; numbers as in universal file dataset 58, record 6, field 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordKind {
    /// Time response (1).
    Time,
    /// Auto spectrum (2).
    AutoSpectrum,
    /// Cross spectrum (3).
    CrossSpectrum,
    /// Frequency response function (4), $e^{+j\omega t}$.
    FrequencyResponse,
    /// Coherence (6).
    Coherence,
    /// Variance $E|\hat H - H|^2$ of a frequency response; universal files have no number for it.
    Variance,
    /// Decay rate $\sigma$ \[1/s\] of $s = \sigma + j\omega$ at which a frequency response stands, the same at every line;
    /// universal files have no number for it.
    DecayRate,
    /// Any other number, and 0 for a kind that the file does not tell.
    Other(i64),
}

impl From<i64> for RecordKind {
    fn from(number: i64) -> Self {
        match number {
            1 => Self::Time,
            2 => Self::AutoSpectrum,
            3 => Self::CrossSpectrum,
            4 => Self::FrequencyResponse,
            6 => Self::Coherence,
            other => Self::Other(other),
        }
    }
}

/// Values of a record.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Real values.
    Real(Vec<f64>),
    /// Complex values.
    Complex(Vec<Complex64>),
}

impl Samples {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Complex(values) => values.len(),
        }
    }

    /// True where there is none; never so in a [`Record`].
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A measuring point and the direction of its sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Port {
    /// Number of the point; 0 where the file does not tell.
    pub node: i64,
    /// Direction: 1, 2, 3 along x, y, z, negative against them; 0 where the file does not tell.
    pub direction: i64,
}

/// What an axis shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Universal file's specific data type: 12 acceleration, 13 excitation force, 17 time, 18 frequency; 0 unknown.
    pub data_type: i64,
    /// Unit as the file writes it; empty where it does not tell.
    pub unit: String,
    /// The units of the whole file, where it tells them.
    pub(crate) system: Option<Arc<UnitSystem>>,
}

impl Axis {
    /// An axis of a file that tells no units of the whole.
    pub(super) fn new(data_type: i64, unit: &str) -> Self {
        Self { data_type, unit: unit.into(), system: None }
    }

    /// The unit that the file as a whole gives what is measured along the axis.
    pub(crate) fn unit_by_system(&self, measured: Measured) -> Option<Unit> {
        let UnitSystem { name, length, force } = self.system.as_deref()?;
        match measured {
            Measured::Motion(motion) => {
                let rate = ["/s2", "/s", ""][usize::from(motion.derivatives())];
                Some(Unit::of_motion(format!("{name:?}, a unit of length of {length} m{rate}"), motion, *length))
            }
            Measured::Force => Some(Unit::of_force(format!("{name:?}, a unit of force of {force} N"), *force)),
            _ => None,
        }
    }
}

/// The units of a file, as dataset 164 of a universal file gives them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct UnitSystem {
    /// The file's words for it.
    pub(crate) name: String,
    /// Its unit of length \[m\].
    pub(crate) length: f64,
    /// Its unit of force \[N\].
    pub(crate) force: f64,
}

/// Specific data types of universal files.
pub(crate) mod data_type {
    /// Of a displacement.
    pub(crate) const DISPLACEMENT: i64 = 8;
    /// Of a reaction force; analysers give it to hammers too.
    pub(crate) const REACTION_FORCE: i64 = 9;
    /// Of a velocity.
    pub(crate) const VELOCITY: i64 = 11;
    /// Of an acceleration.
    pub(crate) const ACCELERATION: i64 = 12;
    /// Of an excitation force.
    pub(crate) const FORCE: i64 = 13;
}
