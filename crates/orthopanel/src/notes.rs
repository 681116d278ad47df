//! What the layers below have to say about the records, for people.

use std::collections::HashMap;

use crate::Observer;

/// Says each note once, behind `about`, with how often it was made.
pub fn note(observer: &dyn Observer, about: &str, notes: &[String]) {
    for note in counted(notes) {
        observer.say(&format!("note: {about}{note}"));
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
        let placed = note.split_once(": ").filter(|(before, _)| is_pair_of_places(before));
        let text = match (numbered, placed) {
            (Some((number, text)), _) if number.bytes().all(|byte| byte.is_ascii_digit()) => text,
            (_, Some((_, text))) => text,
            _ => note,
        };
        let place = *places.entry(text).or_insert(folded.len());
        match folded.get_mut(place) {
            Some((said, times)) => (*said, *times) = (text, *times + 1),
            // What is said once keeps its place.
            None => folded.push((note, 1)),
        }
    }
    folded
}

/// `force at (-0.3, 0), response at (0.3, 0)`, or `-0.3 to 0.3`.
fn is_pair_of_places(text: &str) -> bool {
    let is_place = |text: &str| text.trim_matches(['(', ')']).split(", ").all(|number| number.parse::<f64>().is_ok());
    match text.strip_prefix("force at ").and_then(|rest| rest.split_once(", response at ")) {
        Some((force, response)) => is_place(force) && is_place(response),
        None => text.split_once(" to ").is_some_and(|(force, response)| is_place(force) && is_place(response)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_of_records_alike_are_said_once() {
        let notes =
            ["force at (0, 0): record 1: rounded", "hit 2 left out: double hit", "record 2: rounded"].map(String::from);
        assert_eq!(folded(&notes), [("rounded", 2), ("hit 2 left out: double hit", 1)]);
        let pair = |x: &str, note: &str| format!("force at (-0.3, 0), response at ({x}, 0): {note}");
        let notes =
            [pair("0.3", "columns"), pair("0.3", "odd"), pair("0.1", "columns"), "0.2 to 0.3: columns".to_owned()];
        assert_eq!(folded(&notes), [("columns", 3), (&*notes[1], 1)]);
    }
}
