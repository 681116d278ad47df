//! Files of records, of whatever format, as plain numbers with their axes.

mod csv_accelerance;
mod csv_columns;
mod csv_time_history;
mod record;
mod step;
mod uff;

use std::path::Path;

use crate::{DataError, Location, limits};
pub use record::{Axis, Port, Record, RecordFile, RecordKind, Samples};
pub(crate) use record::{Node, UnitSystem, data_type};
pub(crate) use step::round_rate;

/// One file format: how its bytes are known, and how they are read.
struct Format {
    name: &'static str,
    recognises: fn(&[u8]) -> bool,
    read: fn(&[u8], &Path) -> Result<RecordFile, DataError>,
}

/// The formats, one line each. The content decides, not the file's extension: extensions of measured files lie.
const FORMATS: [Format; 3] = [uff::FORMAT, csv_time_history::FORMAT, csv_accelerance::FORMAT];

/// No sensor reads as much, in whatever unit. A spoilt byte in an exponent makes such values, whose squares are no numbers any more.
const NO_READING: f64 = 1e30;

/// Whether a sensor may have read this: a finite number below [`NO_READING`].
fn may_be_read(value: f64) -> bool {
    value.abs() < NO_READING
}

impl RecordFile {
    /// Reads a file of records; its content tells the format.
    ///
    /// # Errors
    /// [`DataError::Unreadable`] where the file cannot be read, or is too large, else as [`RecordFile::from_bytes`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, DataError> {
        let path = path.as_ref();
        let read = limits::RECORD_FILE.read(path);
        let bytes = read.map_err(|source| DataError::Unreadable { at: Location::whole(path), source })?;
        Self::from_bytes(&bytes, path)
    }

    /// Reads the bytes of a file of records; `path` names it in messages.
    ///
    /// # Errors
    /// [`DataError::UnknownFormat`] where no reader knows the content; [`DataError::Header`],
    /// [`DataError::BadNumber`], [`DataError::NotFinite`], [`DataError::Truncated`] and [`DataError::Surplus`] with
    /// byte or line where a reader does, and the content is broken; [`DataError::NoRecords`] where nothing is in it.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self, DataError> {
        let path = path.as_ref();
        match FORMATS.iter().find(|format| (format.recognises)(bytes)) {
            Some(format) => (format.read)(bytes, path),
            None => {
                let names = FORMATS.map(|format| format.name).join("; ");
                Err(DataError::UnknownFormat { at: Location::whole(path), names })
            }
        }
    }
}
