//! Columns of numbers in a text: of whatever separator, decimals, encoding, names and units; one reader for all.

mod decoding;
mod heading;
mod lvm;
mod meaning;
mod response;
mod separator;
mod table;
mod time_history;

pub(crate) use meaning::stem as without_unit;

use std::path::Path;

use super::RecordFile;
use crate::{DataError, DeclaredColumns, Location, limits};
use heading::Heading;
use meaning::{Column, Meaning};
use separator::Separator;
use table::Table;

/// What is read, for messages.
pub(super) const NAME: &str = "columns of numbers in a text (CSV, LVM and others)";

/// Reads the columns of a text; `None` where the bytes are no text.
pub(super) fn read(
    bytes: &[u8],
    path: &Path,
    declared: Option<&DeclaredColumns>,
) -> Option<Result<RecordFile, DataError>> {
    let (text, encoding) = decoding::text(bytes)?;
    let tables = match lvm::tables(&text) {
        Some(tables) => tables,
        None => vec![table(&text)?],
    };
    Some(of_tables(tables, path, declared, encoding))
}

/// Columns of a text by their names, lengths in m; `None` where the bytes are no text with rows of numbers.
///
/// # Errors
/// As [`read`], where a column is missing or a row is broken.
pub(super) fn columns<const N: usize>(
    bytes: &[u8],
    path: &Path,
    names: [&str; N],
) -> Option<Result<[Vec<f64>; N], DataError>> {
    let (text, _) = decoding::text(bytes)?;
    let table = table(&text)?;
    let of_names = || {
        let mut wanted = Vec::new();
        for name in names {
            let is_it = |column: &Column| meaning::stem(&column.name).eq_ignore_ascii_case(name);
            let Some(place) = table.columns.iter().position(is_it) else {
                let wanted = names.join(",");
                let problem = format!("column {name} is missing among {}: the columns are {wanted}", table.names());
                return Err(table.refused(path, problem));
            };
            wanted.push(place);
        }
        let mut values = table.rows(path, &wanted, false)?.values.into_iter();
        let factors = wanted.iter().map(|&place| meaning::metres(&table.columns[place].unit));
        let factors: Vec<f64> = factors.collect();
        let mut columns = [(); N].map(|()| values.next().unwrap_or_default());
        for (column, factor) in columns.iter_mut().zip(factors) {
            column.iter_mut().for_each(|value| *value *= factor);
        }
        Ok(columns)
    };
    Some(of_names())
}

/// The table of a text that holds one; `None` where it holds none.
fn table(text: &str) -> Option<Table<'_>> {
    let is_abscissa = |name: &str| Column::of(name, "").meaning.is_abscissa();
    let Heading { separator, columns: count, names, units, names_at, rows_at: (start, first_line) } =
        Heading::of(text, is_abscissa)?;
    let text_of = |texts: &[String], column: usize| texts.get(column).cloned().unwrap_or_default();
    let mut columns: Vec<Column> =
        (0..count).map(|column| Column::of(&text_of(&names, column), &text_of(&units, column))).collect();
    let is_named = !names.is_empty();
    if !is_named {
        columns.iter_mut().zip(1..).for_each(|(column, number)| column.name = format!("column {number}"));
    }
    Some(Table {
        text: text.get(start..)?,
        first_line,
        separator,
        columns,
        is_named,
        names_at,
        is_part: false,
        even: None,
    })
}

fn of_tables(
    tables: Vec<Table>,
    path: &Path,
    declared: Option<&DeclaredColumns>,
    encoding: Option<&'static str>,
) -> Result<RecordFile, DataError> {
    let mut file = RecordFile { records: Vec::new(), notes: Vec::new(), nodes: Vec::new() };
    for table in tables {
        let table = table.declared(path, declared)?;
        if !(is_own(&table) && encoding.is_none()) && file.records.is_empty() {
            file.notes.push(assumed(&table, encoding));
        }
        let of_frequency = table.abscissa().is_some_and(|place| table.columns[place].meaning == Meaning::Frequency);
        let records = if of_frequency {
            response::records(&table, path, &mut file.notes)?
        } else {
            time_history::records(&table, path, &mut file.notes)?
        };
        for mut record in records {
            record.number = file.records.len() + 1;
            file.records.push(record);
        }
        if file.records.len() > limits::RECORDS {
            let (at, found, most) = (Location::whole(path), file.records.len(), limits::RECORDS);
            return Err(DataError::TooMany { at, found, what: "records", most, remedy: "split the file" });
        }
    }
    if file.records.is_empty() {
        return Err(DataError::NoRecords { at: Location::whole(path), what: "row of numbers" });
    }
    Ok(file)
}

/// Names that tell all there is to tell.
const OWN: [&str; 10] = [
    "time_s",
    "force_n",
    "acceleration_m_s2",
    "acceleration_g",
    "frequency_hz",
    "real",
    "imag",
    "coherence",
    "variance",
    "decay_rate_1_s",
];

fn is_own(table: &Table) -> bool {
    table.separator == Separator::Comma && table.columns.iter().all(|column| OWN.contains(&column.name.as_str()))
}

/// What was assumed of a text, in one line.
fn assumed(table: &Table, encoding: Option<&str>) -> String {
    let columns = table.columns.iter().filter(|column| column.meaning != Meaning::NotRead).map(|column| {
        let (name, unit) = (crate::error::short(&column.name), &column.unit);
        let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
        format!("{name:?}{}{unit}", column.meaning.told())
    });
    let columns = crate::error::some_of(&columns.collect::<Vec<_>>(), ", ");
    let encoding = encoding.map_or(String::new(), |encoding| format!(" in {encoding}"));
    let times = if table.even.is_some() && !table.is_part { ", rows counted in place of times" } else { "" };
    let by = table.separator.name();
    format!("columns divided by {by}{encoding}, from line {}: {columns}{times}", table.first_line)
}
