//! What stands between the numbers of a row, and the numbers themselves.

use crate::records::uff;

/// Between columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Tab,
    Semicolon,
    Comma,
    /// Blanks, any number of them.
    Blanks,
}

impl Separator {
    /// In the order in which they are tried: what holds more must come first.
    pub(super) const ALL: [Self; 4] = [Self::Tab, Self::Semicolon, Self::Comma, Self::Blanks];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Tab => "tabs",
            Self::Semicolon => "semicolons",
            Self::Comma => "commas",
            Self::Blanks => "blanks",
        }
    }

    fn character(self) -> char {
        match self {
            Self::Tab => '\t',
            Self::Semicolon => ';',
            Self::Comma => ',',
            Self::Blanks => ' ',
        }
    }

    /// The fields of a line, trimmed and out of their quotes.
    pub(super) fn fields(self, line: &str) -> Vec<&str> {
        let mut fields = Vec::new();
        self.split(line, &mut fields);
        fields
    }

    /// The same into a list that is emptied before.
    pub(super) fn split<'a>(self, line: &'a str, fields: &mut Vec<&'a str>) {
        fields.clear();
        if line.contains('"') {
            let (mut from, mut quoted) = (0, false);
            for (at, character) in line.char_indices() {
                quoted ^= character == '"';
                if !quoted && self.parts(character) {
                    fields.push(line.get(from..at).unwrap_or_default());
                    from = at + character.len_utf8();
                }
            }
            fields.push(line.get(from..).unwrap_or_default());
            if self == Self::Blanks {
                fields.retain(|field| !field.is_empty());
            }
            fields.iter_mut().for_each(|field| *field = field.trim().trim_matches('"').trim());
        } else if self == Self::Blanks {
            fields.extend(line.split_whitespace());
        } else {
            fields.extend(line.split(self.character()).map(str::trim));
        }
    }

    fn parts(self, character: char) -> bool {
        match self {
            Self::Blanks => character.is_whitespace(),
            other => character == other.character(),
        }
    }

    /// The number of columns of a row of numbers alone, but for empty ones at its end; `None` for any other line.
    pub(super) fn numbers(self, line: &str) -> Option<usize> {
        let fields = self.fields(line);
        let last = fields.iter().rposition(|field| !field.is_empty())? + 1;
        let told = fields.get(..last)?;
        let first = told.first()?;
        (first.bytes().any(|byte| byte.is_ascii_digit()) && told.iter().all(|field| number(field).is_some()))
            .then_some(last)
    }
}

/// The number that a field holds, its decimals behind a point or a comma.
pub(super) fn number(field: &str) -> Option<f64> {
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    if field.contains(',') && !field.contains('.') && field.matches(',').count() == 1 {
        return field.replace(',', ".").parse().ok();
    }
    // Fortran's letters, or none. Only what begins as a number does.
    let begins = field.trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit() || c == '.');
    begins.then(|| uff::number(field)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_rows_of_numbers_are_told_from_others() {
        for (separator, line, columns) in [
            (Separator::Comma, "1, 2,3", Some(3)),
            (Separator::Comma, "\"0,5\",\"1,5\"", Some(2)),
            (Separator::Semicolon, "0,5;1.5;-2e-3;", Some(3)),
            (Separator::Tab, "0,5\t1,5", Some(2)),
            (Separator::Blanks, "  1   2.5  -3D+00", Some(3)),
            (Separator::Comma, "1,x", None),
            (Separator::Comma, "nan,1", None),
            (Separator::Comma, "0,5;1,5", None),
            (Separator::Comma, "", None),
        ] {
            assert_eq!(separator.numbers(line), columns, "{line}");
        }
        assert_eq!(number("1,5"), Some(1.5));
        assert_eq!(number("1.000,5"), None);
    }
}
