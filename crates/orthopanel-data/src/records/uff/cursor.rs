//! Lines and bytes of a universal file, which mixes both.

use std::{borrow::Cow, path::Path};

use crate::{Location, Position};

/// A place in the bytes of a file.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    path: &'a Path,
    position: usize,
}

/// One line without its end, and the byte where it starts.
pub(super) struct Line<'a> {
    pub(super) start: usize,
    pub(super) bytes: &'a [u8],
}

impl<'a> Line<'a> {
    /// True for the mark that opens and closes a dataset.
    pub(super) fn is_mark(&self) -> bool {
        is_mark(self.bytes)
    }

    /// True for a mark of which the end is missing: blanks, and its sign.
    pub(super) fn begins_mark(&self) -> bool {
        (1..MARK.len()).contains(&self.bytes.len()) && MARK.starts_with(self.bytes)
    }

    /// True where nothing but blanks and control characters stands (Ctrl-Z ends files of old systems).
    pub(super) fn is_blank(&self) -> bool {
        self.bytes.iter().all(|byte| byte.is_ascii_whitespace() || byte.is_ascii_control())
    }

    /// The line as text; a byte that is no ASCII stays one character, so columns keep their places.
    pub(super) fn text(&self) -> Cow<'a, str> {
        match std::str::from_utf8(self.bytes) {
            Ok(text) if text.is_ascii() => Cow::Borrowed(text),
            _ => Cow::Owned(
                self.bytes.iter().map(|&byte| if byte.is_ascii() { char::from(byte) } else { '?' }).collect(),
            ),
        }
    }
}

/// Some editors put it before a text.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The mark as the definition has it, in format I6.
const MARK: &[u8] = b"    -1";

/// Byte of a last mark that opens a dataset which is not there: a second one in a row, of a writer that does not put
/// all twice.
pub(super) fn opens_at_end(bytes: &[u8]) -> Option<usize> {
    let lines = |line: &&[u8]| !line.trim_ascii().is_empty();
    let mut first = bytes.split(|&byte| byte == b'\n').filter(lines);
    let mut last = bytes.rsplit(|&byte| byte == b'\n').filter(lines);
    let doubled = first.nth(1).is_none_or(is_mark);
    let ending = last.next().filter(|line| is_mark(line));
    let second = last.next().is_some_and(is_mark);
    let end = bytes.trim_ascii_end().len();
    (!doubled && second).then_some(ending?).map(|_| end - b"-1".len())
}

/// True for `    -1` (format I6), and for the same mark with fewer blanks.
pub(super) fn is_mark(line: &[u8]) -> bool {
    let line = line.trim_ascii_end();
    line.len() <= 6 && line.trim_ascii_start() == b"-1"
}

/// True where the first line of `bytes` is a mark of six columns or more; nothing is read beyond the first byte that no mark has,
/// for binary data may go on for megabytes without a line's end.
pub(super) fn begins_with_mark(bytes: &[u8]) -> bool {
    let blanks = |bytes: &[u8]| bytes.iter().take_while(|byte| byte.is_ascii_whitespace() && **byte != b'\n').count();
    let before = blanks(bytes.get(..MARK.len()).unwrap_or(bytes));
    let Some(after) = bytes.get(before..).and_then(|rest| rest.strip_prefix(b"-1")) else { return false };
    let fill = blanks(after);
    let columns = before + b"-1".len();
    columns <= MARK.len() && columns + fill >= MARK.len() && after.get(fill).is_none_or(|&byte| byte == b'\n')
}

impl<'a> Cursor<'a> {
    /// At the beginning, after a byte order mark; bytes are counted with it.
    pub(super) fn new(bytes: &'a [u8], path: &'a Path) -> Self {
        let position = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Self { bytes, path, position }
    }

    pub(super) fn position(&self) -> usize {
        self.position
    }

    /// The bytes from here on.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }

    pub(super) fn advance(&mut self, count: usize) {
        self.position = self.position.saturating_add(count).min(self.bytes.len());
    }

    /// Goes back to an earlier [`Cursor::position`].
    pub(super) fn back_to(&mut self, position: usize) {
        self.position = position.min(self.position);
    }

    pub(super) fn at(&self, byte: usize, key: &str) -> Box<Location> {
        Box::new(Location { file: self.path.to_path_buf(), position: Position::Byte(byte), key: key.into() })
    }

    /// The next line; `None` at the end of the file.
    pub(super) fn line(&mut self) -> Option<Line<'a>> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let start = self.position;
        let length = rest.iter().position(|&byte| byte == b'\n');
        self.advance(length.map_or(rest.len(), |length| length + 1));
        let line = rest.get(..length.unwrap_or(rest.len())).unwrap_or(rest);
        Some(Line { start, bytes: line.strip_suffix(b"\r").unwrap_or(line) })
    }

    /// True where a dataset ends after the line just read, if that was a mark: the file ends, or another mark or a
    /// dataset 58 follows. A `-1` inside data has data after it.
    pub(super) fn dataset_may_end_here(&self) -> bool {
        let mut ahead = Self { bytes: self.bytes, path: self.path, position: self.position };
        loop {
            match ahead.line() {
                None => return true,
                Some(line) if line.is_blank() => {}
                Some(line) => {
                    let text = line.text();
                    return line.is_mark() || matches!(text.trim(), "58") || text.starts_with("    58b");
                }
            }
        }
    }

    /// Goes past the closing mark of a dataset that is not read.
    pub(super) fn skip_dataset(&mut self) {
        while let Some(line) = self.line() {
            if line.is_mark() && self.dataset_may_end_here() {
                return;
            }
        }
    }
}
