//! Which record is which channel, in which unit and direction.

use crate::{
    AccelerationUnit, DataError, Direction, RecordedResponse,
    records::{ACCELERATION, Axis, FORCE, Record},
};

/// What an axis of a record measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Force,
    Acceleration,
    /// Displacement, velocity, strain, ...: by its data type.
    Other(i64),
    /// The file does not tell.
    Untold,
}

/// The quantity of an axis, by its data type, or by its unit where that is not set.
pub(super) fn quantity(axis: &Axis) -> Quantity {
    match axis.data_type {
        ACCELERATION => Quantity::Acceleration,
        // 9 is a reaction force; analysers give it to hammers too.
        FORCE | 9 => Quantity::Force,
        0 | 1 => match plain(&axis.unit).as_str() {
            "" => Quantity::Untold,
            "n" | "newton" => Quantity::Force,
            unit if acceleration_unit(unit).is_some() => Quantity::Acceleration,
            _ => Quantity::Untold,
        },
        other => Quantity::Other(other),
    }
}

/// What a specific data type of a universal file is called, in brackets; nothing for a rare one.
pub(super) fn type_name(kind: i64) -> &'static str {
    match kind {
        2 => " (stress)",
        3 => " (strain)",
        8 => " (displacement)",
        11 => " (velocity)",
        15 => " (pressure)",
        _ => "",
    }
}

/// Checks that a force is in newtons, or that its unit is not told.
///
/// # Errors
/// [`DataError::Channels`] for another unit.
pub(super) fn check_force_unit(record: &Record, axis: &Axis) -> Result<(), DataError> {
    match plain(&axis.unit).as_str() {
        "" | "n" | "newton" => Ok(()),
        _ => {
            let problem = format!("the force is in {:?}: only N is read, export the record in N", axis.unit);
            Err(DataError::Channels { at: record.at.clone(), problem })
        }
    }
}

/// Factor that brings the acceleration to m/s² along the force, by unit and direction as the test file declares them,
/// else as the record does. `directions` are those of motion and force in the record.
///
/// # Errors
/// [`DataError::Channels`] for a direction that is not along z and not declared, and where declared and recorded unit contradict each other, or none of them is known.
pub(super) fn acceleration_factor(
    record: &Record,
    axis: &Axis,
    directions: [i64; 2],
    declared: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<f64, DataError> {
    let refused = |problem: String| DataError::Channels { at: record.at.clone(), problem };
    let text = plain(&axis.unit);
    // Some writers put the whole quotient into the numerator's unit.
    let text = text.strip_suffix("/n").map_or(text.as_str(), |motion| motion.trim_matches(['(', ')']));
    let recorded = acceleration_unit(text);
    let unit = match (declared.unit, recorded) {
        (Some(declared), Some(recorded)) if declared != recorded => {
            return Err(refused(format!(
                "the record's acceleration is in {:?}, the test file declares another unit: correct or drop `unit`",
                axis.unit
            )));
        }
        (Some(declared), None) if !text.is_empty() => {
            let (key, found) = (&record.at.key, &axis.unit);
            notes.push(format!(
                "{key}: unit {found:?} of the acceleration read as {declared}, as the test file declares"
            ));
            declared
        }
        (Some(declared), _) => declared,
        (None, Some(recorded)) => recorded,
        (None, None) if text.is_empty() => {
            notes.push(format!("{}: unit of the acceleration not told, taken as m/s2", record.at.key));
            AccelerationUnit::MetrePerSecondSquared
        }
        (None, None) => {
            let found = &axis.unit;
            return Err(refused(format!(
                "unit {found:?} of the acceleration is unknown: export the record in m/s2 or g; where it is one of these \
                 under another name, declare unit = \"m/s2\" or \"g\" in the test file"
            )));
        }
    };
    if unit == AccelerationUnit::StandardGravity {
        notes.push(format!("{}: acceleration brought from g to m/s2", record.at.key));
    }
    let [motion, force] = directions;
    for (channel, number) in [("motion", motion), ("force", force)] {
        let along = match number.abs() {
            0 | 3 => continue,
            1 => "x",
            2 => "y",
            4..=6 => {
                return Err(refused(format!("direction {number} of the {channel} is a rotation, no motion along z")));
            }
            _ => return Err(refused(format!("direction {number} of the {channel} is none: 3 and -3 are along z"))),
        };
        if declared.direction.is_none() {
            return Err(refused(format!(
                "direction {number} of the {channel} is along {along}, bending moves along z (3): where the sensor did \
                 stand along the force, declare direction = 1 (or -1, turned round) in the test file; else take the \
                 record out"
            )));
        }
        notes.push(format!(
            "{}: direction {number} of the {channel} is along {along}, taken as the test file declares",
            record.at.key
        ));
    }
    let against = motion.signum() * force.signum() < 0;
    let reversed = match declared.direction {
        Some(direction) => direction == Direction::AgainstForce,
        None => against,
    };
    match (declared.direction, against) {
        (None, true) => notes.push(format!(
            "{}: motion and force are recorded in opposite directions ({motion} and {force}): turned round",
            record.at.key
        )),
        (Some(Direction::AlongForce), true) => notes.push(format!(
            "{}: recorded directions {motion} and {force} are opposite, the test file declares 1: not turned round",
            record.at.key
        )),
        (Some(Direction::AgainstForce), _) => {
            notes.push(format!("{}: turned round, as the test file declares", record.at.key))
        }
        _ => {}
    }
    Ok(if reversed { -unit.to_si() } else { unit.to_si() })
}

fn acceleration_unit(plain: &str) -> Option<AccelerationUnit> {
    match plain {
        // Universal files are ASCII: a raised 2 in them reads as one or two unknown characters.
        "m/s2" | "m/s/s" | "ms-2" | "m.s-2" | "m/sec2" | "m/s?" | "m/s??" => {
            Some(AccelerationUnit::MetrePerSecondSquared)
        }
        "g" | "gn" | "g's" => Some(AccelerationUnit::StandardGravity),
        _ => None,
    }
}

/// A unit without blanks, marks of powers and capitals.
fn plain(unit: &str) -> String {
    unit.to_lowercase().replace([' ', '^', '*', '[', ']'], "").replace('²', "2")
}
