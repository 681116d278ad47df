//! Functions without a resonance inside the band, tabulated as Chebyshev series.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

/// Terms of a series: with the nearest resonance 1.3 times above the band, twenty leave 1e-9 of its part.
const TERMS: usize = 20;

/// Complex functions of $\omega$ on $s = \sigma + j\omega$, $0 \le \omega \le \omega_b$.
pub(super) struct SmoothPart {
    band: f64,
    /// A list of [`TERMS`] coefficients a function.
    coefficients: Vec<[Complex64; TERMS]>,
}

impl SmoothPart {
    /// Tabulates `count` functions, which `evaluate` writes, up to `band` \[Hz\].
    pub(super) fn tabulate(
        decay_rate: f64,
        band: f64,
        count: usize,
        evaluate: impl Fn(Complex64, &mut [Complex64]),
    ) -> Self {
        let band = band * TAU;
        let mut coefficients = vec![[Complex64::ZERO; TERMS]; count];
        let mut values = vec![Complex64::ZERO; count];
        for node in 0..TERMS {
            let angle = PI * (node as f64 + 0.5) / TERMS as f64;
            values.fill(Complex64::ZERO);
            evaluate(Complex64::new(decay_rate, 0.5 * band * (1.0 + angle.cos())), &mut values);
            for (series, value) in coefficients.iter_mut().zip(&values) {
                for (degree, coefficient) in series.iter_mut().enumerate() {
                    let weight = if degree == 0 { 1.0 } else { 2.0 } / TERMS as f64;
                    *coefficient += weight * (degree as f64 * angle).cos() * value;
                }
            }
        }
        Self { band, coefficients }
    }

    /// Writes the functions' values at $s$: Clenshaw's recurrence.
    pub(super) fn at(&self, s: Complex64, out: &mut [Complex64]) {
        let t = 2.0 * s.im / self.band - 1.0;
        for (value, series) in out.iter_mut().zip(&self.coefficients) {
            let (mut next, mut after) = (Complex64::ZERO, Complex64::ZERO);
            for coefficient in series.iter().skip(1).rev() {
                (next, after) = (coefficient + 2.0 * t * next - after, next);
            }
            *value = series[0] + t * next - after;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_a_resonance_outside_the_band_is_tabulated_to_rounding() {
        let resonance = |s: Complex64| (s * s + 0.01 * s * 1300.0 * TAU + (1300.0 * TAU).powi(2)).inv();
        let part = SmoothPart::tabulate(50.0, 1000.0, 1, |s, out| out[0] = resonance(s));
        for frequency in [0.0, 1.0, 333.3, 712.0, 999.9, 1000.0] {
            let s = Complex64::new(50.0, frequency * TAU);
            let mut value = [Complex64::ZERO];
            part.at(s, &mut value);
            assert!((value[0] / resonance(s) - 1.0).norm() < 1e-8, "{frequency} Hz");
        }
    }
}
