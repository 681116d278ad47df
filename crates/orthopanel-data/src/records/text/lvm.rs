//! LabVIEW measurement files (LVM): a header of names and values, then a table a stretch of recording, each under a header of its own.
//!
//! Source: National Instruments, "Specification for the LabVIEW Measurement File (.lvm)".

use super::{meaning::Column, separator::Separator, table::Table};

/// What such a file begins with.
const FIRST_LINE: &str = "LabVIEW Measurement";
const HEADER_ENDS: &str = "***End_of_Header***";

/// The tables of an LVM file; `None` for any other text.
pub(super) fn tables(text: &str) -> Option<Vec<Table<'_>>> {
    text.trim_start().starts_with(FIRST_LINE).then_some(())?;
    let (mut start, mut number) = (0, 0);
    let mut header: Vec<Vec<&str>> = Vec::new();
    let mut separator = Separator::Tab;
    let (mut tables, mut names_follow) = (Vec::new(), false);
    for line in text.split_inclusive('\n') {
        start += line.len();
        number += 1;
        if line.trim().is_empty() {
            continue;
        }
        let fields = separator.fields(line);
        match fields.first().copied() {
            Some("Separator") if line.contains("Comma") => separator = Separator::Comma,
            Some("Separator,Comma") => separator = Separator::Comma,
            Some(HEADER_ENDS) => names_follow = true,
            Some("X_Value") if names_follow => {
                let table = table(&fields, &header, (text.get(start..).unwrap_or_default(), number), separator);
                tables.push(table);
                names_follow = false;
            }
            // The header of the next stretch.
            Some("Channels") => {
                header.retain(|line| line.first().is_some_and(|key| *key == "X_Columns"));
                header.push(fields);
            }
            // Rows of numbers are no header.
            Some(key) if key.starts_with(|c: char| c.is_ascii_alphabetic()) && header.len() < MOST_KEYS => {
                header.push(fields);
            }
            _ => {}
        }
    }
    Some(tables)
}

/// Lines of headers that are kept.
const MOST_KEYS: usize = 1000;

fn table<'a>(
    names: &[&str],
    header: &[Vec<&str>],
    (text, names_at): (&'a str, usize),
    separator: Separator,
) -> Table<'a> {
    let of_key = |key: &str| header.iter().rev().find(|line| line.first().is_some_and(|first| *first == key));
    let first = |key: &str| of_key(key).and_then(|line| line.get(1)).copied();
    let mut units = of_key("Y_Unit_Label").into_iter().flatten().skip(1);
    let mut columns: Vec<Column> = Vec::new();
    for name in names.iter().filter(|name| !name.is_empty() && **name != "Comment") {
        let is_time = *name == "X_Value";
        let unit = if is_time { "s" } else { units.next().copied().unwrap_or_default() };
        let mut column = Column::of(name, unit);
        if column.unit.is_empty() {
            column.unit = unit.into();
        }
        columns.push(column);
    }
    let number = |key: &str| first(key).and_then(super::separator::number);
    // Without a column of its own X stands in the header.
    let even =
        (first("X_Columns") == Some("No")).then(|| (number("X0").unwrap_or(0.0), number("Delta_X").unwrap_or(1.0)));
    if even.is_some() {
        columns
            .iter_mut()
            .filter(|column| column.meaning.is_abscissa())
            .for_each(|column| column.meaning = super::Meaning::NotRead);
    }
    Table { text, first_line: names_at + 1, separator, columns, is_named: true, names_at, is_part: true, even }
}
