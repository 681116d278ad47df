//! What an effect does: the few kinds of change that a prediction knows.

use super::{ChannelFactor, CoreModulus, PointElement};
use crate::{ShearLoss, Support};

/// One change of a prediction.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// An element joined to the structure at one place.
    Element(PointElement),
    /// A term of stiffness or mass spread over the structure.
    Field(FieldTerm),
    /// A shear modulus that depends on frequency.
    Core(CoreModulus),
    /// A factor on the accelerance.
    Channel(ChannelFactor),
    /// A place that is not where the test says.
    Place(Shift),
    /// The response is seen through a window $e^{-t/\tau}$ that the record does not tell of.
    Window {
        /// $\tau$ \[s\].
        tau: f64,
    },
    /// A plate in place of the beam, by the ratios $E_y/E_x$, $\nu_{xy}$, $G_{xy}/E_x$ and $G_{yz}/G_{zx}$.
    Plate([f64; 4]),
}

/// A term of stiffness or mass of the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FieldTerm {
    /// Factor on the rotary inertia $\rho t^3/12$.
    RotaryFactor(f64),
    /// Shear stiffness lost over a span.
    ShearLoss(ShearLoss),
    /// Clamped ends that yield.
    Support(Support),
}

/// An offset along x of a place of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Whether it is the response's place; else the force's.
    pub of_response: bool,
    /// By how much \[m\].
    pub offset: f64,
}
