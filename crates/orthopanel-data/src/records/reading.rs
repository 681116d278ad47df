//! What a sensor may have read.

/// No sensor reads as much, in whatever unit. A spoilt byte in an exponent makes such values, whose squares are no numbers any more.
const NO_READING: f64 = 1e30;

/// Whether a sensor may have read this: a finite number below [`NO_READING`].
pub(super) fn may_be_read(value: f64) -> bool {
    value.abs() < NO_READING
}
