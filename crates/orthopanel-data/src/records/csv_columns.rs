//! Columns of numbers under a line of names: what both CSV formats share.

use std::{path::Path, sync::Arc};

use orthopanel_model::Readable;

use super::may_be_read;
use crate::{DataError, Location, Position};

/// True where the first line that is no comment begins with the column `name`.
pub(super) fn starts_with_column(bytes: &[u8], name: &str) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let header = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    let first = header.and_then(|line| line.split(|byte| b",;\t ".contains(byte)).next());
    first.is_some_and(|first| first.trim_ascii() == name.as_bytes())
}

/// True where the first line that is no comment names the column `name`.
pub(super) fn has_column(bytes: &[u8], name: &str) -> bool {
    let lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let header = lines.into_iter().find(|line| !line.is_empty() && !line.starts_with(b"#"));
    header.is_some_and(|line| line.split(|&byte| byte == b',').any(|found| found.trim_ascii() == name.as_bytes()))
}

/// Columns of a file, and where they stand in it.
pub(super) struct Columns {
    /// In the order asked for; `None` for an optional one that is not there.
    pub(super) values: Vec<Option<Vec<f64>>>,
    /// Line of the names.
    pub(super) names_at: Position,
    /// Line of each row.
    pub(super) lines: Arc<[usize]>,
}

/// Reads the columns `needed`, and `optional` where they are there, in this order; each is as long as the first.
///
/// The first column must rise where it is a frequency; times may be rounded, and are judged with the sampling rate in view.
pub(super) fn read(bytes: &[u8], path: &Path, needed: &[&str], optional: &[&str]) -> Result<Columns, DataError> {
    let rises = needed.first() == Some(&"frequency_hz");
    let at = |line: u64, key: &str| {
        Box::new(Location { file: path.to_path_buf(), position: position(line), key: key.into() })
    };
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(bytes);
    let broken = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        let problem = match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                format!("{len} values where the first line names {expected_len} columns")
            }
            csv::ErrorKind::Utf8 { .. } => "not UTF-8 text: save the file as UTF-8".into(),
            _ => error.to_string(),
        };
        DataError::Header { at: at(line, ""), problem }
    };
    let names = reader.headers().map_err(broken)?.clone();
    let expected = || [needed, optional].concat().join(",");
    let names_line = names.position().map_or(1, csv::Position::line);
    let header = |problem: String| Err(DataError::Header { at: at(names_line, ""), problem });
    if let Some(missing) = needed.iter().find(|&&name| !names.iter().any(|found| found == name)) {
        return header(format!("column {missing} is missing: the columns are {}, divided by commas", expected()));
    }
    let place_of = |name: &str| [needed, optional].concat().iter().position(|&known| known == name);
    let mut places = Vec::new();
    for name in &names {
        match place_of(name) {
            Some(place) if !places.contains(&place) => places.push(place),
            Some(_) => return header(format!("column {name} stands twice")),
            None => return header(format!("column {name:?} is unknown: the columns are {}", expected())),
        }
    }
    let mut columns: Vec<Option<Vec<f64>>> = vec![None; needed.len() + optional.len()];
    let mut row = csv::StringRecord::new();
    let mut lines = Vec::new();
    while reader.read_record(&mut row).map_err(broken)? {
        let line = row.position().map_or(1, csv::Position::line);
        lines.push(usize::try_from(line).unwrap_or(usize::MAX));
        for ((text, name), &place) in row.iter().zip(&names).zip(&places) {
            let value: f64 = text.parse().map_err(|_| {
                let text = text.chars().take(40).collect();
                DataError::BadNumber { at: at(line, name), text }
            })?;
            if !may_be_read(value) {
                return Err(DataError::NotFinite { at: at(line, name), point: lines.len() });
            }
            let Some(column) = columns.get_mut(place) else { continue };
            let column = column.get_or_insert_with(Vec::new);
            if rises && place == 0 && column.last().is_some_and(|&before| before >= value) {
                let problem =
                    format!("{} does not rise above the row before: sort the rows, once each", Readable(value));
                return Err(DataError::Header { at: at(line, name), problem });
            }
            column.push(value);
        }
    }
    if lines.is_empty() {
        return Err(DataError::NoRecords { at: at(names_line, ""), what: "row under the column names" });
    }
    Ok(Columns { values: columns, names_at: position(names_line), lines: lines.into() })
}

fn position(line: u64) -> Position {
    usize::try_from(line).map_or(Position::Whole, Position::Line)
}
