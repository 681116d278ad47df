//! `kind = "time-history"` and `"accelerance"`: a file of records, the places, and the sensor's unit and direction.

use std::{fmt, io, path::PathBuf};

use orthopanel_model::{Piece, Place};

use super::{super::syntax, Entry};
use crate::{DataError, limits, regular_file};

/// A file of records and where they were taken.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedResponse {
    /// The file, beside the test file unless absolute.
    pub file: PathBuf,
    /// Where the hammer hit.
    pub force_at: Place,
    /// Where the accelerometer sat.
    pub response_at: Place,
    /// Unit of the acceleration in the file, where declared.
    pub unit: Option<AccelerationUnit>,
    /// Direction of the sensor, where declared.
    pub direction: Option<Direction>,
    /// Number of the frequency response among the file's records, from 1; needed where the file holds several.
    pub record: Option<usize>,
}

/// Unit of a recorded acceleration, or of the acceleration in an accelerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccelerationUnit {
    /// `"m/s2"`.
    MetrePerSecondSquared,
    /// `"g"`.
    StandardGravity,
}

/// Which way a recorded acceleration counts positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// `direction = 1`: as the force.
    AlongForce,
    /// `direction = -1`: against the force, so the record is turned round.
    AgainstForce,
}

impl fmt::Display for AccelerationUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::MetrePerSecondSquared => "m/s2",
            Self::StandardGravity => "g",
        })
    }
}

impl AccelerationUnit {
    /// Factor to m/s²: $1$, or $g_n = 9.80665$ (3rd CGPM, 1901, exact).
    pub fn to_si(self) -> f64 {
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::StandardGravity => 9.806_65,
        }
    }
}

impl Entry<'_> {
    pub(super) fn recorded(&self, entry: &syntax::Measurement, piece: &Piece) -> Result<RecordedResponse, DataError> {
        let name = self.needed(entry.file.as_ref(), "file", "name a .uff or .csv file beside the test file")?;
        let places = [(&entry.force_at, "force_at"), (&entry.response_at, "response_at")].map(|(place, key)| {
            let place = self.needed(place.as_ref(), key, "give the place [x, y] in m from the piece's centre")?;
            self.place(place, key, piece)
        });
        let [force_at, response_at] = places;
        let (force_at, response_at) = (force_at?, response_at?);
        let unit = match entry.unit.as_ref().map(|unit| (unit.get_ref().as_str(), unit)) {
            None => None,
            Some(("m/s2", _)) => Some(AccelerationUnit::MetrePerSecondSquared),
            Some(("g", _)) => Some(AccelerationUnit::StandardGravity),
            Some((other, unit)) => {
                let (name, remedy) = (other.to_owned(), "must be \"m/s2\" or \"g\"".into());
                return Err(DataError::UnknownName { at: self.at(unit.span(), "unit"), name, remedy });
            }
        };
        let direction = match entry.direction.as_ref().map(|direction| (*direction.get_ref(), direction)) {
            None => None,
            Some((1.0, _)) => Some(Direction::AlongForce),
            Some((-1.0, _)) => Some(Direction::AgainstForce),
            Some((value, direction)) => {
                let range = "must be 1 (sensor along the force) or -1 (turned round)".into();
                return Err(DataError::OutOfRange { at: self.at(direction.span(), "direction"), value, range });
            }
        };
        let record = match entry.record.as_ref().map(|record| (usize::try_from(*record.get_ref()), record)) {
            None => None,
            Some((Ok(number), _)) if number > 0 => Some(number),
            Some((_, record)) => {
                let (at, value) = (self.at(record.span(), "record"), f64::from(*record.get_ref()));
                return Err(DataError::OutOfRange { at, value, range: "records are counted from 1".into() });
            }
        };
        let file = self.source.beside(name.get_ref());
        // Asked now, so that the line is known which names a file that is not there, or is none.
        let found = regular_file(&file).and_then(|found| limits::RECORD_FILE.check(&found));
        found.map_err(|error| DataError::Unreadable {
            at: self.at(name.span(), "file"),
            source: io::Error::new(error.kind(), format!("{}: {error}", file.display())),
        })?;
        Ok(RecordedResponse { file, force_at, response_at, unit, direction, record })
    }
}
