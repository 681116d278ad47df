//! Aligned tables for people.

use crate::harmless::harmless_line;

/// Half the width of a 95 % interval, over the standard deviation.
pub const HALF_95: f64 = 1.96;

/// Text rows under a heading; columns are set right-aligned, two blanks apart, the first left-aligned.
pub fn aligned(heading: &[&str], rows: &[Vec<String>]) -> String {
    set(heading, rows, |column| column == 0)
}

/// As [`aligned`], with words in the last column, left-aligned too.
pub fn ending_in_words(heading: &[&str], rows: &[Vec<String>]) -> String {
    set(heading, rows, |column| column == 0 || column + 1 == heading.len())
}

fn set(heading: &[&str], rows: &[Vec<String>], is_left: impl Fn(usize) -> bool) -> String {
    // A name of the user's may hold anything; a row stays one line.
    let rows: Vec<Vec<String>> =
        rows.iter().map(|row| row.iter().map(|cell| harmless_line(cell).into_owned()).collect()).collect();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column).map(|cell| cell.chars().count()));
        cells.chain(heading.get(column).map(|cell| cell.chars().count())).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..heading.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let padded = cells.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if is_left(column) { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    let body = rows.iter().map(|row| line(row.iter().map(String::as_str).collect()));
    line(heading.to_vec()) + &body.collect::<String>()
}

/// A unit for a cell of its own; pure numbers have none.
pub fn shown_unit(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

/// A number with its unit.
pub fn with_unit(number: &str, unit: &str) -> String {
    format!("{number} {}", shown_unit(unit)).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let table = aligned(&["mode", "Hz"], &[vec!["1".into(), "321.4".into()], vec!["10".into(), "9.0".into()]]);
        assert_eq!(table, "mode     Hz\n1     321.4\n10      9.0\n");
        let table = ending_in_words(&["id", "Hz", "what"], &[vec!["a".into(), "1".into(), "so it is".into()]]);
        assert_eq!(table, "id  Hz  what\na    1  so it is\n");
    }
}
