//! What the layers below have to say about the records, for people.

use std::collections::HashMap;

use crate::console;

/// Prints each note once on standard error, behind `about`, with how often it was made.
pub fn say(about: &str, notes: &[String]) {
    for note in counted(notes) {
        console::say(format_args!("note: {about}{note}"));
    }
}

/// Each note once, with how often it was made.
pub fn counted(notes: &[String]) -> impl Iterator<Item = String> {
    folded(notes).into_iter().map(|(note, times)| match times {
        1 => note.to_owned(),
        _ => format!("{note} ({times} times)"),
    })
}

/// Notes that differ by the places and the number of their record alone are one: a test of 31 places has hundreds of
/// records.
fn folded(notes: &[String]) -> Vec<(&str, usize)> {
    let mut folded: Vec<(&str, usize)> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for note in notes {
        let numbered = note.split_once("record ").and_then(|(_, rest)| rest.split_once(": "));
        let text = match numbered {
            Some((number, text)) if number.bytes().all(|byte| byte.is_ascii_digit()) => text,
            _ => note,
        };
        let place = *places.entry(text).or_insert(folded.len());
        match folded.get_mut(place) {
            Some((_, times)) => *times += 1,
            None => folded.push((text, 1)),
        }
    }
    folded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_of_records_alike_are_said_once() {
        let notes =
            ["force at (0, 0): record 1: rounded", "hit 2 left out: double hit", "record 2: rounded"].map(String::from);
        assert_eq!(folded(&notes), [("rounded", 2), ("hit 2 left out: double hit", 1)]);
    }
}
