//! Dataset 58: numbers as text, in Fortran's columns or nearly so.

use super::{
    cursor::Cursor,
    fortran::{number, plain_number},
    header::{Header, Layout},
    line::shortened,
};
use crate::DataError;

/// Reads the values of all points, in the order of the file.
pub(super) fn values(
    cursor: &mut Cursor,
    header: &Header,
    key: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<f64>, DataError> {
    let needed = header.points.saturating_mul(header.layout.values_per_point());
    let mut values = Vec::new();
    let truncated = |cursor: &Cursor, byte: usize, found: usize| {
        Err(DataError::Truncated { at: cursor.at(byte, key), unit: "values", needed, found })
    };
    while values.len() < needed {
        let Some(line) = cursor.line() else { return truncated(cursor, cursor.position(), values.len()) };
        // A value may look like the mark; only its neighbours tell.
        if line.is_mark() && cursor.dataset_may_end_here() {
            return truncated(cursor, line.start, values.len());
        }
        append(&line.text(), widths(header.layout), &mut values)
            .map_err(|text| DataError::BadNumber { at: cursor.at(line.start, key), text })?;
    }
    // Writers fill the last line, or an odd count of points, with zeros.
    let mut surplus = values.split_off(needed);
    let end = cursor.position();
    loop {
        let before = cursor.position();
        let Some(line) = cursor.line() else { break };
        if line.is_mark() {
            break;
        }
        if !line.is_blank() && append(&line.text(), widths(header.layout), &mut surplus).is_err() {
            // Not data: what it is, the reader of datasets will say.
            cursor.back_to(before);
            break;
        }
    }
    if surplus.iter().any(|&value| value != 0.0) {
        let found = needed + surplus.len();
        return Err(DataError::Surplus { at: cursor.at(end, key), unit: "values", needed, found });
    }
    if !surplus.is_empty() {
        notes.push(format!("{key}: {} zeros after the last of {} points left out", surplus.len(), header.points));
    }
    Ok(values)
}

/// Widths of the fields, repeated along a line.
fn widths(layout: Layout) -> &'static [usize] {
    match layout {
        Layout { double: false, .. } => &[13],
        Layout { even: true, .. } => &[20],
        Layout { complex: false, .. } => &[13, 20],
        Layout { complex: true, .. } => &[13, 20, 20],
    }
}

/// Appends the numbers of a line; the error is the text that is none.
fn append(line: &str, widths: &[usize], values: &mut Vec<f64>) -> Result<(), String> {
    let known = values.len();
    // Three ways, from the plainest. By blanks, which holds for most files whatever their columns. By columns, where
    // full fields touch or an exponent lost its letter. By signs, where joined fields keep to no columns either.
    let bad = match append_all(line.split_ascii_whitespace(), plain_number, values) {
        None => return Ok(()),
        Some(bad) => bad,
    };
    values.truncate(known);
    if append_all(columns(line, widths), number, values).is_none() {
        return Ok(());
    }
    values.truncate(known);
    if append_all(split_at_signs(line), plain_number, values).is_none() {
        return Ok(());
    }
    values.truncate(known);
    Err(shortened(bad))
}

/// Appends until a text is no number, which it returns.
fn append_all<'a>(
    texts: impl Iterator<Item = &'a str>,
    parse: fn(&str) -> Option<f64>,
    values: &mut Vec<f64>,
) -> Option<&'a str> {
    for text in texts {
        match parse(text) {
            Some(value) => values.push(value),
            None => return Some(text),
        }
    }
    None
}

fn columns<'a>(line: &'a str, widths: &'a [usize]) -> impl Iterator<Item = &'a str> {
    let mut rest = line.trim_ascii_end();
    widths.iter().cycle().map_while(move |&width| {
        if rest.is_empty() {
            return None;
        }
        let (field, after) = rest.split_at_checked(width).unwrap_or((rest, ""));
        rest = after;
        Some(field.trim())
    })
}

fn split_at_signs(line: &str) -> impl Iterator<Item = &str> {
    line.split_ascii_whitespace().flat_map(|joined| {
        let bytes = joined.as_bytes();
        let sign = |index: usize| matches!(bytes.get(index), Some(b'+' | b'-'));
        let exponent = |index: usize| matches!(bytes.get(index), Some(b'e' | b'E' | b'd' | b'D'));
        let starts: Vec<usize> =
            (0..joined.len()).filter(|&index| index == 0 || (sign(index) && !exponent(index - 1))).collect();
        let ends: Vec<usize> = starts.iter().skip(1).copied().chain([joined.len()]).collect();
        starts.into_iter().zip(ends).filter_map(|(from, to)| joined.get(from..to))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str, widths: &[usize]) -> Vec<f64> {
        let mut values = Vec::new();
        append(line, widths, &mut values).map(|()| values).unwrap_or_default()
    }

    #[test]
    fn val_joined_fields_and_lost_exponent_letters_are_read() {
        assert_eq!(parsed(" 1.00000e+00-2.00000e-01 3.0D+00", &[13]), [1.0, -0.2, 3.0]);
        assert_eq!(parsed("-1.00000e-100-2.00000e-101", &[13]), [-1e-100, -2e-101]);
        // Fortran's E13.5 of 1e-100, -2e-100: no room for the letter.
        assert_eq!(parsed("  0.10000-099 -0.20000-099", &[13]), [1e-100, -2e-100]);
        assert_eq!(parsed("1.5e+00-2.5e+00", &[13]), [1.5, -2.5]);
        // Twelve-digit fields of 13 and 20 columns, touching.
        assert_eq!(parsed(" 1.00000e+00-1.123456789012e+00 2.00000e+00", &[13, 20]), [1.0, -1.123456789012, 2.0]);
    }

    #[test]
    fn val_text_that_is_no_number_is_refused() {
        for line in ["abc", "1.0 *************", "1.0e+00 2.0x"] {
            assert!(append(line, &[13], &mut Vec::new()).is_err(), "{line}");
        }
    }
}
