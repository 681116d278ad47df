//! The eleven lines before the data, and the fields of a 58b's first line.

use orthopanel_model::Readable;

use super::{
    cursor::Cursor,
    fortran,
    line::{field, shortened},
    ports,
};
use crate::{
    DataError,
    records::{Axis, Port},
};

/// How the data are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    /// Dataset 58.
    Text,
    /// Dataset 58b; `announced` is the header's byte count, which many writers get wrong.
    Binary { big_endian: bool, announced: Option<usize> },
}

/// The eight layouts: real or complex, single or double, even or uneven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    pub(super) complex: bool,
    pub(super) double: bool,
    pub(super) even: bool,
}

impl Layout {
    /// Numbers stored a point: an uneven layout stores the abscissa too.
    pub(super) fn values_per_point(self) -> usize {
        1 + usize::from(self.complex) + usize::from(!self.even)
    }
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) title: String,
    pub(super) function: i64,
    pub(super) response: Port,
    pub(super) reference: Port,
    pub(super) layout: Layout,
    pub(super) points: usize,
    pub(super) start: f64,
    pub(super) step: f64,
    /// Significant digits to which the step is printed.
    pub(super) step_digits: u32,
    pub(super) abscissa: Axis,
    pub(super) numerator: Axis,
    pub(super) denominator: Axis,
    /// What was assumed, a sentence each.
    pub(super) notes: Vec<String>,
}

impl Header {
    /// Reads from the line after the dataset number, which is `first_line`, to the line before the data.
    pub(super) fn read(cursor: &mut Cursor, first_line: &str, key: &str) -> Result<Self, DataError> {
        let encoding = encoding(cursor, first_line, key)?;
        let mut next = |what: &'static str| {
            let end = cursor.position();
            cursor.line().map(|line| (line.start, line.text())).ok_or(end).map_err(|end| DataError::Header {
                at: cursor.at(end, key),
                problem: format!("the file ends where {what} should stand: it is cut off"),
            })
        };
        let mut title = Vec::new();
        for _ in 0..5 {
            let (_, line) = next("an identification line")?;
            let line = line.trim();
            if !line.is_empty() && line != "NONE" {
                title.push(line.to_owned());
            }
        }
        let (at_kind, kind) = next("the function's kind")?;
        let (at_form, form) = next("the data's form")?;
        let (_, abscissa) = next("the abscissa's axis")?;
        let (_, numerator) = next("the ordinate's axis")?;
        let (_, denominator) = next("the denominator's axis")?;
        let _z = next("the z axis")?;

        let function = field(&kind, 0, 5).or_else(|| kind.split_whitespace().next()).and_then(|text| text.parse().ok());
        let function = function.ok_or_else(|| DataError::Header {
            at: cursor.at(at_kind, key),
            problem: format!("the function's kind, a number, expected in columns 1 to 5 of {:?}", shortened(&kind)),
        })?;
        let ([response, reference], note) = ports::of_line(&kind);
        let malformed = |problem: String| DataError::Header { at: cursor.at(at_form, key), problem };
        let form = Form::parse(&form).ok_or_else(|| {
            malformed(format!("data type, points, spacing, start and step expected, found {:?}", shortened(&form)))
        })?;
        let (complex, double) = match form.data_type {
            2 => (false, false),
            4 => (false, true),
            5 => (true, false),
            6 => (true, true),
            other => {
                let words = "2 or 4 (real, single or double), 5 or 6 (complex)";
                return Err(malformed(format!("data type {other}: must be {words}")));
            }
        };
        let layout = Layout { complex, double, even: form.spacing != 0 };
        let points = usize::try_from(form.points).ok().filter(|&points| points > 0);
        let points = points.ok_or_else(|| malformed(format!("{} points: must be greater than zero", form.points)))?;
        if layout.even && !(form.step.is_finite() && form.step > 0.0 && form.start.is_finite()) {
            let found = format!("start {} and step {}", Readable(form.start), Readable(form.step));
            return Err(malformed(format!("{found}: must be finite, the step greater than zero")));
        }
        Ok(Self {
            encoding,
            title: title.join(" | "),
            function,
            response,
            reference,
            layout,
            points,
            start: form.start,
            step: form.step,
            step_digits: form.step_digits,
            abscissa: axis(&abscissa),
            notes: note.into_iter().collect(),
            numerator: axis(&numerator),
            denominator: axis(&denominator),
        })
    }
}

fn encoding(cursor: &Cursor, first_line: &str, key: &str) -> Result<Encoding, DataError> {
    let after = first_line.trim_start().trim_start_matches(|c: char| c.is_ascii_digit());
    let Some(fields) = after.strip_prefix(['b', 'B']) else { return Ok(Encoding::Text) };
    let fields: Vec<Option<i64>> = fields.split_whitespace().map(|text| text.parse().ok()).collect();
    let number = |index: usize| fields.get(index).copied().flatten();
    let refused = |problem: String| Err(DataError::Header { at: cursor.at(cursor.position(), key), problem });
    let big_endian = match number(0) {
        Some(1) => false,
        Some(2) => true,
        other => return refused(format!("byte order {other:?} of 58b: must be 1 (little-endian) or 2 (big-endian)")),
    };
    match number(1) {
        Some(2) => {}
        other => return refused(format!("floating-point format {other:?} of 58b: only 2 (IEEE 754) is read")),
    }
    let announced = number(3).and_then(|count| usize::try_from(count).ok());
    Ok(Encoding::Binary { big_endian, announced })
}

/// Record 7: data type, points, spacing, start, step; the z value is not used.
struct Form {
    data_type: i64,
    points: i64,
    spacing: i64,
    start: f64,
    step: f64,
    step_digits: u32,
}

impl Form {
    fn parse(line: &str) -> Option<Self> {
        // By columns as defined; where a writer kept to no columns, by blanks.
        let columns = [(0, 10), (10, 10), (20, 10), (30, 13), (43, 13)];
        let by_columns: Option<Vec<_>> = columns.iter().map(|&(from, width)| field(line, from, width)).collect();
        let by_blanks = || line.split_whitespace().collect::<Vec<_>>();
        by_columns.and_then(|fields| Self::from_fields(&fields)).or_else(|| Self::from_fields(&by_blanks()))
    }

    fn from_fields(fields: &[&str]) -> Option<Self> {
        let [data_type, points, spacing, start, step, ..] = *fields else { return None };
        Some(Self {
            data_type: data_type.parse().ok()?,
            points: points.parse().ok()?,
            spacing: spacing.parse().ok()?,
            start: fortran::number(start)?,
            step: fortran::number(step)?,
            step_digits: significant_digits(step),
        })
    }
}

fn significant_digits(number: &str) -> u32 {
    let mantissa = number.split(['e', 'E', 'd', 'D']).next().unwrap_or_default();
    let digits = mantissa.chars().filter(char::is_ascii_digit).skip_while(|&digit| digit == '0').count();
    u32::try_from(digits).unwrap_or(u32::MAX)
}

fn axis(line: &str) -> Axis {
    let data_type = field(line, 0, 10).and_then(|text| text.parse().ok()).unwrap_or(0);
    Axis::new(data_type, field(line, 47, 20).filter(|unit| *unit != "NONE").unwrap_or_default())
}
