//! Dataset 164: the units of all that follows in the file.

use super::{cursor::Cursor, fortran, line::field};
use crate::{DataError, records::UnitSystem};

/// The unit systems by their codes, for files that print no factors: units of length and force a metre and a newton.
const FACTORS: [(i64, f64, f64); 9] = [
    (1, 1.0, 1.0),
    (2, 1.0 / 0.3048, 1.0 / 4.448_221_615_260_5),
    (3, 1.0, 1.0 / 9.806_65),
    (4, 1.0 / 0.3048, 1.0 / 0.138_254_954_376),
    (5, 1e3, 1e3),
    (6, 1e2, 1e2),
    (7, 1.0 / 0.0254, 1.0 / 4.448_221_615_260_5),
    (8, 1e3, 1.0 / 9.806_65),
    (10, 1e3, 1.0),
];

/// Reads from the line after the dataset's number up to the end of the dataset.
///
/// The factors bring SI to the file's units: what is measured is divided by them.
///
/// # Errors
/// [`DataError::Header`] where neither factors nor a known code stand there.
pub(super) fn read(cursor: &mut Cursor) -> Result<UnitSystem, DataError> {
    let start = cursor.position();
    let mut lines = Vec::new();
    while lines.len() < 2 {
        match cursor.line() {
            Some(line) if !line.is_mark() => lines.push(line.text().into_owned()),
            _ => {
                let problem =
                    "the units of dataset 164 expected, the dataset ends: take it out, or export the file again".into();
                return Err(DataError::Header { at: cursor.at(start, "dataset 164"), problem });
            }
        }
    }
    cursor.skip_dataset();
    let [first, second] = [0, 1].map(|line| lines.get(line).map(String::as_str).unwrap_or_default());
    let code: Option<i64> = field(first, 0, 10).and_then(|text| text.parse().ok());
    let name = field(first, 10, 20).unwrap_or("no name").to_owned();
    let by_columns = [field(second, 0, 25), field(second, 25, 25)];
    let mut by_blanks = second.split_whitespace();
    let by_blanks = [by_blanks.next(), by_blanks.next()];
    let numbers = |texts: [Option<&str>; 2]| match texts.map(|text| text.and_then(fortran::number)) {
        [Some(length), Some(force)] if length.is_normal() && length > 0.0 && force.is_normal() && force > 0.0 => {
            Some((length, force))
        }
        _ => None,
    };
    let by_code = || FACTORS.iter().find(|(of, ..)| Some(*of) == code).map(|(_, length, force)| (*length, *force));
    let factors = numbers(by_columns).or_else(|| numbers(by_blanks)).or_else(by_code);
    let (length, force) = factors.ok_or_else(|| DataError::Header {
        at: cursor.at(start, "dataset 164"),
        problem:
            "the factors of length and force expected in columns 1 to 50 of its second line: export the file again"
                .into(),
    })?;
    Ok(UnitSystem { name, length: inverse(length), force: inverse(force) })
}

/// One over a factor, without the errors of its last digit where a round number was meant.
fn inverse(factor: f64) -> f64 {
    let inverse = 1.0 / factor;
    let rounded = format!("{inverse:.8e}").parse().unwrap_or(inverse);
    if (inverse - rounded).abs() < 1e-9 * inverse { rounded } else { inverse }
}
