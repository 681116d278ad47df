//! `docs/effects.md` tells every effect, its owner, and its parameters as they are.

use orthopanel_model::{EffectParameter, Piece, Scale, catalogue};

const DOCUMENT: &str = include_str!("../../../docs/effects.md");
/// Of length and mass one, so that parts of either are themselves.
const PIECE: Piece = Piece { length: 1.0, width: 1.0, thickness: 0.03, mass_per_area: 1.0 };

/// The rows of the table under a heading.
fn rows(heading: &str) -> Vec<&'static str> {
    let from = DOCUMENT.find(heading).unwrap_or_else(|| panic!("no heading {heading}"));
    let section = &DOCUMENT[from + heading.len()..];
    let end = section.find("\n## ").unwrap_or(section.len());
    section[..end].lines().filter(|line| line.starts_with("| `")).collect()
}

/// "`name` unit, low to high" somewhere in a row.
fn is_told(row: &str, parameter: &EffectParameter) -> bool {
    let Some(from) = row.find(&format!("`{}` {}", parameter.name, parameter.unit)) else { return false };
    // Anywhere on the piece, and a record's number, want no range.
    if parameter.scale == Scale::Index || ["x", "y"].contains(&parameter.name) {
        return true;
    }
    let told = row[from..].split([';', '|']).next().unwrap_or_default();
    let numbers: Vec<f64> = told.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    let (low, high) = parameter.range(&PIECE);
    let is = |number: f64, bound: f64| (number - bound).abs() <= 1e-9 * bound.abs();
    numbers.windows(2).any(|pair| is(pair[0], low) && is(pair[1], high))
}

#[test]
fn every_effect_is_told_with_its_parameters() {
    let mut told = 0;
    for (heading, owner) in
        [("## Of the panel", "panel"), ("## Of the rig", "rig"), ("## Of the measuring channel", "channel")]
    {
        let rows = rows(heading);
        told += rows.len();
        for effect in catalogue().iter().filter(|effect| effect.owner().name() == owner) {
            let name = format!("| `{}` |", effect.id());
            let row =
                rows.iter().find(|row| row.starts_with(&name)).unwrap_or_else(|| panic!("{name} under {heading}"));
            for parameter in effect.parameters() {
                let (low, high) = parameter.range(&PIECE);
                assert!(is_told(row, parameter), "{} {}: {low:e} to {high:e}: {row}", effect.id(), parameter.name);
            }
        }
    }
    assert_eq!(told, catalogue().len(), "a row for an effect that is none");
}
