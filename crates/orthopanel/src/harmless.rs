//! Texts in which nothing steers a terminal.

use std::borrow::Cow;

/// `text` with every character that steers a terminal made visible, such as `\u{1b}`; line ends and tabs stay.
pub fn harmless(text: &str) -> Cow<'_, str> {
    escaped(text, is_harmful, for_people)
}

/// As [`harmless`], of what must stay on one line.
pub fn harmless_line(text: &str) -> Cow<'_, str> {
    escaped(text, is_harmful_in_line, for_people)
}

/// `text` with each character that `is_harmful` says of written as `written` has it.
pub(crate) fn escaped(text: &str, is_harmful: fn(char) -> bool, written: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(is_harmful) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        if is_harmful(character) { escaped += &written(character) } else { escaped.push(character) }
    }
    Cow::Owned(escaped)
}

/// Control characters (C0, DEL, C1), which move the cursor, colour and retitle, and those that turn the direction of
/// writing, behind which a name shows as another.
pub(crate) fn is_harmful(character: char) -> bool {
    is_harmful_in_line(character) && !matches!(character, '\n' | '\t')
}

fn is_harmful_in_line(character: char) -> bool {
    character.is_control() || matches!(orthopanel_model::printable(character.encode_utf8(&mut [0; 4])), Cow::Owned(_))
}

fn for_people(character: char) -> String {
    character.escape_unicode().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_made_visible() {
        let name = "a\u{1b}[2J\u{7}\u{9b}1m\u{202e}b\u{2069}\u{7f}\r";
        let shown = "a\\u{1b}[2J\\u{7}\\u{9b}1m\\u{202e}b\\u{2069}\\u{7f}\\u{d}";
        assert_eq!(harmless(name), shown);
        assert_eq!(harmless("two\n\tlines, \u{3b6} \u{d7}"), "two\n\tlines, \u{3b6} \u{d7}");
        assert_eq!(harmless_line("a\nerror: \t"), "a\\u{a}error: \\u{9}");
    }
}
