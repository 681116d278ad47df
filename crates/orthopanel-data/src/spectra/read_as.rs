//! As what the numbers of a measurement were read.

use crate::Motion;

/// The motion that a sensor was taken to read, and the units of both channels, before they became m/s² and N.
///
/// Where a unit or a type is wrong, this tells which line of the test file mends it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReadAs {
    /// What the sensor reads.
    pub motion: Motion,
    /// SI units in one unit of the response, with a declared sensitivity in one of those that volts stand for.
    pub response: f64,
    /// Newtons in one unit of the force, likewise.
    pub force: f64,
    /// Whether the motion was turned round.
    pub turned: bool,
}

impl ReadAs {
    /// Accelerations in m/s² and forces in N.
    pub const SI: Self = Self { motion: Motion::Acceleration, response: 1.0, force: 1.0, turned: false };
}
