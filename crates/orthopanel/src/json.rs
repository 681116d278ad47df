//! Answers as JSON.

use serde::Serialize;

use crate::harmless::{escaped, is_harmful};

/// One JSON object on one line.
pub fn line(value: &impl Serialize) -> String {
    text(serde_json::to_string(value))
}

/// One JSON object, laid out for people.
pub fn laid_out(value: &impl Serialize) -> String {
    text(serde_json::to_string_pretty(value))
}

fn text(serialised: serde_json::Result<String>) -> String {
    // Every answer is made of plain numbers, texts and lists: serialisation has nothing to fail on. What JSON lets pass
    // and a terminal obeys stands in strings alone, where an escape means the same.
    let text = serialised.unwrap_or_default() + "\n";
    escaped(&text, is_harmful, |character| format!("\\u{:04x}", u32::from(character))).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_text_reads_back() {
        let name = "\u{1b}]0;\u{9b}\u{7f}\u{202e}\u{2066}\u{3b6}\n";
        let text = line(&name);
        assert_eq!(text, "\"\\u001b]0;\\u009b\\u007f\\u202e\\u2066\u{3b6}\\n\"\n");
        assert_eq!(serde_json::from_str::<String>(&text).expect("a string"), name);
    }
}
