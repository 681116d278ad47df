//! What an axis of a record measures.

use super::{Axis, data_type};
use crate::{Motion, Unit, units::Measured};

/// What an axis of a record measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Force,
    Motion(Motion),
    /// Strain, pressure, ...: by its data type.
    Other(i64),
    /// The file does not tell.
    Untold,
}

/// The quantity of an axis, by its data type, or by its unit where that is not set.
pub(crate) fn quantity(axis: &Axis) -> Quantity {
    match axis.data_type {
        data_type::ACCELERATION => Quantity::Motion(Motion::Acceleration),
        data_type::VELOCITY => Quantity::Motion(Motion::Velocity),
        data_type::DISPLACEMENT => Quantity::Motion(Motion::Displacement),
        data_type::FORCE | data_type::REACTION_FORCE => Quantity::Force,
        0 | 1 => match Unit::parse(&axis.unit).and_then(|unit| unit.measured()) {
            Some(Measured::Force) => Quantity::Force,
            Some(Measured::Motion(motion) | Measured::MotionOverForce(motion)) => Quantity::Motion(motion),
            _ => Quantity::Untold,
        },
        other => Quantity::Other(other),
    }
}

/// What a specific data type of a universal file is called, in brackets; nothing for a rare one.
pub(crate) fn type_name(kind: i64) -> &'static str {
    match kind {
        2 => " (stress)",
        3 => " (strain)",
        15 => " (pressure)",
        _ => "",
    }
}
