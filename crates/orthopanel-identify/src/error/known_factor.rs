//! A factor on records, known by its value: units that were mistaken for others, and sensors turned round.

use orthopanel_data::Unit;

/// What a motion is taken to be in, the SI unit first.
const MOTIONS: [&str; 5] = ["m/s2", "g", "mm/s2", "in/s2", "ft/s2"];
/// The same of a force.
const FORCES: [&str; 4] = ["N", "lbf", "kN", "kgf"];

/// Each unit with its factor to SI.
fn with_factors(units: &'static [&'static str]) -> impl Iterator<Item = (&'static str, f64)> {
    units.iter().filter_map(|unit| Some((*unit, Unit::parse(unit)?.to_si())))
}

/// A factor within this part of a known one is that one: constants and mass make up for the rest.
const NEAR: f64 = 0.05;

/// What a factor that records lack comes from, and the line that mends it; of all records where `each`, else of one.
pub(super) fn cause_of(factor: f64, each: bool) -> String {
    known_cause(factor, each).unwrap_or_else(|| "a gain, a unit, or the mass of the piece".to_owned())
}

/// The same; `None` of a factor that is no unit's and no sign's.
pub(super) fn known_cause(factor: f64, each: bool) -> Option<String> {
    let measurement = if each { "each [[measurement]]" } else { "its [[measurement]]" };
    let turned = if factor < 0.0 { "the sensor turned round, direction = -1" } else { "" };
    let off = |known: f64| (factor.abs() / known).ln().abs();
    let mut known: Vec<(f64, usize, String)> = Vec::new();
    for (motion, over) in with_factors(&MOTIONS) {
        for (force, under) in with_factors(&FORCES) {
            let declared = [
                (over != 1.0).then(|| format!("response_unit = {motion:?}")),
                (under != 1.0).then(|| format!("force_unit = {force:?}")),
            ];
            let lines: Vec<String> = declared.into_iter().flatten().collect();
            known.push((off(over / under), lines.len(), format!("{} in {measurement}", lines.join(" and "))));
        }
    }
    // What is in SI, and was brought there once more by its label.
    let wrong = |label: &str, si: &str| format!("the label {label:?} corrected to {si}");
    for (motion, over) in with_factors(&MOTIONS).skip(1) {
        known.push((off(1.0 / over), 1, wrong(motion, "m/s2")));
    }
    for (force, under) in with_factors(&FORCES).skip(1) {
        known.push((off(under), 1, wrong(force, "N")));
    }
    known.retain(|(off, ..)| *off < NEAR);
    // The fewest mistakes first.
    known.sort_by(|a, b| a.1.cmp(&b.1).then(a.0.total_cmp(&b.0)));
    let least = known.first()?.1;
    let alike: Vec<&str> =
        known.iter().filter(|(_, count, _)| *count == least).map(|(.., lines)| lines.as_str()).collect();
    match (least, turned) {
        (0, "") => None,
        (0, turned) => Some(format!("{turned} in {measurement}")),
        (_, turned) => {
            let and = if turned.is_empty() { String::new() } else { format!(", and {turned}") };
            let units = alike.join(", or ");
            Some(format!(
                "by its value a unit that was taken for another: {units}{and}; where a label says otherwise correct it in the \
                 file, in CSV the column acceleration_g"
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_factors_are_known_by_their_value() {
        for (factor, said) in [
            (9.81, "response_unit = \"g\" in each"),
            (-1.0, "the sensor turned round, direction = -1 in each"),
            (0.0254, "response_unit = \"in/s2\""),
            (0.2248, "force_unit = \"lbf\""),
            (2.2046, "response_unit = \"g\" and force_unit = \"lbf\""),
            (0.102, "force_unit = \"kgf\" in each"),
            (0.102, "the label \"g\" corrected to m/s2"),
            (5.71e-3, "response_unit = \"in/s2\" and force_unit = \"lbf\""),
            (-9.8, "response_unit = \"g\" in each [[measurement]], and the sensor turned round"),
            (4.448, "the label \"lbf\" corrected to N"),
            (1.7, "a gain, a unit, or the mass"),
        ] {
            let found = cause_of(factor, true);
            let [first, ..] = said.split(" in each").collect::<Vec<_>>()[..] else { continue };
            assert!(found.contains(first), "{factor}: {found}");
        }
    }
}
