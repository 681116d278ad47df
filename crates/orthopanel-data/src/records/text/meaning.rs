//! What a column holds, by its name and its unit.

use super::heading::unit_of;
use crate::{Motion, Unit, units::Measured};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    Time,
    Frequency,
    Force,
    Motion(Motion),
    Real,
    Imaginary,
    Magnitude,
    Phase,
    Coherence,
    Variance,
    DecayRate,
    /// A motion, as the test file declares, of whatever kind.
    Response,
    /// Not asked for.
    NotRead,
    /// Neither name nor unit tells.
    Untold,
}

impl Meaning {
    /// True for a time or a frequency.
    pub(super) fn is_abscissa(self) -> bool {
        matches!(self, Self::Time | Self::Frequency)
    }

    /// What was taken of a column's name, for the line that says what was assumed.
    pub(super) fn told(self) -> &'static str {
        match self {
            Self::Time => " (time)",
            Self::Frequency => " (frequency)",
            Self::Force => " (force)",
            Self::Motion(Motion::Acceleration) => " (acceleration)",
            Self::Motion(Motion::Velocity) => " (velocity)",
            Self::Motion(Motion::Displacement) => " (displacement)",
            Self::Real => " (real part)",
            Self::Imaginary => " (imaginary part)",
            Self::Magnitude => " (magnitude)",
            Self::Phase => " (phase)",
            Self::Coherence => " (coherence)",
            Self::Variance => " (variance)",
            Self::DecayRate => " (decay rate)",
            Self::Response => " (response)",
            Self::NotRead | Self::Untold => "",
        }
    }

    /// True for a part of a frequency response.
    pub(super) fn is_part_of_response(self) -> bool {
        matches!(self, Self::Real | Self::Imaginary | Self::Magnitude | Self::Phase | Self::Coherence)
    }
}

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    /// Its name, with the unit where that stands in it.
    pub(super) name: String,
    /// Its unit, as the file writes it; empty where it does not tell.
    pub(super) unit: String,
    pub(super) meaning: Meaning,
}

impl Column {
    /// Of a name, and a unit of a row of units; empty where there is none.
    pub(super) fn of(name: &str, unit: &str) -> Self {
        let (stem, own) = name_and_unit(name);
        let unit = match unit_of(unit) {
            Some(unit) => unit,
            None => own.as_deref().unwrap_or_default(),
        };
        let meaning = meaning(stem, unit);
        let is_part = matches!(meaning, Meaning::Real | Meaning::Imaginary | Meaning::Magnitude | Meaning::Phase);
        let unit = match unit {
            "-" => "",
            // The H of `Re(H)`.
            no_unit if is_part && unit_of(no_unit).is_none() => "",
            "" if stem.to_lowercase().starts_with("volt") => "V",
            told => told,
        };
        Self { name: name.to_owned(), unit: unit.to_owned(), meaning }
    }
}

/// A name apart from the unit in it: `Time (s)`, `Force [N]`, `t / s`, `Weg in mm`, `acceleration_m_s2`.
fn name_and_unit(name: &str) -> (&str, Option<String>) {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inner) = name.strip_suffix(close) {
            // The bracket that this one closes.
            let mut depth = 1;
            let start = inner.char_indices().rev().find(|(_, character)| {
                depth += i32::from(*character == close) - i32::from(*character == open);
                depth == 0
            });
            if let Some((start, _)) = start {
                let (stem, unit) = (inner.get(..start).unwrap_or_default(), inner.get(start + 1..).unwrap_or_default());
                return (stem.trim(), Some(unit.trim().to_owned()));
            }
        }
    }
    for between in [" / ", " in "] {
        if let Some((stem, unit)) = name.rsplit_once(between).filter(|(_, unit)| unit_of(unit).is_some()) {
            return (stem.trim(), Some(unit.trim().to_owned()));
        }
    }
    // As this project's own names have it.
    match name.split_once('_') {
        Some((stem, suffix)) => {
            let unit = match suffix {
                "n" => "N".to_owned(),
                "hz" => "Hz".to_owned(),
                other => other.replacen('_', "/", 1),
            };
            if unit_of(&unit).is_some() { (stem, Some(unit)) } else { (name, None) }
        }
        None => (name, None),
    }
}

/// A name without the unit in it.
pub(crate) fn stem(name: &str) -> &str {
    name_and_unit(name).0
}

/// Metres in one unit of a length; one where the text names none.
pub(super) fn metres(unit: &str) -> f64 {
    let unit = Unit::parse(unit).filter(|unit| unit.motion() == Some(Motion::Displacement));
    unit.map_or(1.0, |unit| unit.to_si())
}

/// What a name without its unit says, else what the unit does.
fn meaning(stem: &str, unit: &str) -> Meaning {
    let lower = stem.to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let is = |names: &[&str]| words.iter().any(|word| names.contains(word));
    let begins = |starts: &[&str]| words.iter().any(|word| starts.iter().any(|start| word.starts_with(start)));
    let measured = Unit::parse(unit).and_then(|unit| unit.measured());
    let is_level = unit.get(..2).is_some_and(|start| start.eq_ignore_ascii_case("db"));
    // |Y|
    let is_size = stem.len() > 2 && stem.starts_with('|') && stem.ends_with('|');
    if begins(&["coher"]) || is(&["coh", "gamma2"]) {
        Meaning::Coherence
    } else if begins(&["imag"]) || is(&["im"]) {
        Meaning::Imaginary
    } else if is(&["real", "re"]) {
        Meaning::Real
    } else if begins(&["phase", "angle"]) || is(&["arg", "ph"]) {
        Meaning::Phase
    } else if begins(&["magn", "ampl", "betrag"]) || is(&["mag", "abs", "modulus", "level"]) || is_level || is_size {
        Meaning::Magnitude
    } else if is(&["variance", "var"]) {
        Meaning::Variance
    } else if lower == "decay" || lower.starts_with("decay_rate") {
        Meaning::DecayRate
    } else if begins(&["force", "hammer", "kraft", "impact", "impuls"]) || stem == "F" {
        Meaning::Force
    } else if begins(&["acc", "beschl"]) {
        Meaning::Motion(Motion::Acceleration)
    } else if begins(&["veloc", "geschw"]) || is(&["vel"]) {
        Meaning::Motion(Motion::Velocity)
    } else if begins(&["displ", "deflection"]) || is(&["disp", "weg"]) {
        Meaning::Motion(Motion::Displacement)
    } else if begins(&["freq"]) || is(&["hz"]) || stem == "f" {
        Meaning::Frequency
    } else if begins(&["time", "zeit"]) || is(&["t", "temps", "tiempo", "sec", "seconds"]) || lower == "x_value" {
        Meaning::Time
    } else {
        match measured {
            Some(Measured::Time) => Meaning::Time,
            Some(Measured::Frequency) => Meaning::Frequency,
            Some(Measured::Force) => Meaning::Force,
            Some(Measured::Motion(motion)) => Meaning::Motion(motion),
            _ => Meaning::Untold,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_columns_are_known_as_people_name_them() {
        for (name, unit, meaning, told) in [
            ("time_s", "", Meaning::Time, "s"),
            ("frequency_hz", "", Meaning::Frequency, "Hz"),
            ("force_n", "", Meaning::Force, "N"),
            ("acceleration_m_s2", "", Meaning::Motion(Motion::Acceleration), "m/s2"),
            ("acceleration_g", "", Meaning::Motion(Motion::Acceleration), "g"),
            ("decay_rate_1_s", "", Meaning::DecayRate, ""),
            ("Time (s)", "", Meaning::Time, "s"),
            ("t / ms", "", Meaning::Time, "ms"),
            ("Zeit", "[s]", Meaning::Time, "s"),
            ("Impact Hammer [N]", "", Meaning::Force, "N"),
            ("Ch 1", "(lbf)", Meaning::Force, "lbf"),
            ("Weg in mm", "", Meaning::Motion(Motion::Displacement), "mm"),
            ("Ch 2", "m/s²", Meaning::Motion(Motion::Acceleration), "m/s²"),
            ("FRF real ((m/s^2)/N)", "", Meaning::Real, "(m/s^2)/N"),
            ("Im(H)", "", Meaning::Imaginary, ""),
            ("Magnitude", "dB", Meaning::Magnitude, "dB"),
            ("|Y| / (mm/s)/N", "", Meaning::Magnitude, "(mm/s)/N"),
            ("|H| [dB]", "", Meaning::Magnitude, "dB"),
            ("Phase (deg)", "", Meaning::Phase, "deg"),
            ("X_Value", "", Meaning::Time, ""),
            ("Voltage_0", "", Meaning::Untold, "V"),
        ] {
            let found = Column::of(name, unit);
            assert_eq!((found.meaning, found.unit.as_str()), (meaning, told), "{name}");
        }
    }
}
