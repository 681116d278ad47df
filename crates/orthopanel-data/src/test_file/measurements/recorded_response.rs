//! A file of records, the places, and what a test file declares of its channels.

use std::{
    fmt,
    path::{Path, PathBuf},
    sync::Arc,
};

use orthopanel_model::Place;

use crate::{DeclaredColumns, Motion, RecordFile, Unit};

/// A file of records, or records in memory, and where they were taken.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedResponse {
    /// The file, beside the test file unless absolute; of records in memory what messages call them.
    pub file: PathBuf,
    /// The records themselves, where they are in no file.
    pub in_memory: Option<Arc<RecordFile>>,
    /// The file of the motion, where `file` holds the force alone.
    pub response_file: Option<PathBuf>,
    /// The file that placed its nodes, where one did.
    pub places_file: Option<PathBuf>,
    /// Which column of a text is what, where declared.
    pub columns: Option<DeclaredColumns>,
    /// Where the hammer hit.
    pub force_at: Place,
    /// Where the sensor of the motion sat.
    pub response_at: Place,
    /// Unit of the force in the file, where declared; with a sensitivity the unit that it is a volt for.
    pub force_unit: Option<Unit>,
    /// Unit of the motion in the file, where declared; with a sensitivity the unit that it is a volt for.
    pub response_unit: Option<Unit>,
    /// What the sensor of the motion reads, where declared.
    pub quantity: Option<Motion>,
    /// Volts a unit of force, where the channel was recorded in volts.
    pub force_sensitivity: Option<f64>,
    /// Volts a unit of motion, where the channel was recorded in volts.
    pub response_sensitivity: Option<f64>,
    /// Direction of the sensor, where declared.
    pub direction: Option<Direction>,
    /// Number of the frequency response among the file's records, from 1; needed where the file holds several.
    pub record: Option<usize>,
    /// Which of the file's records hold the force, where declared.
    pub force_channel: Option<ChannelName>,
    /// Which of the file's records hold the motion, where declared.
    pub response_channel: Option<ChannelName>,
    /// How continuous records are cut into hits, where declared.
    pub trigger: Option<Trigger>,
    /// Sampling rate \[Hz\], where declared: it counts instead of the file's times.
    pub sampling_rate: Option<f64>,
    /// Unit of the frequencies, where declared: of numbers that no label says to be in another unit than Hz.
    pub frequency_unit: Option<Unit>,
    /// Time constant $\tau$ \[s\] of the exponential window $e^{-t/\tau}$ that lies over the records, where declared.
    pub window_decay: Option<f64>,
    /// Lines \[Hz\] that count, from and to; all where nothing is declared.
    pub band: Option<[f64; 2]>,
}

impl RecordedResponse {
    /// A file of records with nothing declared but the places of force and response.
    pub fn new(file: impl Into<PathBuf>, [force_at, response_at]: [Place; 2]) -> Self {
        Self {
            file: file.into(),
            in_memory: None,
            response_file: None,
            places_file: None,
            columns: None,
            force_at,
            response_at,
            force_unit: None,
            response_unit: None,
            quantity: None,
            force_sensitivity: None,
            response_sensitivity: None,
            direction: None,
            record: None,
            force_channel: None,
            response_channel: None,
            trigger: None,
            sampling_rate: None,
            frequency_unit: None,
            window_decay: None,
            band: None,
        }
    }

    /// The files that it takes, that of the force first; none of records in memory.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let others = self.response_file.as_deref().into_iter().chain(self.places_file.as_deref());
        let own = self.in_memory.is_none().then_some(self.file.as_path());
        own.into_iter().chain(others)
    }
}

/// How a continuous record of several blows is cut into hits; what is left out is found from the record.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Trigger {
    /// Force over its rest \[N\] that a blow passes.
    pub level: Option<f64>,
    /// Time of a hit before its blow passes the level \[s\].
    pub before: Option<f64>,
    /// Time of a hit in all \[s\].
    pub length: Option<f64>,
}

/// A channel of a file with several.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChannelName {
    /// That of a record, by its number in the file, from 1.
    Number(usize),
    /// `"12"` or `"12:+z"`: a node, and 1, 2, 3 along x, y, z, negative against them, 0 in any direction.
    Port {
        /// The node's number.
        node: i64,
        /// The direction.
        direction: i64,
    },
    /// A line of the record's title.
    Name(String),
}

impl ChannelName {
    /// Of a text in a test file.
    pub(super) fn of(text: &str) -> Self {
        let (node, along) = text.split_once(':').unwrap_or((text, ""));
        let (sign, axis) = match along.trim().strip_prefix('-') {
            Some(axis) => (-1, axis),
            None => (1, along.trim().trim_start_matches('+')),
        };
        let direction = ["", "x", "y", "z"].iter().zip(0..).find(|(name, _)| axis.eq_ignore_ascii_case(name));
        match (node.trim().parse(), direction) {
            (Ok(node), Some((_, direction))) => Self::Port { node, direction: sign * direction },
            _ => Self::Name(text.trim().to_owned()),
        }
    }
}

impl fmt::Display for ChannelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Port { node, direction } => {
                let sign = if *direction < 0 { "-" } else { "+" };
                match direction.abs() {
                    1 => write!(f, "\"{node}:{sign}x\""),
                    2 => write!(f, "\"{node}:{sign}y\""),
                    3 => write!(f, "\"{node}:{sign}z\""),
                    _ => write!(f, "\"{node}\""),
                }
            }
            Self::Name(name) => write!(f, "{name:?}"),
        }
    }
}

/// Which way a recorded acceleration counts positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// `direction = 1`: as the force.
    AlongForce,
    /// `direction = -1`: against the force, so the record is turned round.
    AgainstForce,
}
