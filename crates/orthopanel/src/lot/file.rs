//! A lot's table at its place.

use std::path::Path;

use super::TableError;
use super::{Format, LotRow, read, written};
use crate::outputs::{Inputs, Outputs};
use crate::{Error, Silent};

fn of(path: &Path) -> impl FnOnce(TableError) -> Error {
    let path = path.to_owned();
    |source| Error::Lot { path, source }
}

/// The rows of the table at `path`; of a folder, as a campaign of the Python package leaves one, those of every `.parquet` file in it, in the
/// order of their names.
///
/// # Errors
/// [`Error::Unreadable`], and [`Error::Lot`] for what is none.
pub fn load(path: &Path) -> Result<Vec<LotRow>, Error> {
    if path.is_dir() {
        let unreadable = |source| Error::Unreadable { path: path.into(), source };
        let entries = std::fs::read_dir(path).map_err(unreadable)?;
        let mut files = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
        files.retain(|file| file.extension().is_some_and(|ending| ending == "parquet"));
        files.sort();
        let rows = files.iter().map(|file| load(file)).collect::<Result<Vec<_>, _>>()?;
        return Ok(rows.concat());
    }
    let format = Format::of(path).map_err(of(path))?;
    let content = std::fs::read(path).map_err(|source| Error::Unreadable { path: path.into(), source })?;
    read(content, format).map_err(of(path))
}

/// As [`load`]; nothing where there is no file yet.
///
/// # Errors
/// As [`load`].
pub fn known(path: &Path) -> Result<Vec<LotRow>, Error> {
    Format::of(path).map_err(of(path))?;
    if path.exists() { load(path) } else { Ok(vec![]) }
}

/// What is to stand in the file at `path`.
///
/// # Errors
/// [`Error::Lot`].
pub fn content(path: &Path, rows: &[LotRow]) -> Result<Vec<u8>, Error> {
    Format::of(path).and_then(|format| written(rows, format)).map_err(of(path))
}

/// Puts the table at `path`, in place of an earlier one at once.
///
/// # Errors
/// As [`content`], and [`Error::Unwritable`].
pub fn save(path: &Path, rows: &[LotRow]) -> Result<(), Error> {
    let mut outputs = Outputs::of(Inputs::default());
    outputs.add(path, content(path, rows)?);
    outputs.write(&Silent).map(|_| ())
}
