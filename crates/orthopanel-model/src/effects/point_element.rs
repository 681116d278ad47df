//! Elements joined to the structure at one place: masses, springs, resonators.

use std::f64::consts::TAU;

use num_complex::Complex64;

use crate::{Motion, Place};

/// An element at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointElement {
    /// What it does.
    pub law: ElementLaw,
    /// Where it sits.
    pub seat: Seat,
    /// What it follows: a deflection, or a rotation for an inertia or a spring against turning.
    pub motion: Motion,
}

/// Where an element sits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seat {
    /// At a place of the piece.
    At(Place),
    /// Evenly along an edge of a plate; a beam has it at the place.
    AlongEdge {
        /// The middle of the edge.
        middle: Place,
        /// Whether the edge is front or back.
        along_x: bool,
    },
    /// Where the record's sensor sits, wherever that is.
    AtResponse,
}

impl PointElement {
    /// An element that follows the deflection.
    pub(super) fn on_deflection(law: ElementLaw, seat: Seat) -> Self {
        Self { law, seat, motion: Motion::Deflection }
    }
}

/// The impedance $Z(s)$ of an element: force into it per displacement of its place \[N/m\], or couple per rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ElementLaw {
    /// A mass \[kg\], or a moment of inertia \[kg m²\] on a rotation: $Z = ms^2$.
    Mass {
        /// $m$.
        mass: f64,
    },
    /// A spring and a dashpot to the ground: $Z = k + cs$.
    Spring {
        /// $k$ \[N/m\].
        stiffness: f64,
        /// $c$ \[N s/m\].
        damping: f64,
    },
    /// A mass on a spring: $Z = ms^2\,(\omega_0^2 + 2\zeta\omega_0s)/(s^2 + 2\zeta\omega_0s + \omega_0^2)$.
    Resonator {
        /// $m$ \[kg\].
        mass: f64,
        /// $\omega_0/2\pi$ \[Hz\].
        frequency: f64,
        /// $\zeta$ \[1\].
        zeta: f64,
    },
}

impl ElementLaw {
    /// The impedance at $s$ as a pair, $Z = A/B$: force $g$ into the element and displacement $x$ of its place obey $Ax = Bg$, which
    /// is regular where $Z$ is zero, and where it is infinite, as at a resonator's own resonance.
    pub(super) fn pair(&self, s: Complex64) -> [Complex64; 2] {
        match *self {
            Self::Mass { mass } => [mass * s * s, Complex64::ONE],
            Self::Spring { stiffness, damping } => [stiffness + damping * s, Complex64::ONE],
            Self::Resonator { mass, frequency, zeta } => {
                let u = s / (frequency * TAU);
                let passed = 1.0 + 2.0 * zeta * u;
                [mass * s * s * passed, u * u + passed]
            }
        }
    }
}
