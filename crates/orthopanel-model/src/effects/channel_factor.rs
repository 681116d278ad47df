//! Factors that the measuring chain puts on an accelerance.

use std::f64::consts::TAU;

use num_complex::Complex64;

/// A factor $c(s)$ on the accelerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ChannelFactor {
    /// The response comes late: $c = e^{-sT}$.
    Delay {
        /// $T$ \[s\].
        delay: f64,
    },
    /// The sensor's own resonance: $c = \omega_0^2/(s^2 + 2\zeta\omega_0s + \omega_0^2)$.
    Resonance {
        /// $\omega_0/2\pi$ \[Hz\].
        frequency: f64,
        /// $\zeta$ \[1\].
        zeta: f64,
    },
    /// A high-pass filter of first order in the response: $c = s/(s + \omega_c)$.
    HighPass {
        /// $\omega_c/2\pi$ \[Hz\].
        corner: f64,
    },
    /// $c$ = gain.
    Gain {
        /// The gain \[1\].
        gain: f64,
    },
}

impl ChannelFactor {
    /// The factor at $s$.
    pub fn at(&self, s: Complex64) -> Complex64 {
        match *self {
            Self::Delay { delay } => (-s * delay).exp(),
            Self::Resonance { frequency, zeta } => {
                let u = s / (frequency * TAU);
                (u * u + 2.0 * zeta * u + 1.0).inv()
            }
            Self::HighPass { corner } => s / (s + corner * TAU),
            Self::Gain { gain } => gain.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_a_delay_turns_the_phase_and_nothing_else() {
        let factor = ChannelFactor::Delay { delay: 2e-5 }.at(Complex64::new(0.0, 1000.0 * TAU));
        assert!((factor.norm() - 1.0).abs() < 1e-15);
        assert!((factor.arg() + TAU * 1000.0 * 2e-5).abs() < 1e-15);
    }

    /// At its own resonance a sensor shows $1/2\zeta$ of the motion, a quarter of a turn behind it.
    #[test]
    fn val_a_resonance_is_a_quarter_of_a_turn_behind() {
        let factor = ChannelFactor::Resonance { frequency: 6000.0, zeta: 0.03 };
        let own = factor.at(Complex64::new(0.0, 6000.0 * TAU));
        assert!((own - Complex64::new(0.0, -1.0 / 0.06)).norm() < 1e-12 * own.norm());
        assert!((factor.at(Complex64::new(0.0, 1e-3)) - 1.0).norm() < 1e-8);
    }
}
