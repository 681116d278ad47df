//! Numbers that may be set.

use crate::FmuError;

pub(super) fn finite(what: &str, value: f64) -> Result<(), FmuError> {
    if value.is_finite() { Ok(()) } else { Err(FmuError::NotFinite { what: what.into(), value }) }
}

/// Steps and times \[s\] end below, at a million million times the age of the universe: what a motion grows to in longer ones passes
/// the range of numbers, which traps in hosts that want it so.
pub(super) const TOO_LONG: f64 = 1e30;

#[cold]
pub(super) fn timely(what: &'static str, value: f64) -> Result<(), FmuError> {
    finite(what, value)?;
    if value.abs() < TOO_LONG { Ok(()) } else { Err(FmuError::TooLong { what, value, limit: TOO_LONG }) }
}

/// Largest force, force rate, state and seed that may be set, as a number: what a panel answers to it is a number, too.
const LARGEST_SET: f64 = 1e100;

/// Not so for what is no number.
#[inline(always)]
pub(super) fn fits(value: f64) -> bool {
    value.abs() <= LARGEST_SET
}

#[cold]
pub(super) fn fitting(what: &str, value: f64) -> Result<(), FmuError> {
    finite(what, value)?;
    let largest = LARGEST_SET;
    if fits(value) { Ok(()) } else { Err(FmuError::TooLarge { what: what.into(), value, largest }) }
}
