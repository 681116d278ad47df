//! A factor on records, known by its value and its slope over frequency: units and quantities that were mistaken for others, and
//! sensors turned round.

use orthopanel_data::{Motion, ReadAs, Unit};
use orthopanel_model::{GAIN, RECORD_GAIN, Readable};

/// What a force is taken to be in, the SI unit first.
const FORCES: [&str; 4] = ["N", "lbf", "kN", "kgf"];

/// The same of a motion.
fn motions(motion: Motion) -> &'static [&'static str] {
    match motion {
        Motion::Acceleration => &["m/s2", "g", "mm/s2", "in/s2", "ft/s2", "mg"],
        Motion::Velocity => &["m/s", "mm/s", "in/s", "ft/s"],
        Motion::Displacement => &["m", "mm", "um", "in", "mil"],
    }
}

/// Each unit with its factor to SI.
fn with_factors(units: &'static [&'static str]) -> impl Iterator<Item = (&'static str, f64)> {
    units.iter().filter_map(|unit| Some((*unit, Unit::parse(unit)?.to_si())))
}

/// Standard deviation of the gain of a chain that was calibrated: of sensitivities as their certificates have them.
pub(crate) const CALIBRATED: f64 = 0.005;
/// A factor is that of a unit within so many standard deviations of itself, ...
const WITHIN: f64 = 3.0;
/// ... and within this part, however little it is known: the factors of units and of their products lie a tenth apart.
const NEAR: f64 = 0.05;

/// What brings records to their model: a factor and $s^n$, with $n$ = `derivatives`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Factor {
    pub value: f64,
    pub derivatives: i8,
    /// Standard deviation of its logarithm, with that of the mass, on which it depends.
    pub std: f64,
}

impl Factor {
    /// How far a known factor may lie from this one to be it, as a logarithm.
    fn near(&self) -> f64 {
        (WITHIN * self.std.hypot(CALIBRATED)).min(NEAR)
    }

    /// The motion that the records hold.
    fn motion(&self, read: ReadAs) -> Option<Motion> {
        let order = i8::try_from(read.motion.derivatives()).ok()?.checked_add(self.derivatives)?;
        Motion::ALL.into_iter().find(|motion| i8::try_from(motion.derivatives()) == Ok(order))
    }

    /// These lines with that of the direction before them, where the sensor was turned round.
    fn turned(&self, read: ReadAs, lines: Option<String>) -> Option<String> {
        let turned = (self.value < 0.0).then(|| format!("direction = {}", if read.turned { 1 } else { -1 }));
        match (turned, lines) {
            (Some(turned), Some(lines)) => Some(format!("{turned} and {lines}")),
            (turned, lines) => turned.or(lines),
        }
    }
}

/// Whether two factors are one.
fn is_same(one: f64, other: f64) -> bool {
    (one / other).ln().abs() < 1e-4
}

/// The line of the test file that mends records.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mend {
    /// In their `[[measurement]]`.
    Measurement(String),
    /// There if need be, and for a factor that no unit is, a gain beside.
    Gain {
        /// In their `[[measurement]]`, if anything.
        measurement: Option<String>,
        /// What they are times the truth.
        gain: f64,
        /// Where the factor comes from.
        cause: String,
    },
}

impl Mend {
    /// Whether two records are mended by the same.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Gain { measurement, gain, .. }, Self::Gain { measurement: beside, gain: second, .. }) => {
                measurement == beside && (gain / second).ln().abs() < NEAR
            }
            _ => self == other,
        }
    }

    /// What to write, and where; of all records, or of those with these names and numbers. A plate takes no `[[effect]]`: `plate` is its
    /// mass per area \[kg/m²\].
    pub(crate) fn lines(&self, records: &Option<Vec<String>>, numbers: Option<&[usize]>, plate: Option<f64>) -> String {
        let there = |lines: &str| format!("{lines} in {}", in_which(records));
        match self {
            Self::Measurement(lines) => there(lines),
            Self::Gain { measurement, gain, cause } => {
                let plain = (1e-3..1e4).contains(gain);
                let gain_text = if plain { format!("{gain:.4}") } else { format!("{gain:.4e}") };
                if let Some(mass) = plate {
                    let measurement = measurement.as_ref().map_or(String::new(), |lines| there(lines) + ", and ");
                    return format!(
                        "{measurement}mass_per_area = {:.4} in [piece] where the mass is wrong, else divide the motions by {gain_text} in the \
                         files ({cause})",
                        Readable(mass / gain)
                    );
                }
                let gain = format!("gain = {gain_text}");
                let effects = match numbers {
                    None => format!("an [[effect]] with id = \"{GAIN}\" and {gain}"),
                    Some(numbers) => {
                        let each = |number: &usize| {
                            format!("an [[effect]] with id = \"{RECORD_GAIN}\" and {gain} and record = {number}")
                        };
                        numbers.iter().map(each).collect::<Vec<_>>().join(" and ")
                    }
                };
                let measurement = measurement.as_ref().map_or(String::new(), |lines| there(lines) + ", and ");
                format!("{measurement}{effects} ({cause})")
            }
        }
    }
}

/// What mends records which were read as `read` and are right times this factor and $s^n$; `None` where nothing is wrong, or no unit,
/// quantity or sign makes it so.
pub(crate) fn mend(due: Factor, read: ReadAs) -> Option<Mend> {
    let Factor { value: factor, derivatives, .. } = due;
    let near = due.near();
    let motion = due.motion(read)?;
    match units((factor, near), derivatives, (motion, read)) {
        Some(Units { lines, .. }) => {
            due.turned(read, Some(lines).filter(|lines| !lines.is_empty())).map(Mend::Measurement)
        }
        None => {
            let cause = conversion(factor.abs() * read.response / read.force, near)?;
            let is_read = derivatives == 0 && is_same(read.response, 1.0) && is_same(read.force, 1.0);
            let measurement = due.turned(read, (!is_read).then(|| in_si(motion, read)));
            Some(Mend::Gain { measurement, gain: read.force / (factor.abs() * read.response), cause })
        }
    }
}

/// The lines of SI units, whatever was read.
fn in_si(motion: Motion, read: ReadAs) -> String {
    let force = if is_same(read.force, 1.0) { "" } else { " and force_unit = \"N\"" };
    format!("quantity = \"{motion}\" and response_unit = \"{}\"{force}", motions(motion)[0])
}

/// The units and the quantity that are due.
struct Units {
    /// As lines, empty where those that were read are.
    lines: String,
    /// In how many of the two units those that were read are mistaken.
    mistakes: usize,
    /// How far they lie from the factor, as a logarithm.
    off: f64,
}

/// Those that a factor is nearest to; `None` where none fit.
fn units((factor, near): (f64, f64), derivatives: i8, (motion, read): (Motion, ReadAs)) -> Option<Units> {
    // What one unit of the record's own numbers is worth.
    let worth = factor.abs() * read.response / read.force;
    let mut known: Vec<((usize, bool, f64), String)> = Vec::new();
    for (over, to_si) in with_factors(motions(motion)) {
        for (under, newtons) in with_factors(&FORCES) {
            let off = (worth / (to_si / newtons)).ln().abs();
            let is_response_right = is_same(to_si, read.response) || (derivatives != 0 && to_si == 1.0);
            let is_force_right = is_same(newtons, read.force);
            let mut lines = String::new();
            if !(is_response_right && is_force_right && derivatives == 0) {
                // With a quantity the test file decides, whatever labels say.
                lines = format!("quantity = \"{motion}\" and response_unit = {over:?}");
                if !is_force_right || newtons != 1.0 {
                    lines += &format!(" and force_unit = {under:?}");
                }
            }
            if off < near {
                let mistakes = usize::from(!is_response_right) + usize::from(!is_force_right);
                known.push(((mistakes, !is_force_right, off), lines));
            }
        }
    }
    // The fewest mistakes first; a sensor's unit is mistaken more often than a hammer's.
    known.sort_by(|(a, _), (b, _)| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    let (mistakes, _, off) = known.first()?.0;
    let alike: Vec<&str> = known.iter().filter(|(of, _)| of.0 == mistakes).map(|(_, lines)| lines.as_str()).collect();
    Some(Units { lines: alike.join(", or "), mistakes, off })
}

/// Units that programs convert from and to, with what one is worth in SI: of motions, and of forces.
const CONVERTED: [&[&str]; 2] = [&["m/s2", "g", "mm/s2", "in/s2", "ft/s2"], &["N", "lbf", "kN", "kgf"]];

/// The conversion between two units that a factor is, done once too often or not at all before the file was written; `None` where it is
/// none.
fn conversion(factor: f64, near: f64) -> Option<String> {
    let pairs = |units: &'static [&'static str]| {
        with_factors(units).flat_map(move |(from, own)| {
            with_factors(units).filter(move |(to, _)| *to != from).map(move |(to, other)| (own / other, from, to))
        })
    };
    let [motions, forces] = CONVERTED.map(|units| pairs(units).collect::<Vec<_>>());
    let is_near = |of: f64| (factor / of).ln().abs() < near;
    let said = |(_, from, to): &(f64, &str, &str)| format!("{from} converted as {to}");
    let one = motions.iter().chain(&forces).find(|(of, ..)| is_near(*of));
    // Both at once from SI: any two of all pairs would come near to any number.
    let from_si = |(_, from, _): &&(f64, &str, &str)| ["m/s2", "N"].contains(from);
    let both = || motions.iter().filter(from_si).flat_map(|a| forces.iter().filter(from_si).map(move |b| (a, b)));
    let two = || both().find(|(a, b)| is_near(a.0 / b.0));
    one.map(said).or_else(|| two().map(|(a, b)| format!("{} and {}", said(a), said(b))))
}

/// The gain that explains records which are right times $s^n$ and a factor that no unit has, with the unit that comes nearest; `None` where
/// no quantity has that slope.
pub(crate) fn gain_of_no_unit(due: Factor, read: ReadAs) -> Option<Mend> {
    let motion = due.motion(read)?;
    let nearest = units((due.value, NEAR), due.derivatives, (motion, read)).filter(|near| near.mistakes == 1);
    let beside = |Units { lines, off, .. }| format!("; {lines} would leave {:.1} %", 100.0 * off);
    let cause = format!("a sensitivity, or the mass of the piece{}", nearest.map_or(String::new(), beside));
    let (measurement, worth) = match due.derivatives {
        0 => (None, 1.0),
        _ => (Some(in_si(motion, read)), read.response / read.force),
    };
    Some(Mend::Gain { measurement: due.turned(read, measurement), gain: 1.0 / (due.value.abs() * worth), cause })
}

/// What a factor that one record lacks comes from.
pub(super) fn cause_of(factor: f64) -> String {
    match mend(Factor { value: factor, derivatives: 0, std: 0.0 }, ReadAs::SI) {
        Some(Mend::Measurement(lines)) => format!("write {lines} in its [[measurement]]"),
        _ => "a gain, a unit, or the mass of the piece".to_owned(),
    }
}

/// Where to write what mends records.
fn in_which(records: &Option<Vec<String>>) -> String {
    match records.as_deref() {
        None => "each [[measurement]]".to_owned(),
        Some([one]) => format!("the [[measurement]] of {one}"),
        Some(several) => format!("each [[measurement]] of {}", several.join("; ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of the measurement alone.
    fn mending_lines(factor: f64, derivatives: i8, read: ReadAs) -> Option<String> {
        match mend(Factor { value: factor, derivatives, std: 0.0 }, read)? {
            Mend::Measurement(lines) => Some(lines),
            Mend::Gain { measurement, gain, cause } => Some(format!("{measurement:?} gain = {gain}: {cause}")),
        }
    }

    /// What no unit is, a conversion too many or too few.
    #[test]
    fn val_conversions_are_gains() {
        for (factor, derivatives, gain, said) in [
            (25.4, 0, 1.0 / 25.4, "in/s2 converted as mm/s2"),
            (1000.0, 0, 1e-3, "m/s2 converted as mm/s2"),
            (4.448, 0, 1.0 / 4.448, "lbf converted as N"),
            (39.37, 1, 0.0254, "m/s2 converted as in/s2"),
        ] {
            match mend(Factor { value: factor, derivatives, std: 0.0 }, ReadAs::SI) {
                Some(Mend::Gain { measurement, gain: found, cause }) => {
                    assert!((found / gain - 1.0).abs() < 1e-3 && cause.contains(said), "{factor}: {found} {cause}");
                    assert_eq!(measurement.is_some(), derivatives != 0, "{measurement:?}");
                }
                other => panic!("{factor}: {other:?}"),
            }
        }
    }

    #[test]
    fn val_factors_are_known_by_their_value() {
        for (factor, said) in [
            (9.81, "response_unit = \"g\""),
            (-1.0, "direction = -1"),
            (0.0254, "response_unit = \"in/s2\""),
            (0.2248, "force_unit = \"lbf\""),
            (2.2046, "response_unit = \"g\" and force_unit = \"lbf\""),
            (0.102, "force_unit = \"kgf\""),
            (5.71e-3, "response_unit = \"in/s2\" and force_unit = \"lbf\""),
            (-9.8, "direction = -1 and quantity = \"acceleration\" and response_unit = \"g\""),
            (1e-6, "response_unit = \"mm/s2\" and force_unit = \"kN\""),
            (2.2e-3, "response_unit = \"mg\" and force_unit = \"lbf\""),
        ] {
            let found = mending_lines(factor, 0, ReadAs::SI).unwrap_or_default();
            assert!(found.contains(said), "{factor}: {found}");
        }
        for none in [1.7, 1.0, 1.03, 137.0] {
            assert_eq!(mending_lines(none, 0, ReadAs::SI), None, "{none}");
        }
        assert!(cause_of(1.7).contains("a gain, a unit, or the mass"));
    }

    /// A label or a declared unit that is wrong is told from what was read: the same factor means another line.
    #[test]
    fn val_what_was_read_counts() {
        let g = ReadAs { response: 9.80665, ..ReadAs::SI };
        let lbf = ReadAs { force: 4.448_222, ..ReadAs::SI };
        let turned = ReadAs { turned: true, ..ReadAs::SI };
        for (factor, read, said) in [
            (0.102, g, "quantity = \"acceleration\" and response_unit = \"m/s2\""),
            (4.448, lbf, "quantity = \"acceleration\" and response_unit = \"m/s2\" and force_unit = \"N\""),
            (-1.0, turned, "direction = 1"),
            (1e-3 / 9.80665, g, "response_unit = \"mm/s2\""),
        ] {
            let found = mending_lines(factor, 0, read).unwrap_or_default();
            assert!(found.contains(said), "{factor}: {found}");
        }
    }

    /// Products with $j\omega$ and $-\omega^2$.
    #[test]
    fn val_slopes_are_quantities() {
        let velocity = ReadAs { motion: Motion::Velocity, ..ReadAs::SI };
        for (factor, derivatives, read, said) in [
            (1.0, 1, ReadAs::SI, "quantity = \"velocity\" and response_unit = \"m/s\""),
            (1e-3, 1, ReadAs::SI, "quantity = \"velocity\" and response_unit = \"mm/s\""),
            (1.0, 2, ReadAs::SI, "quantity = \"displacement\" and response_unit = \"m\""),
            (0.0254 / 4.448_222, 2, ReadAs::SI, "response_unit = \"in\" and force_unit = \"lbf\""),
            (-0.0254, 1, ReadAs::SI, "direction = -1 and quantity = \"velocity\" and response_unit = \"in/s\""),
            (9.80665, -1, velocity, "quantity = \"acceleration\" and response_unit = \"g\""),
            (1.0, 1, velocity, "quantity = \"displacement\" and response_unit = \"m\""),
        ] {
            let found = mending_lines(factor, derivatives, read).unwrap_or_default();
            assert!(found.contains(said), "{factor} {derivatives}: {found}");
        }
        assert_eq!(mending_lines(1.0, -1, ReadAs::SI), None);
        assert_eq!(mending_lines(1.0, 2, velocity), None);
    }
}
