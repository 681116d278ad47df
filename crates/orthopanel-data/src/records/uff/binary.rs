//! Dataset 58b: numbers as IEEE 754 bytes, with a byte count that is often wrong.

use super::{
    cursor::{Cursor, begins_with_mark},
    header::{Encoding, Header},
};
use crate::DataError;

/// Bytes of one abscissa and of one ordinate value.
#[derive(Clone, Copy)]
struct Widths {
    abscissa: usize,
    ordinate: usize,
}

impl Widths {
    fn point(self, header: &Header) -> usize {
        let ordinates = 1 + usize::from(header.layout.complex);
        ordinates * self.ordinate + if header.layout.even { 0 } else { self.abscissa }
    }
}

/// Reads the values of all points, in the order of the file, and how many bytes a point takes.
///
/// Where the closing mark stands decides the length of the data, for the announced count cannot be trusted: writers
/// give the bytes of real values for complex ones, of single for double, or add the line end.
pub(super) fn values(
    cursor: &mut Cursor,
    header: &Header,
    big_endian: bool,
    key: &str,
    notes: &mut Vec<String>,
) -> Result<(Vec<f64>, usize), DataError> {
    let start = cursor.position();
    let rest = cursor.rest();
    let declared = declared(header);
    let bytes = |widths: Widths| header.points.saturating_mul(widths.point(header));
    let fits = |count: usize| rest.get(count..).is_some_and(ends_dataset);

    let (widths, count) = match candidates(header).into_iter().find(|&widths| fits(bytes(widths))) {
        Some(widths) => (widths, bytes(widths)),
        None => {
            let announced = match header.encoding {
                Encoding::Binary { announced, .. } => announced.filter(|&count| fits(count)),
                Encoding::Text => None,
            };
            let count = announced.or_else(|| find_end(rest)).unwrap_or(rest.len());
            let needed = bytes(declared);
            if count < needed {
                let at = cursor.at(start + count, key);
                return Err(DataError::Truncated { at, unit: "bytes", needed, found: count });
            }
            let surplus = rest.get(needed..count).unwrap_or_default();
            if surplus.iter().any(|&byte| byte != 0 && !byte.is_ascii_whitespace()) {
                let at = cursor.at(start + needed, key);
                return Err(DataError::Surplus { at, unit: "bytes", needed, found: count });
            }
            if !surplus.is_empty() {
                notes.push(format!("{key}: {} zero bytes after the last point left out", surplus.len()));
            }
            (declared, count)
        }
    };
    if widths.ordinate != declared.ordinate {
        let (found, said) = (8 * widths.ordinate, 8 * declared.ordinate);
        notes.push(format!("{key}: the header says {said} bits a value, the data's length says {found}: read as such"));
    }
    let needed = bytes(widths);
    if let Encoding::Binary { announced: Some(announced), .. } = header.encoding
        && announced != needed
    {
        notes.push(format!("{key}: the header announces {announced} bytes, the data have {needed}"));
    }
    if rest.len() == count {
        notes.push(format!("{key}: the file ends without the closing mark -1"));
    }
    cursor.advance(count);

    let data = rest.get(..needed).unwrap_or_default();
    let values = match (widths.ordinate, header.layout.even || widths.abscissa == widths.ordinate) {
        (4, true) if big_endian => decode(data, f32::from_be_bytes),
        (4, true) => decode(data, f32::from_le_bytes),
        (_, true) if big_endian => decode(data, f64::from_be_bytes),
        (_, true) => decode(data, f64::from_le_bytes),
        (_, false) => {
            let points = data.chunks_exact(widths.point(header));
            let parts = points.filter_map(|point| point.split_at_checked(widths.abscissa));
            let single = if big_endian { f32::from_be_bytes } else { f32::from_le_bytes };
            let double = if big_endian { f64::from_be_bytes } else { f64::from_le_bytes };
            parts.flat_map(|(abscissa, rest)| [decode(abscissa, single), decode(rest, double)].concat()).collect()
        }
    };
    Ok((values, widths.point(header)))
}

/// All numbers in `bytes`, one every `N` bytes.
fn decode<T: Into<f64>, const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> T) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|&bytes| number(bytes).into()).collect()
}

fn declared(header: &Header) -> Widths {
    match header.layout.double {
        true => Widths { abscissa: 8, ordinate: 8 },
        false => Widths { abscissa: 4, ordinate: 4 },
    }
}

/// The declared widths first, then what writers put in their place: an uneven double layout with a single abscissa
/// (so the definition's text form has it), and the other precision than declared.
fn candidates(header: &Header) -> Vec<Widths> {
    let single = Widths { abscissa: 4, ordinate: 4 };
    let double = Widths { abscissa: 8, ordinate: 8 };
    let mixed = Widths { abscissa: 4, ordinate: 8 };
    if header.layout.double { vec![double, mixed, single] } else { vec![single, double, mixed] }
}

/// True where `bytes` start with the closing mark, or with a line end and the mark, or are at their end.
fn ends_dataset(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\r").unwrap_or(bytes);
    let bytes = bytes.strip_prefix(b"\n").unwrap_or(bytes);
    bytes.is_empty() || begins_with_mark(bytes)
}

/// Where the data end, by the first closing mark that the end of the file or another mark follows.
fn find_end(bytes: &[u8]) -> Option<usize> {
    const MARK: &[u8] = b"    -1";
    let next_line = |from: usize| bytes.get(from..)?.iter().position(|&byte| byte == b'\n').map(|at| from + at + 1);
    bytes.windows(MARK.len()).enumerate().filter(|(_, window)| *window == MARK).map(|(at, _)| at).find(|&at| {
        ends_dataset(bytes.get(at..).unwrap_or_default())
            && next_line(at).is_none_or(|next| ends_dataset(bytes.get(next..).unwrap_or_default()))
    })
}
