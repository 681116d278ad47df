//! Names that every tool takes: those of C.

/// Characters at most, for file systems and tools that hold less than C.
const LONGEST: usize = 128;

/// Whether a text is a name in C: letters of ASCII, digits and `_`, no digit first, at most 128 of them.
pub fn is_identifier(text: &str) -> bool {
    let first = text.starts_with(|first: char| first == '_' || first.is_ascii_alphabetic());
    first && text.len() <= LONGEST && text.bytes().all(|byte| byte == b'_' || byte.is_ascii_alphanumeric())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_identifier_has_letters_digits_and_underscores() {
        for name in ["orthopanel", "_2", "A_b9"] {
            assert!(is_identifier(name), "{name}");
        }
        for name in ["", "2a", "../../x", "a-b", "a.b", "ä", "a b", "a\0", &"a".repeat(129)] {
            assert!(!is_identifier(name), "{name:?}");
        }
    }
}
