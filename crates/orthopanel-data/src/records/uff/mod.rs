//! Universal file, datasets 58 and 58b: functions at nodal degrees of freedom; 164: their units; 15 and 2411: the
//! places of nodes.
//!
//! Source: the dataset's definition by SDRC, as kept by the University of Cincinnati (Structural Dynamics Research
//! Laboratory, "Universal file formats"), and files as real writers leave them: see the comments where those differ.

mod ascii;
mod binary;
mod cursor;
mod fortran;
mod header;
mod line;
mod nodes;
mod ports;
mod unit_system;

use std::{collections::BTreeMap, path::Path, sync::Arc};

use num_complex::Complex64;

use super::{
    Record, RecordFile, RecordKind, Samples, UnitSystem,
    abscissa::{self, scaled},
    reading::may_be_read,
};
use crate::{DataError, Location, limits};
use cursor::Cursor;
pub(super) use fortran::number;
use header::{Encoding, Header};
use line::shortened;

/// What is read, for messages.
pub(super) const NAME: &str = "universal file (-1, then 58 or 58b)";

/// Whether the bytes begin as a universal file does.
pub(super) fn recognises(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(cursor::BYTE_ORDER_MARK).unwrap_or(bytes);
    let first = bytes.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty());
    first.is_some_and(cursor::is_mark)
}

pub(super) fn read(bytes: &[u8], path: &Path) -> Result<RecordFile, DataError> {
    let file = parts(bytes, path)?;
    if file.records.is_empty() {
        return Err(DataError::NoRecords { at: Location::whole(path), what: "dataset 58 or 58b" });
    }
    Ok(file)
}

/// All that is read of a universal file, which may hold no record.
pub(super) fn parts(bytes: &[u8], path: &Path) -> Result<RecordFile, DataError> {
    let mut cursor = Cursor::new(bytes, path);
    let (mut records, mut notes) = (Vec::new(), Vec::new());
    let (mut system, mut nodes) = (None, Vec::new());
    // Number of those of a kind, and the byte of the first.
    let mut skipped: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
    // Between datasets any number of marks may stand: one closes, one opens, and some writers write both twice or
    // leave one out. So a mark carries no state here; the first line that is neither mark nor blank is a dataset.
    while let Some(line) = cursor.line() {
        if cursor.rest().is_empty() && !bytes.ends_with(b"\n") && line.begins_mark() {
            notes.push(format!("the file ends at byte {} within a mark: it may be cut off", line.start));
            break;
        }
        if line.is_blank() || line.is_mark() {
            continue;
        }
        let text = line.text();
        let digits = text.trim_start().len() - text.trim_start().trim_start_matches(|c: char| c.is_ascii_digit()).len();
        match text.trim_start().get(..digits).and_then(|number| number.parse::<u32>().ok()) {
            Some(58) => {
                let number = records.len() + 1;
                if number > limits::RECORDS {
                    let (at, most) = (cursor.at(line.start, ""), limits::RECORDS);
                    return Err(DataError::TooMany {
                        at,
                        found: number,
                        what: "records",
                        most,
                        remedy: "split the file",
                    });
                }
                let before = records.last().map(|record: &Record| &record.abscissa);
                let mut read = record(&mut cursor, &text, line.start, number, before, &mut notes)?;
                for axis in [&mut read.numerator, &mut read.denominator] {
                    axis.system.clone_from(&system);
                }
                records.push(read);
            }
            Some(164) => system = Some(Arc::new(unit_system::read(&mut cursor)?)),
            Some(dataset @ (15 | 2411)) => {
                let metre = system.as_ref().map_or(1.0, |system: &Arc<UnitSystem>| system.length);
                nodes::read(&mut cursor, dataset, metre, &mut nodes);
            }
            Some(other) => {
                cursor.skip_dataset();
                skipped.entry(other).or_insert((0, line.start)).0 += 1;
            }
            None => {
                let problem = format!("a dataset number expected after the mark -1, found {:?}", shortened(&text));
                return Err(DataError::Header { at: cursor.at(line.start, ""), problem });
            }
        }
    }
    notes.extend(skipped.into_iter().map(|(number, (count, first))| {
        let times = if count == 1 { String::new() } else { format!(" and {} more", count - 1) };
        format!("dataset {number} at byte {first}{times} skipped: only 58, 58b, 164, 15 and 2411 are read")
    }));
    if let Some(byte) = cursor::opens_at_end(bytes) {
        notes.push(format!("the mark at byte {byte} opens a dataset, and the file ends: it may be cut off"));
    }
    Ok(RecordFile { records, notes, nodes })
}

fn record(
    cursor: &mut Cursor,
    first_line: &str,
    start: usize,
    number: usize,
    before: Option<&Arc<[f64]>>,
    notes: &mut Vec<String>,
) -> Result<Record, DataError> {
    let key = format!("record {number}");
    let mut header = Header::read(cursor, first_line, &key)?;
    let data_start = cursor.position();
    // Of binary data every point has its byte.
    let (values, point_width) = match header.encoding {
        Encoding::Text => (ascii::values(cursor, &header, &key, notes)?, 0),
        Encoding::Binary { big_endian, .. } => binary::values(cursor, &header, big_endian, &key, notes)?,
    };
    let layout = header.layout;
    let kind = RecordKind::from(header.function);
    notes.extend(header.notes.drain(..).map(|note| format!("{key}: {note}")));
    let mut listed = Vec::new();
    let mut real = Vec::new();
    let mut complex = Vec::new();
    if layout.even
        && let Some(restored) = super::step::restored(header.step, header.step_digits, header.points)
    {
        notes.push(format!(
            "{key}: the step printed as {} is a rounded {restored}, which makes rate or length round: used that",
            header.step
        ));
        header.step = restored;
    }
    let scale = abscissa::scale(&header.abscissa.unit, kind, &key, notes);
    header.start = scaled(header.start, scale);
    header.step = scaled(header.step, scale);
    match (layout.even, layout.complex) {
        (true, false) => real = values,
        (true, true) => complex.extend(values.chunks_exact(2).filter_map(complex_number)),
        (false, _) => {
            for point in values.chunks_exact(layout.values_per_point()) {
                match point {
                    [x, value] => {
                        listed.push(scaled(*x, scale));
                        real.push(*value);
                    }
                    [x, value @ ..] => {
                        listed.push(scaled(*x, scale));
                        complex.extend(complex_number(value));
                    }
                    [] => {}
                }
            }
        }
    }
    if kind == RecordKind::Coherence {
        // Analysers divide 0 by 0 where no force was: a line without coherence, not a broken file.
        let mended = real.iter_mut().filter(|value| !value.is_finite()).map(|value| *value = 0.0).count();
        if mended > 0 {
            notes.push(format!("{key}: coherence is not a number in {mended} lines: taken as 0"));
        }
    }
    let ordinate = if layout.complex { Samples::Complex(complex) } else { Samples::Real(real) };
    let abscissa = if layout.even { even(&header, before) } else { listed.into() };
    let rise = match (layout.even, kind) {
        (true, _) => Rise::Even,
        // Listed times are judged where their rounding and the declared rate are.
        (false, RecordKind::Time) => Rise::Any,
        (false, _) => Rise::Listed,
    };
    check_numbers(cursor, (data_start, point_width), &key, &abscissa, &ordinate, rise)?;
    let Header { title, response, reference, numerator, denominator, .. } = header;
    let at = cursor.at(start, &key);
    Ok(Record { number, kind, title, at, lines: None, response, reference, abscissa, ordinate, numerator, denominator })
}

/// What the abscissa of a record is asked to do.
#[derive(Clone, Copy, PartialEq)]
enum Rise {
    /// Made of start and step.
    Even,
    /// Listed, and rising.
    Listed,
    /// Listed as it may.
    Any,
}

/// Times or frequencies of an even record: those of the record before where they are the same.
fn even(header: &Header, before: Option<&Arc<[f64]>>) -> Arc<[f64]> {
    let (start, step, points) = (header.start, header.step, header.points);
    let due = |index: usize| start + step * index as f64;
    // Two even grids of one length that share the first two and the last point share all.
    let same = |other: &[f64]| {
        other.len() == points
            && [0, 1, points - 1].iter().all(|&index| other.get(index).is_none_or(|&x| x == due(index)))
    };
    match before {
        Some(before) if same(before) => Arc::clone(before),
        _ => (0..points).map(due).collect(),
    }
}

fn complex_number(parts: &[f64]) -> Option<Complex64> {
    match *parts {
        [re, im] => Some(Complex64::new(re, im)),
        _ => None,
    }
}

fn check_numbers(
    cursor: &Cursor,
    (data_start, point_width): (usize, usize),
    key: &str,
    abscissa: &[f64],
    ordinate: &Samples,
    rise: Rise,
) -> Result<(), DataError> {
    let sound = |value: &Complex64| may_be_read(value.re) && may_be_read(value.im);
    let bad = match ordinate {
        Samples::Real(values) => first_unsound(values),
        Samples::Complex(values) => values.iter().position(|value| !sound(value)),
    };
    let last = abscissa.len().saturating_sub(1);
    let bad_abscissa = || match abscissa.last() {
        // Even times rise by a step that the header's reader has checked: only their end can overflow.
        Some(end) if rise == Rise::Even => (!end.is_finite()).then_some(last),
        _ => first_unsound(abscissa),
    };
    if let Some(point) = bad.or_else(bad_abscissa) {
        return Err(DataError::NotFinite { at: cursor.at(data_start + point * point_width, key), point: point + 1 });
    }
    if rise == Rise::Any || (rise == Rise::Even && ends_rise(abscissa)) {
        return Ok(());
    }
    let falls = abscissa.windows(2).position(|pair| !matches!(pair, [before, after] if before < after));
    match falls {
        None => Ok(()),
        Some(point) => {
            let problem = format!("time or frequency does not rise from point {} to {}", point + 1, point + 2);
            Err(DataError::Header { at: cursor.at(data_start, key), problem })
        }
    }
}

/// True where an even grid rises: where its points are greatest, at one of its ends, the step would be lost first.
fn ends_rise(abscissa: &[f64]) -> bool {
    let rises = |pair: Option<&[f64]>| !matches!(pair, Some([before, after]) if before >= after);
    rises(abscissa.get(..2)) && rises(abscissa.get(abscissa.len().saturating_sub(2)..))
}

/// The first value that no sensor has read. Files are mostly sound, so all values are tested in one pass without branches.
fn first_unsound(values: &[f64]) -> Option<usize> {
    let sound = values.iter().fold(true, |sound, value| sound & may_be_read(*value));
    if sound { None } else { values.iter().position(|value| !may_be_read(*value)) }
}
