//! What a variable stands for.

use super::units;

pub(super) const HOLD: &str = "Held at the value set over each step, unless the importer gives its first derivative (FMI 2, for \
                    the next step) or force_linear is true";

/// What a variable stands for; ports are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The independent variable \[s\].
    Time,
    /// Parameter: does the force run linearly between the values set?
    ForceLinear,
    /// Input: force \[N\] at a force port; behind the last port what connections bring, in their own units.
    Input(usize),
    /// Output: acceleration \[m/s²\] at a response port.
    Acceleration(usize),
    /// Output: velocity \[m/s\] at a response port.
    Velocity(usize),
    /// Output: displacement \[m\] at a response port.
    Displacement(usize),
    /// Output of a connection, in its own unit.
    Connected(usize),
    /// Continuous state: coordinate $a$ of a mode \[m kg^1/2\]; modes are counted from 0, rigid ones first.
    ModalPosition(usize),
    /// Continuous state: $\dot a$ of a mode \[m kg^1/2/s\].
    ModalVelocity(usize),
    /// Derivative of [`Quantity::ModalPosition`] by time.
    ModalPositionRate(usize),
    /// Derivative of [`Quantity::ModalVelocity`] by time.
    ModalVelocityRate(usize),
    /// Parameter: a size, constant, damping ratio or place of the panel, counted from 0 as in the table.
    Parameter(usize),
}

impl Quantity {
    /// Name of the unit; `None` for a Boolean, and for what has one of its own.
    pub(super) fn unit(self) -> Option<&'static str> {
        match self {
            Self::Time => Some("s"),
            Self::ForceLinear | Self::Parameter(_) | Self::Connected(_) => None,
            Self::Input(_) => Some("N"),
            Self::Acceleration(_) => Some("m/s2"),
            Self::Velocity(_) => Some("m/s"),
            Self::Displacement(_) => Some("m"),
            Self::ModalPosition(_) => Some(units::MODAL_POSITION),
            Self::ModalVelocity(_) | Self::ModalPositionRate(_) => Some(units::MODAL_VELOCITY),
            Self::ModalVelocityRate(_) => Some(units::MODAL_ACCELERATION),
        }
    }

    /// FMI causality.
    pub fn causality(self) -> &'static str {
        match self {
            Self::Time => "independent",
            Self::ForceLinear | Self::Parameter(_) => "parameter",
            Self::Input(_) => "input",
            Self::Acceleration(_) | Self::Velocity(_) | Self::Displacement(_) | Self::Connected(_) => "output",
            Self::ModalPosition(_)
            | Self::ModalVelocity(_)
            | Self::ModalPositionRate(_)
            | Self::ModalVelocityRate(_) => "local",
        }
    }

    /// FMI attribute `initial`; `None` where the standard has none.
    pub fn initial(self) -> Option<&'static str> {
        match self {
            Self::Time | Self::Input(_) => None,
            Self::ForceLinear | Self::Parameter(_) | Self::ModalPosition(_) | Self::ModalVelocity(_) => Some("exact"),
            _ => Some("calculated"),
        }
    }

    /// Start value as the XML says it; `None` for what is calculated, and for a parameter, whose start is its own.
    pub(super) fn start(self) -> Option<&'static str> {
        match self {
            Self::ForceLinear => Some("false"),
            Self::Input(_) | Self::ModalPosition(_) | Self::ModalVelocity(_) => Some("0"),
            _ => None,
        }
    }
}
