//! Files of records, of whatever format, as plain numbers with their axes.

mod abscissa;
mod arrays;
mod blows;
mod declared_columns;
mod foreign;
mod nodes;
mod quantity;
mod reading;
mod record;
mod step;
mod text;
mod uff;

use std::path::Path;

use crate::{DataError, Location, limits};
pub(crate) use arrays::name as arrays_name;
pub(crate) use blows::{blows, is_force};
pub use declared_columns::{ColumnName, ColumnRole, DeclaredColumns};
use foreign::Foreign;
pub(crate) use nodes::nodes_of;
pub(crate) use quantity::{Quantity, quantity, type_name};
pub use record::{Axis, Port, Record, RecordFile, RecordKind, Samples};
pub(crate) use record::{Node, UnitSystem, data_type};
pub(crate) use step::round_rate;
pub(crate) use text::without_unit;

impl RecordFile {
    /// Reads a file of records; its content tells the format.
    ///
    /// # Errors
    /// [`DataError::Unreadable`] where the file cannot be read, or is too large, else as [`RecordFile::from_bytes`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, DataError> {
        Self::read_columns(path, None)
    }

    /// As [`RecordFile::read`]; in a text the `columns` are those declared, where any are.
    ///
    /// # Errors
    /// As [`RecordFile::read`].
    pub fn read_columns(path: impl AsRef<Path>, columns: Option<&DeclaredColumns>) -> Result<Self, DataError> {
        let path = path.as_ref();
        let read = limits::RECORD_FILE.read(path);
        let bytes = read.map_err(|source| DataError::Unreadable { at: Location::whole(path), source })?;
        Self::columns_of_bytes(&bytes, path, columns)
    }

    /// Reads the bytes of a file of records; `path` names it in messages.
    ///
    /// # Errors
    /// [`DataError::ForeignFormat`] and [`DataError::UnknownFormat`] where no reader knows the content; [`DataError::Header`],
    /// [`DataError::BadNumber`], [`DataError::NotFinite`], [`DataError::Truncated`] and [`DataError::Surplus`] with
    /// byte or line where a reader does, and the content is broken; [`DataError::NoRecords`] where nothing is in it.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self, DataError> {
        Self::columns_of_bytes(bytes, path.as_ref(), None)
    }

    /// The content decides, not the file's extension: extensions of measured files lie.
    fn columns_of_bytes(bytes: &[u8], path: &Path, columns: Option<&DeclaredColumns>) -> Result<Self, DataError> {
        if uff::recognises(bytes) {
            if columns.is_some() {
                let problem = "a universal file has no columns: take columns out of its [[measurement]]".into();
                return Err(DataError::Header { at: Location::whole(path), problem });
            }
            return uff::read(bytes, path);
        }
        if let Some(foreign) = Foreign::of(bytes) {
            let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            let python = foreign.python(&file);
            return Err(DataError::ForeignFormat { at: Location::whole(path), format: foreign.name, python });
        }
        text::read(bytes, path, columns).unwrap_or_else(|| {
            let names = format!("{}; {}", uff::NAME, text::NAME);
            Err(DataError::UnknownFormat { at: Location::whole(path), names })
        })
    }
}
