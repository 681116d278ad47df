//! Record 6 of the header: nodes and directions beside the names of entities, which push them along where they are long.

use super::line::field;
use crate::records::Port;

/// Columns of the definition, $2(I5,I10),\,2(1X,10A1,I10,I4)$.
const COLUMNS: usize = 80;

/// Response and reference of the line, and what had to be assumed.
///
/// A name of more than ten characters moves all that follows: then numbers are counted from the line's end.
pub(super) fn of_line(line: &str) -> ([Port; 2], Option<String>) {
    let line = line.trim_end();
    if line.len() <= COLUMNS
        && let Some(ports) = by_columns(line)
    {
        return (ports, None);
    }
    match from_the_end(line) {
        Some(ports) => {
            let [response, reference] = ports.map(|port| port.node);
            let note = format!(
                "names of entities are longer than their columns: nodes {response} and {reference} counted from the line's end"
            );
            (ports, Some(note))
        }
        None => {
            let note = "nodes and directions stand in other columns than the definition's, and are left out".into();
            ([Port::default(); 2], Some(note))
        }
    }
}

/// By the definition's columns; `None` where something else than numbers stands there.
fn by_columns(line: &str) -> Option<[Port; 2]> {
    let number = |from: usize, width: usize| field(line, from, width).map_or(Some(0), |text| text.parse().ok());
    let port = |node: usize, direction: usize| Some(Port { node: number(node, 10)?, direction: number(direction, 4)? });
    // A number before its columns is part of a name, or the end of a longer one.
    let apart = [30, 55].iter().all(|&column| matches!(line.as_bytes().get(column), None | Some(b' ')));
    apart.then_some([port(41, 51)?, port(66, 76)?])
}

/// By words: `... NAME node direction NAME node direction`, a name of any length and number of words, but with no number alone.
fn from_the_end(line: &str) -> Option<[Port; 2]> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let number = |word: &&str| word.parse::<i64>().ok();
    let pair = |end: usize| {
        let [node, direction] = words.get(end.checked_sub(2)?..end)? else { return None };
        Some(Port { node: number(node)?, direction: number(direction)? })
    };
    let reference = pair(words.len())?;
    let names = words.get(..words.len() - 2)?;
    let end = names.iter().rposition(|word| number(word).is_some())? + 1;
    // The function's four numbers and a name come before.
    (end >= 7 && end < names.len()).then_some([pair(end)?, reference])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ports(line: &str) -> [(i64, i64); 2] {
        of_line(line).0.map(|port| (port.node, port.direction))
    }

    #[test]
    fn val_nodes_are_found_beside_names_of_any_length() {
        let due = [(12, 3), (7, -3)];
        for (response, reference) in [
            ("NONE", "NONE"),
            ("Panel", "Panel"),
            ("Entity name 12 letters", "Hammer"),
            ("Panel", "Impact Hammer"),
            ("Accelerometer12", "NONE"),
        ] {
            let line =
                format!("    4         0    0         0 {response:<10}        12   3 {reference:<10}         7  -3");
            assert_eq!(ports(&line), due, "{line:?}");
            let long = response.len() > 10 || reference.len() > 10;
            assert_eq!(of_line(&line).1.is_some(), long, "{line:?}");
        }
        assert_eq!(ports("    1         0    0         0                  5   3"), [(5, 3), (0, 0)]);
        assert_eq!(ports("    4"), [(0, 0); 2]);
    }

    /// A name that was cut short by one writer, and pushes the columns of another: nothing is made up.
    #[test]
    fn val_nodes_that_cannot_be_told_are_left_out() {
        let (found, note) =
            of_line("    4         0    0         0 a name without any number that one could count at all, for long");
        assert_eq!(found, [Port::default(); 2]);
        assert!(note.is_some_and(|note| note.contains("left out")));
    }
}
