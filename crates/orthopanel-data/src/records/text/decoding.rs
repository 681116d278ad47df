//! Bytes of a text, in whatever encoding it was saved.

use std::borrow::Cow;

/// Bytes from which it is judged whether they are text.
const LOOKED_AT: usize = 4096;

/// The text that the bytes are, without its byte order mark, and the encoding where it is none of UTF-8; `None` where they are no text.
pub(super) fn text(bytes: &[u8]) -> Option<(Cow<'_, str>, Option<&'static str>)> {
    let wide = |bytes: &[u8], number: fn([u8; 2]) -> u16| {
        let units = bytes.chunks_exact(2).map(|pair| number([pair[0], pair[1]]));
        char::decode_utf16(units).map(|found| found.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>()
    };
    let (text, encoding) = match bytes {
        [0xff, 0xfe, rest @ ..] => (Cow::Owned(wide(rest, u16::from_le_bytes)), Some("UTF-16")),
        [0xfe, 0xff, rest @ ..] => (Cow::Owned(wide(rest, u16::from_be_bytes)), Some("UTF-16")),
        _ if half_zero(bytes, 1) => (Cow::Owned(wide(bytes, u16::from_le_bytes)), Some("UTF-16")),
        _ if half_zero(bytes, 0) => (Cow::Owned(wide(bytes, u16::from_be_bytes)), Some("UTF-16")),
        _ => {
            let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            match std::str::from_utf8(rest) {
                Ok(text) => (Cow::Borrowed(text), None),
                // Each byte is its character.
                Err(_) => (Cow::Owned(rest.iter().map(|&byte| char::from(byte)).collect()), Some("Latin 1")),
            }
        }
    };
    let is_odd = |character: char| character.is_control() && !character.is_whitespace() && character != '\u{1a}';
    let looked_at = || text.chars().take(LOOKED_AT);
    (!text.is_empty() && looked_at().filter(|character| is_odd(*character)).count() == 0).then_some((text, encoding))
}

/// Whether every second byte, from `first` on, is zero and the others are not, as in UTF-16 of a text in ASCII.
fn half_zero(bytes: &[u8], first: usize) -> bool {
    let pairs = bytes.get(..LOOKED_AT.min(bytes.len())).unwrap_or_default().chunks_exact(2);
    pairs.len() > 2 && pairs.clone().all(|pair| pair[first] == 0 && pair[1 - first] != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_encodings_are_told_apart() {
        let wide = |marked: bool| {
            let text = if marked { "\u{feff}Zeit;µ" } else { "Zeit;1" };
            text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>()
        };
        assert_eq!(text(&wide(true)), Some(("Zeit;µ".into(), Some("UTF-16"))));
        assert_eq!(text(&wide(false)), Some(("Zeit;1".into(), Some("UTF-16"))));
        assert_eq!(text("\u{feff}Zeit;µ".as_bytes()), Some(("Zeit;µ".into(), None)));
        assert_eq!(text(b"m/s\xb2\n"), Some(("m/s\u{b2}\n".into(), Some("Latin 1"))));
        assert_eq!(text(b"\x00\x01\x02"), None);
        assert_eq!(text(b""), None);
    }
}
