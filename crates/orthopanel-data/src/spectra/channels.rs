//! Which record is which channel, in which unit and direction.

use super::read_as::ReadAs;
pub(super) use crate::records::{Quantity, quantity, type_name};
use crate::{
    DataError, Direction, Motion, RecordedResponse, Unit,
    records::{Axis, Record},
    units::Measured,
};

/// Whether the test file tells what the sensor reads, by its quantity or its unit.
pub(super) fn is_declared(declared: &RecordedResponse) -> bool {
    declared.quantity.is_some() || declared.response_unit.is_some()
}

/// What the numbers of a record are to be multiplied with, and the motion that they then are, in SI and along the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Calibration {
    pub(super) factor: f64,
    pub(super) motion: Motion,
    /// Of the unit alone, without direction and sensitivity.
    pub(super) unit: f64,
}

/// Calibration of a record of motion against time.
///
/// # Errors
/// [`DataError::Channels`] as [`resolved`], and for a direction that is not along z and not declared.
pub(super) fn motion(
    record: &Record,
    declared: &RecordedResponse,
    directions: [i64; 2],
    notes: &mut Vec<String>,
) -> Result<Calibration, DataError> {
    let motion = motion_of(record, declared, notes)?;
    let unit = resolved(record, &record.numerator, Measured::Motion(motion), declared, notes)?;
    let factor = sign(record, directions, declared, notes)? * unit.to_si();
    Ok(Calibration { factor, motion, unit: declared.unit_read(Measured::Motion(motion), &unit) })
}

/// Factor of a record of force against time, to newtons, and that of its unit alone.
///
/// # Errors
/// [`DataError::Channels`] as [`resolved`].
pub(super) fn force(
    record: &Record,
    declared: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<(f64, f64), DataError> {
    let unit = resolved(record, &record.numerator, Measured::Force, declared, notes)?;
    Ok((unit.to_si(), declared.unit_read(Measured::Force, &unit)))
}

/// Calibration of a frequency response, motion over force.
///
/// # Errors
/// [`DataError::Channels`] as [`resolved`] of either channel, and for a direction that is not along z and not declared.
pub(super) fn response(
    record: &Record,
    declared: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<(Calibration, ReadAs), DataError> {
    let motion = motion_of(record, declared, notes)?;
    let directions = [record.response.direction, record.reference.direction];
    // Some writers put the whole quotient into the numerator's unit: then the denominator's says nothing more.
    let whole =
        Unit::parse(&record.numerator.unit).filter(|unit| unit.measured() == Some(Measured::MotionOverForce(motion)));
    let (to_si, [of_response, of_force]) = match whole {
        Some(unit) => {
            let [over, under] =
                [&declared.response_unit, &declared.force_unit].map(|unit| unit.as_ref().map(Unit::to_si));
            let due = over.unwrap_or(1.0) / under.unwrap_or(1.0);
            let is_other = (over.is_some() || under.is_some()) && (due / unit.to_si() - 1.0).abs() > 1e-4;
            if is_other && declared.quantity.is_none() {
                return Err(refused(
                    record,
                    format!(
                        "the record is in {:?}, the test file declares another unit: correct or drop it, or where the label is \
                         wrong declare quantity = \"{motion}\" too",
                        unit.to_string()
                    ),
                ));
            }
            if is_other {
                notes.push(format!(
                    "{}: unit {:?} of the frequency response passed over, as the test file declares another and a quantity",
                    record.at.key,
                    unit.to_string()
                ));
                (due, [over.unwrap_or(1.0), under.unwrap_or(1.0)])
            } else {
                if (unit.to_si() - 1.0).abs() > 1e-12 {
                    notes.push(format!("{}: brought from {unit} to ({})/N", record.at.key, motion.si_unit()));
                }
                (unit.to_si(), [unit.to_si(), 1.0])
            }
        }
        None => {
            let over = resolved(record, &record.numerator, Measured::Motion(motion), declared, notes)?;
            let under = resolved(record, &record.denominator, Measured::Force, declared, notes)?;
            let read = [(Measured::Motion(motion), &over), (Measured::Force, &under)];
            (over.to_si() / under.to_si(), read.map(|(measured, unit)| declared.unit_read(measured, unit)))
        }
    };
    let factor = sign(record, directions, declared, notes)? * to_si;
    let calibration = Calibration { factor, motion, unit: of_response };
    Ok((calibration, ReadAs { motion, response: of_response, force: of_force, turned: factor < 0.0 }))
}

impl RecordedResponse {
    /// SI units in one unit of a channel as it was read: where volts have a sensitivity, of what they stand for.
    fn unit_read(&self, measured: Measured, unit: &Unit) -> f64 {
        let (sensitivity, given) = match measured {
            Measured::Force => (self.force_sensitivity, &self.force_unit),
            _ => (self.response_sensitivity, &self.response_unit),
        };
        if sensitivity.is_some() { given.as_ref().map_or(1.0, Unit::to_si) } else { unit.to_si() }
    }
}

fn refused(record: &Record, problem: String) -> DataError {
    DataError::Channels { at: record.at.clone(), problem }
}

/// The motion that a record holds: as the test file declares, else as the record tells, else an acceleration.
fn motion_of(record: &Record, declared: &RecordedResponse, notes: &mut Vec<String>) -> Result<Motion, DataError> {
    let told = match quantity(&record.numerator) {
        Quantity::Motion(motion) => Some(motion),
        _ => None,
    };
    let by_unit = declared.response_unit.as_ref().and_then(Unit::motion);
    match (declared.quantity, by_unit, told) {
        (Some(declared), _, Some(told)) if declared != told => {
            notes
                .push(format!("{}: {told} by its type, taken as {declared}, as the test file declares", record.at.key));
            Ok(declared)
        }
        (Some(declared), ..) => Ok(declared),
        (None, Some(by_unit), Some(told)) if by_unit != told => {
            let unit = declared.response_unit.as_ref().map(Unit::to_string).unwrap_or_default();
            Err(refused(
                record,
                format!(
                    "the record holds a {told}, and response_unit = {unit:?} is a unit of {by_unit}: correct it, or where the record's \
                     type is wrong declare quantity = \"{by_unit}\" too"
                ),
            ))
        }
        (None, by_unit, told) => Ok(told.or(by_unit).unwrap_or(Motion::Acceleration)),
    }
}

/// One channel of a measurement as the test file may declare it.
struct Declared<'a> {
    unit: Option<&'a Unit>,
    unit_key: &'static str,
    sensitivity: Option<f64>,
    sensitivity_key: &'static str,
    /// What is measured, in messages.
    name: &'static str,
    /// Its unit in SI.
    si: &'static str,
}

impl<'a> Declared<'a> {
    fn of(measured: Measured, by: &'a RecordedResponse) -> Self {
        match measured {
            Measured::Motion(motion) | Measured::MotionOverForce(motion) => Self {
                unit: by.response_unit.as_ref(),
                unit_key: "response_unit",
                sensitivity: by.response_sensitivity,
                sensitivity_key: "response_sensitivity",
                name: motion.name(),
                si: motion.si_unit(),
            },
            _ => Self {
                unit: by.force_unit.as_ref(),
                unit_key: "force_unit",
                sensitivity: by.force_sensitivity,
                sensitivity_key: "force_sensitivity",
                name: "force",
                si: "N",
            },
        }
    }
}

/// The unit of an axis: as its label, dataset 164 and the test file tell, where these agree.
///
/// # Errors
/// [`DataError::Channels`] where they contradict each other, where a label is unknown, and for volts without a sensitivity.
fn resolved(
    record: &Record,
    axis: &Axis,
    measured: Measured,
    declared: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<Unit, DataError> {
    let Declared { unit: given, unit_key, sensitivity, sensitivity_key, name, si } = Declared::of(measured, declared);
    let (key, label) = (&record.at.key, axis.unit.as_str());
    let parsed = Unit::parse(label);
    let of_kind = |unit: &Unit, kind: Measured| unit.measured() == Some(kind);
    let recorded = parsed.as_ref().filter(|unit| of_kind(unit, measured));
    let volts = parsed.as_ref().filter(|unit| of_kind(unit, Measured::Voltage));
    let of_file = axis.unit_by_system(measured);

    if let Some(sensitivity) = sensitivity {
        if let Some(recorded) = recorded {
            let problem = format!("the {name} is in {:?}, not in volts: drop {sensitivity_key}", recorded.to_string());
            return Err(refused(record, problem));
        }
        let volt = volts.map_or(1.0, Unit::to_si);
        let (a_unit, unit) = given.map_or((1.0, si.to_owned()), |unit| (unit.to_si(), unit.to_string()));
        let text = format!("volts at {sensitivity} V a {unit}");
        notes.push(format!("{key}: {name} brought from {text} to {si}, as the test file declares"));
        let to_si = volt * a_unit / sensitivity;
        return Ok(match measured {
            Measured::Motion(motion) => Unit::of_motion(text, motion, to_si),
            _ => Unit::of_force(text, to_si),
        });
    }
    let unit = match (given, recorded, of_file) {
        (Some(given), Some(recorded), _) if !given.is_same(recorded) && declared.quantity.is_none() => {
            let problem = format!(
                "the record's {name} is in {label:?}, the test file declares another unit, {given}: correct or drop `{unit_key}`, or where \
                 the label is wrong declare quantity = \"acceleration\" too (or \"velocity\", \"displacement\")"
            );
            return Err(refused(record, problem));
        }
        (Some(given), recorded, _)
            if !label.is_empty() && !recorded.is_some_and(|recorded| given.is_same(recorded)) =>
        {
            notes.push(format!("{key}: unit {label:?} of the {name} read as {given}, as the test file declares"));
            given.clone()
        }
        (Some(given), ..) => given.clone(),
        // Gravities are no unit of dataset 164; what is in them has its own label beside it.
        (None, Some(recorded), Some(of_file)) if !recorded.is_same(&of_file) && !is_gravity(recorded) => {
            let problem = format!(
                "the {name} is in {label:?} by its label, and in {of_file} by the file's dataset 164: declare which by {unit_key} = \
                 \"{recorded}\" in its [[measurement]], or another unit"
            );
            return Err(refused(record, problem));
        }
        (None, Some(recorded), _) => recorded.clone(),
        (None, None, _) if volts.is_some() => {
            let problem = format!(
                "the {name} is in volts ({label:?}): give {sensitivity_key} = V a {si} in its [[measurement]]; with {unit_key} it is V a \
                 unit of that"
            );
            return Err(refused(record, problem));
        }
        (None, None, _) if !label.is_empty() => {
            return Err(refused(record, unknown(label, parsed.as_ref(), (name, unit_key, si))));
        }
        (None, None, Some(of_file)) => of_file,
        (None, None, None) => {
            // Whatever a hammer is calibrated in, its record mostly says nothing.
            if measured != Measured::Force {
                notes.push(format!("{key}: unit of the {name} not told, taken as {si}"));
            }
            return Ok(match measured {
                Measured::Motion(motion) => Unit::of_motion(si.into(), motion, 1.0),
                _ => Unit::of_force(si.into(), 1.0),
            });
        }
    };
    if (unit.to_si() - 1.0).abs() > 1e-12 {
        notes.push(format!("{key}: {name} brought from {unit} to {si}"));
    }
    Ok(unit)
}

fn is_gravity(unit: &Unit) -> bool {
    Unit::parse("g").is_some_and(|gravity| gravity.is_same(unit))
}

/// What to say of a label that is no unit of the channel.
fn unknown(label: &str, parsed: Option<&Unit>, (name, unit_key, si): (&str, &str, &str)) -> String {
    match parsed.and_then(Unit::motion) {
        Some(motion) if unit_key == "response_unit" => format!(
            "{label:?} is a unit of {motion}, and the record is taken as {name}: declare quantity = \"{motion}\" in its \
             [[measurement]], or {unit_key} as it is"
        ),
        _ => format!(
            "unit {label:?} of the {name} is unknown: where it is {si}, or another unit under a name of its own, declare {unit_key} = \
             \"{si}\" in its [[measurement]]; else export the record in {si}"
        ),
    }
}

/// 1, or -1 where the motion counts against the force, by the directions of motion and force or as the test file declares.
fn sign(
    record: &Record,
    [motion, force]: [i64; 2],
    declared: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<f64, DataError> {
    for (channel, number) in [("motion", motion), ("force", force)] {
        let along = match number.abs() {
            0 | 3 => continue,
            1 => "x",
            2 => "y",
            4..=6 => {
                let problem = format!("direction {number} of the {channel} is a rotation, no motion along z");
                return Err(refused(record, problem));
            }
            _ => {
                let problem = format!("direction {number} of the {channel} is none: 3 and -3 are along z");
                return Err(refused(record, problem));
            }
        };
        if declared.direction.is_none() {
            return Err(refused(
                record,
                format!(
                    "direction {number} of the {channel} is along {along}, bending moves along z (3): where the sensor did \
                     stand along the force, declare direction = 1 (or -1, turned round) in the test file; else take the \
                     record out"
                ),
            ));
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
    Ok(if reversed { -1.0 } else { 1.0 })
}
