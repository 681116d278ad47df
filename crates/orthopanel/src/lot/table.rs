//! A lot's table in a file: CSV, or Parquet for whoever reads it with pandas, Dask or DuckDB.
//!
//! Columns: `panel`, `test`, `sha256`, `version`, `failed`, `structure`, `verdict`, `effects`, `notes`, `error_percent`,
//! `left_out_error_percent`; then of each constant that a panel of the lot has its value, `NAME_std`, and `corr:NAME:OTHER` of each two. Empty (null) where
//! a panel has none.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use orthopanel_model::{BEAM_CONSTANTS, Estimate, PLATE_CONSTANTS};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;

use super::{LotRow, TableError};

/// How a table lies in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values with a heading.
    Csv,
    /// Apache Parquet, one row group, not compressed.
    Parquet,
}

impl Format {
    /// By a file's ending.
    ///
    /// # Errors
    /// [`TableError::Ending`].
    pub fn of(path: &Path) -> Result<Self, TableError> {
        match path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("parquet") => Ok(Self::Parquet),
            _ => Err(TableError::Ending),
        }
    }
}

/// What stands in one place of a table.
#[derive(Debug, Clone, PartialEq)]
enum Cell {
    Text(Option<String>),
    Number(Option<f64>),
}

const STD: &str = "_std";
const CORRELATION: &str = "corr:";

/// Names of columns and their cells, a column at a time.
fn columns(rows: &[LotRow]) -> Vec<(String, Vec<Cell>)> {
    let text = |name: &str, of: &dyn Fn(&LotRow) -> Option<String>| {
        (name.to_owned(), rows.iter().map(|row| Cell::Text(of(row))).collect::<Vec<_>>())
    };
    let number = |name: String, of: &dyn Fn(&LotRow) -> Option<f64>| {
        (name, rows.iter().map(|row| Cell::Number(of(row))).collect::<Vec<_>>())
    };
    let mut columns = vec![
        text("panel", &|row| Some(row.panel.clone())),
        text("test", &|row| Some(row.test.clone())),
        text("sha256", &|row| Some(row.sha256.clone())),
        text("version", &|row| Some(row.version.clone())),
        text("failed", &|row| row.failed.clone()),
        text("structure", &|row| row.structure.clone()),
        text("verdict", &|row| row.verdict.clone()),
        text("effects", &|row| row.effects.clone()),
        text("notes", &|row| row.notes.clone()),
        number("error_percent".to_owned(), &|row| row.error_percent),
        number("left_out_error_percent".to_owned(), &|row| row.left_out_error_percent),
    ];
    let constants: BTreeSet<&String> = rows.iter().flat_map(|row| row.constants.keys()).collect();
    for name in constants {
        columns.push(number(name.clone(), &|row| row.constants.get(name).map(|of| of.value)));
        columns.push(number(format!("{name}{STD}"), &|row| row.constants.get(name).and_then(|of| of.std)));
    }
    let pairs: BTreeSet<&(String, String)> = rows.iter().flat_map(|row| row.correlations.keys()).collect();
    for pair in pairs {
        let name = format!("{CORRELATION}{}:{}", pair.0, pair.1);
        columns.push(number(name, &|row| row.correlations.get(pair).copied()));
    }
    columns
}

/// The rows as a file's content.
///
/// # Errors
/// [`TableError::Broken`] where a library refuses them.
pub fn written(rows: &[LotRow], format: Format) -> Result<Vec<u8>, TableError> {
    let columns = columns(rows);
    match format {
        Format::Csv => as_csv(&columns, rows.len()).map_err(broken),
        Format::Parquet => as_parquet(&columns).map_err(broken),
    }
}

/// The rows of a file's content.
///
/// # Errors
/// [`TableError::Broken`].
pub fn read(content: Vec<u8>, format: Format) -> Result<Vec<LotRow>, TableError> {
    let rows = match format {
        Format::Csv => of_csv(&content).map_err(broken)?,
        Format::Parquet => of_parquet(content).map_err(broken)?,
    };
    rows.into_iter().map(row).collect()
}

fn broken(problem: impl std::fmt::Display) -> TableError {
    TableError::Broken { problem: problem.to_string() }
}

fn as_csv(columns: &[(String, Vec<Cell>)], rows: usize) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|(name, _)| name))?;
    for row in 0..rows {
        let cell = |(_, cells): &(String, Vec<Cell>)| match &cells[row] {
            Cell::Text(text) => text.clone().unwrap_or_default(),
            // The shortest digits that are read back to the same number.
            Cell::Number(number) => number.map(|number| number.to_string()).unwrap_or_default(),
        };
        writer.write_record(columns.iter().map(cell))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

fn of_csv(content: &[u8]) -> Result<Vec<BTreeMap<String, Cell>>, csv::Error> {
    let mut reader = csv::Reader::from_reader(content);
    let names = reader.headers()?.clone();
    let row = |record: Result<csv::StringRecord, csv::Error>| {
        let record = record?;
        let cell = |(name, text): (&str, &str)| {
            let cell = if is_number(name) {
                Cell::Number(text.parse().ok())
            } else {
                Cell::Text((!text.is_empty()).then(|| text.to_owned()))
            };
            (name.to_owned(), cell)
        };
        Ok(names.iter().zip(&record).map(cell).collect())
    };
    reader.records().map(row).collect()
}

fn as_parquet(columns: &[(String, Vec<Cell>)]) -> Result<Vec<u8>, parquet::errors::ParquetError> {
    let of_column = |(name, _): &(String, Vec<Cell>)| {
        if is_number(name) { format!("OPTIONAL DOUBLE {name};") } else { format!("OPTIONAL BYTE_ARRAY {name} (UTF8);") }
    };
    let schema = format!("message lot {{ {} }}", columns.iter().map(of_column).collect::<String>());
    let properties = Arc::new(WriterProperties::builder().build());
    let mut content = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut content, Arc::new(parse_message_type(&schema)?), properties)?;
    let mut group = writer.next_row_group()?;
    for (_, cells) in columns {
        let Some(mut column) = group.next_column()? else { break };
        let is_there = |cell: &Cell| matches!(cell, Cell::Text(Some(_)) | Cell::Number(Some(_)));
        let levels: Vec<i16> = cells.iter().map(|cell| i16::from(is_there(cell))).collect();
        match column.untyped() {
            ColumnWriter::DoubleColumnWriter(writer) => {
                let of = |cell: &Cell| if let Cell::Number(number) = cell { *number } else { None };
                writer.write_batch(&cells.iter().filter_map(of).collect::<Vec<f64>>(), Some(&levels), None)?;
            }
            ColumnWriter::ByteArrayColumnWriter(writer) => {
                let of = |cell: &Cell| {
                    if let Cell::Text(Some(text)) = cell { Some(ByteArray::from(text.as_str())) } else { None }
                };
                writer.write_batch(&cells.iter().filter_map(of).collect::<Vec<_>>(), Some(&levels), None)?;
            }
            _ => {}
        }
        column.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(content)
}

fn of_parquet(content: Vec<u8>) -> Result<Vec<BTreeMap<String, Cell>>, parquet::errors::ParquetError> {
    let reader = SerializedFileReader::new(bytes::Bytes::from(content))?;
    let mut rows = Vec::new();
    for row in reader.get_row_iter(None)? {
        let cell = |(name, field): (&String, &Field)| {
            let cell = match field {
                Field::Str(text) => Cell::Text(Some(text.clone())),
                Field::Double(number) => Cell::Number(Some(*number)),
                _ if is_number(name) => Cell::Number(None),
                _ => Cell::Text(None),
            };
            (name.clone(), cell)
        };
        rows.push(row?.get_column_iter().map(cell).collect());
    }
    Ok(rows)
}

/// Whether a column holds numbers.
fn is_number(name: &str) -> bool {
    let constants = || BEAM_CONSTANTS.iter().chain(PLATE_CONSTANTS.iter()).map(|constant| constant.name);
    name.ends_with("_percent")
        || name.starts_with(CORRELATION)
        || constants().any(|known| known == name.strip_suffix(STD).unwrap_or(name))
}

fn row(mut cells: BTreeMap<String, Cell>) -> Result<LotRow, TableError> {
    let mut text = |name: &str| match cells.remove(name) {
        Some(Cell::Text(text)) => text,
        _ => None,
    };
    let mut needed = |name: &str| text(name).ok_or_else(|| broken(format!("a row without `{name}`")));
    let (panel, test) = (needed("panel")?, needed("test")?);
    // A test file that cannot be read has no checksum.
    let [sha256, version] = ["sha256", "version"].map(|name| text(name).unwrap_or_default());
    let (failed, structure, verdict) = (text("failed"), text("structure"), text("verdict"));
    let (effects, notes) = (text("effects"), text("notes"));
    let number = |name: &str| match cells.get(name) {
        Some(Cell::Number(number)) => *number,
        _ => None,
    };
    let mut constants = BTreeMap::new();
    let mut correlations = BTreeMap::new();
    for name in cells.keys() {
        if let Some((first, second)) = name.strip_prefix(CORRELATION).and_then(|pair| pair.split_once(':')) {
            correlations.extend(number(name).map(|value| ((first.to_owned(), second.to_owned()), value)));
        } else if is_number(name) && !name.ends_with("_percent") && !name.ends_with(STD) {
            let std = number(&format!("{name}{STD}"));
            constants.extend(number(name).map(|value| (name.clone(), Estimate { value, std })));
        }
    }
    Ok(LotRow {
        panel,
        test,
        sha256,
        version,
        failed,
        structure,
        constants,
        correlations,
        error_percent: number("error_percent"),
        left_out_error_percent: number("left_out_error_percent"),
        verdict,
        effects,
        notes,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<LotRow> {
        let constants = [("e_x", 1.07e10, Some(4.5e7)), ("g_zx", 5.362e8, None)];
        let constants = constants.map(|(name, value, std)| (name.to_owned(), Estimate { value, std }));
        let common = LotRow { sha256: "ab".into(), version: "0.1.0".into(), ..LotRow::default() };
        vec![
            LotRow {
                panel: "strip, \"left\"".into(),
                test: "a/test.toml".into(),
                structure: Some("timoshenko-beam".into()),
                constants: constants.into(),
                correlations: [(("e_x".to_owned(), "g_zx".to_owned()), -0.706)].into(),
                error_percent: Some(0.1 + 0.2),
                verdict: Some("nothing-missing".into()),
                notes: Some("one | two".into()),
                ..common.clone()
            },
            LotRow {
                panel: "b".into(),
                test: "b/test.toml".into(),
                failed: Some("too few\nmodes".into()),
                version: common.version,
                ..LotRow::default()
            },
        ]
    }

    #[test]
    fn a_table_is_read_as_it_was_written() {
        for format in [Format::Csv, Format::Parquet] {
            let content = written(&rows(), format).unwrap();
            assert_eq!(read(content, format).unwrap(), rows(), "{format:?}");
            assert_eq!(read(written(&[], format).unwrap(), format).unwrap(), [], "{format:?}");
        }
    }

    #[test]
    fn what_is_no_lot_is_refused() {
        for format in [Format::Csv, Format::Parquet] {
            let refused = read(b"a,b\n1,2\n".to_vec(), format).unwrap_err().to_string();
            assert!(refused.contains("`orthopanel batch TEST.. -o LOT` writes one"), "{refused}");
        }
        assert!(Format::of(Path::new("lot.xlsx")).is_err());
        assert_eq!(Format::of(Path::new("LOT.CSV")).unwrap(), Format::Csv);
    }
}
