//! What an effect does: the few kinds of change that a prediction knows.

use super::{ChannelFactor, CoreModulus, PointElement};
use crate::{Place, ShearLoss, Support};

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
    /// The side \[m\] of the square feet on which all stands that stands on a plate.
    Foot(f64),
}

/// A term of stiffness or mass that is spread over the structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FieldTerm {
    /// Factor on the rotary inertia $\rho t^3/12$.
    RotaryFactor(f64),
    /// Shear stiffness lost over a span.
    ShearLoss(ShearLoss),
    /// Both shear stiffnesses of a plate lost over a square.
    ShearPatch(ShearPatch),
    /// Clamped ends that yield.
    Support(Support),
}

/// Both shear stiffnesses of a plate times $1-\text{loss}$ over a square, as far as that lies on the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearPatch {
    /// The part lost \[1\], below 1.
    pub loss: f64,
    /// Side of the square \[m\].
    pub span: f64,
    /// Its middle.
    pub at: Place,
}

/// An offset of a place of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Whether it is the response's place; else the force's.
    pub of_response: bool,
    /// By how much along x and along y \[m\].
    pub offset: [f64; 2],
}
