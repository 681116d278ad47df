//! Elements joined to the structure at one place: masses, springs, resonators.

use std::f64::consts::TAU;

use num_complex::Complex64;

use crate::{Motion, Place};

/// An element at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct PointElement {
    /// What it does.
    pub law: ElementLaw,
    /// Where it sits.
    pub seat: Seat,
    /// What it follows: a deflection, or a rotation for an inertia or a spring against turning.
    pub motion: Motion,
    /// Which parameters its numbers follow.
    pub shares: Vec<Share>,
}

/// Where an element sits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seat {
    /// At a place of the piece.
    At(Place),
    /// At a place whose x is that parameter.
    Free(Place, usize),
    /// Evenly along the edge through this place, from side to side; a beam has it at the place.
    AlongEdge(Place),
    /// Where the record's sensor sits, wherever that is.
    AtResponse,
}

/// A number of an element's law follows a parameter of the effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// The law's number, in the order of its fields.
    pub number: usize,
    /// The effect's parameter.
    pub parameter: usize,
    /// Derivative of the number by the parameter.
    pub factor: f64,
}

impl PointElement {
    /// An element that follows the deflection, its numbers being the effect's parameters in order.
    pub(super) fn on_deflection(law: ElementLaw, seat: Seat) -> Self {
        let shares = (0..law.numbers()).map(|number| Share { number, parameter: number, factor: 1.0 }).collect();
        Self { law, seat, motion: Motion::Deflection, shares }
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

/// An impedance at one $s$ as a pair, $Z = A/B$, with derivatives of the pair.
///
/// The force $g$ into the element and the displacement $x$ of its place obey $Ax = Bg$: regular where $Z$ is zero, and
/// where it is infinite, as at a resonator's own resonance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementLine {
    /// $(A, B)$.
    pub pair: [Complex64; 2],
    /// By $s$.
    pub by_s: [Complex64; 2],
    /// By each number of the law; zero beyond.
    pub by_numbers: [[Complex64; 2]; 3],
}

impl ElementLaw {
    /// How many numbers it has.
    pub fn numbers(&self) -> usize {
        match self {
            Self::Mass { .. } => 1,
            Self::Spring { .. } => 2,
            Self::Resonator { .. } => 3,
        }
    }

    /// The pair at $s$.
    pub fn line(&self, s: Complex64) -> ElementLine {
        let (zero, one) = (Complex64::ZERO, Complex64::ONE);
        let none = [zero, zero];
        match *self {
            Self::Mass { mass } => ElementLine {
                pair: [mass * s * s, one],
                by_s: [2.0 * mass * s, zero],
                by_numbers: [[s * s, zero], none, none],
            },
            Self::Spring { stiffness, damping } => ElementLine {
                pair: [stiffness + damping * s, one],
                by_s: [damping.into(), zero],
                by_numbers: [[one, zero], [s, zero], none],
            },
            Self::Resonator { mass, frequency, zeta } => {
                let own = frequency * TAU;
                let u = s / own;
                let inertia = mass * s * s;
                let passed = 1.0 + 2.0 * zeta * u;
                // By u alone, with s held in the inertia.
                let by_u = [2.0 * zeta * inertia, 2.0 * u + 2.0 * zeta];
                let along = |du: Complex64| by_u.map(|by| by * du);
                let [a, b] = along(1.0 / Complex64::from(own));
                ElementLine {
                    pair: [inertia * passed, u * u + passed],
                    by_s: [a + 2.0 * mass * s * passed, b],
                    by_numbers: [[s * s * passed, zero], along(-u / frequency), [2.0 * u * inertia, 2.0 * u]],
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Family = &'static dyn Fn(&[f64]) -> ElementLaw;

    #[test]
    fn val_derivatives_are_those_of_differences() {
        let s = Complex64::new(30.0, 900.0);
        let laws: [Family; 3] =
            [&|p| ElementLaw::Mass { mass: p[0] }, &|p| ElementLaw::Spring { stiffness: p[0], damping: p[1] }, &|p| {
                ElementLaw::Resonator { mass: p[0], frequency: p[1], zeta: p[2] }
            }];
        let values: [&[f64]; 3] = [&[0.02], &[300.0, 2.0], &[0.02, 180.0, 0.05]];
        for (law, values) in laws.iter().zip(values) {
            let close = |by: [Complex64; 2], low: [Complex64; 2], high: [Complex64; 2], step: f64| {
                for i in 0..2 {
                    let difference = (high[i] - low[i]) / (2.0 * step);
                    assert!((by[i] - difference).norm() <= 1e-7 * difference.norm().max(1e-9), "{:?}", law(values));
                }
            };
            let here = law(values).line(s);
            close(here.by_s, law(values).line(s - 1e-2).pair, law(values).line(s + 1e-2).pair, 1e-2);
            for number in 0..values.len() {
                let step = 1e-4 * values[number];
                let moved = |sign: f64| {
                    let mut at = values.to_vec();
                    at[number] += sign * step;
                    law(&at).line(s).pair
                };
                close(here.by_numbers[number], moved(-1.0), moved(1.0), step);
            }
        }
    }
}
