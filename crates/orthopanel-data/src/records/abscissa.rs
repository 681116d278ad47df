//! Times and frequencies in whatever unit the file has them.

use super::RecordKind;
use crate::{Unit, units::Measured};

/// Seconds or hertz in one unit of the abscissa, by its label.
pub(super) fn scale(label: &str, kind: RecordKind, key: &str, notes: &mut Vec<String>) -> f64 {
    let (wanted, si) = if kind == RecordKind::Time { (Measured::Time, "s") } else { (Measured::Frequency, "Hz") };
    match Unit::parse(label) {
        _ if label.is_empty() => 1.0,
        Some(unit) if unit.measured() == Some(wanted) => {
            if unit.to_si() != 1.0 {
                notes.push(format!("{key}: abscissa brought from {unit} to {si}"));
            }
            unit.to_si()
        }
        _ => {
            notes.push(format!("{key}: unit {label:?} of the abscissa is none of {wanted:?}, taken as {si}"));
            1.0
        }
    }
}

/// `value` times a factor; a small one divides, so that decimals stay decimals.
pub(super) fn scaled(value: f64, factor: f64) -> f64 {
    if factor < 1.0 { value / (1.0 / factor).round() } else { value * factor }
}
