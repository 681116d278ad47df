//! Names and texts of others, as they may stand in a document.

use std::borrow::Cow;

/// The text with U+FFFD in place of each character that no document should hold: control characters other than tab and line feed,
/// which XML 1.0 forbids even escaped, marks that turn the direction of what follows them, and noncharacters.
pub fn printable(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_printable) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().map(|of| if is_printable(of) { of } else { char::REPLACEMENT_CHARACTER }).collect())
}

fn is_printable(of: char) -> bool {
    match of {
        '\t' | '\n' => true,
        // Unicode's bidirectional controls (UAX #9), and its separators of lines and paragraphs.
        '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => false,
        '\u{fffe}' | '\u{ffff}' => false,
        _ => !of.is_control(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_turns_or_steers_is_replaced_and_the_rest_stays() {
        assert_eq!(printable("a\u{1b}[2J\u{7}\r\u{202e}\u{9b}b"), "a\u{fffd}[2J\u{fffd}\u{fffd}\u{fffd}\u{fffd}b");
        let plain = "Träger 1\tα²\n木 <b>";
        assert!(matches!(printable(plain), Cow::Borrowed(text) if text == plain));
    }
}
