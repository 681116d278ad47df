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

/// A factor at one $s$ with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FactorLine {
    /// $c$.
    pub value: Complex64,
    /// By $s$.
    pub by_s: Complex64,
    /// By each number of the factor; zero beyond.
    pub by_numbers: [Complex64; 2],
}

impl ChannelFactor {
    /// The factor at $s$.
    pub fn line(&self, s: Complex64) -> FactorLine {
        let zero = Complex64::ZERO;
        match *self {
            Self::Delay { delay } => {
                let value = (-s * delay).exp();
                FactorLine { value, by_s: -delay * value, by_numbers: [-s * value, zero] }
            }
            Self::Resonance { frequency, zeta } => {
                let u = s / (frequency * TAU);
                let value = (u * u + 2.0 * zeta * u + 1.0).inv();
                let by_u = -value * value * (2.0 * u + 2.0 * zeta);
                let by_zeta = -value * value * 2.0 * u;
                FactorLine { value, by_s: by_u / (frequency * TAU), by_numbers: [-by_u * u / frequency, by_zeta] }
            }
            Self::HighPass { corner } => {
                let own = corner * TAU;
                let inverse = (s + own).inv();
                let by_corner = -TAU * s * inverse * inverse;
                FactorLine { value: s * inverse, by_s: own * inverse * inverse, by_numbers: [by_corner, zero] }
            }
            Self::Gain { gain } => FactorLine { value: gain.into(), by_s: zero, by_numbers: [Complex64::ONE, zero] },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Family = &'static dyn Fn(f64, f64) -> ChannelFactor;

    #[test]
    fn val_derivatives_are_those_of_differences() {
        let s = Complex64::new(40.0, 2500.0);
        let factors: [(Family, [f64; 2]); 4] = [
            (&|delay, _| ChannelFactor::Delay { delay }, [3e-5, 1.0]),
            (&|frequency, zeta| ChannelFactor::Resonance { frequency, zeta }, [900.0, 0.03]),
            (&|corner, _| ChannelFactor::HighPass { corner }, [12.0, 1.0]),
            (&|gain, _| ChannelFactor::Gain { gain }, [0.9, 1.0]),
        ];
        for (factor, [a, b]) in factors {
            let here = factor(a, b).line(s);
            let by_s = (factor(a, b).line(s + 1e-2).value - factor(a, b).line(s - 1e-2).value) / 2e-2;
            let by_a = (factor(a * 1.0001, b).line(s).value - factor(a * 0.9999, b).line(s).value) / (2e-4 * a);
            let by_b = (factor(a, b * 1.0001).line(s).value - factor(a, b * 0.9999).line(s).value) / (2e-4 * b);
            for (by, difference) in [(here.by_s, by_s), (here.by_numbers[0], by_a), (here.by_numbers[1], by_b)] {
                assert!((by - difference).norm() <= 1e-7 * difference.norm().max(1e-9), "{:?}", factor(a, b));
            }
        }
    }

    #[test]
    fn val_a_delay_turns_the_phase_and_nothing_else() {
        let line = ChannelFactor::Delay { delay: 2e-5 }.line(Complex64::new(0.0, 1000.0 * TAU));
        assert!((line.value.norm() - 1.0).abs() < 1e-15);
        assert!((line.value.arg() + TAU * 1000.0 * 2e-5).abs() < 1e-15);
    }
}
