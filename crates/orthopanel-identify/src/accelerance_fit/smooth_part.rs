//! Functions without a resonance inside the band, tabulated as Chebyshev series.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::line_block::{BLOCK, LineBlock};

/// Terms of a series: with the nearest resonance 1.3 times above the band, twenty leave 1e-9 of its part.
const TERMS: usize = 20;

/// Complex functions of $\omega$ on $s = \sigma + j\omega$, $0 \le \omega \le \omega_b$.
pub(super) struct SmoothPart {
    band: f64,
    /// A list of [`TERMS`] coefficients a function.
    coefficients: Vec<[Complex64; TERMS]>,
}

impl SmoothPart {
    /// Tabulates `count` functions, which `evaluate` adds to its second argument, up to `band` \[Hz\].
    pub(super) fn tabulate(
        decay_rate: f64,
        band: f64,
        count: usize,
        evaluate: impl Fn(&LineBlock, &mut [LineBlock]),
    ) -> Self {
        let band = band * TAU;
        let angles: [f64; TERMS] = std::array::from_fn(|node| PI * (node as f64 + 0.5) / TERMS as f64);
        let nodes = angles.iter().map(|angle| Complex64::new(decay_rate, 0.5 * band * (1.0 + angle.cos())));
        let mut values = vec![LineBlock::ZERO; count];
        evaluate(&LineBlock::filled(nodes), &mut values);
        let series = |values: &LineBlock| {
            let mut series = [Complex64::ZERO; TERMS];
            for (degree, coefficient) in series.iter_mut().enumerate() {
                let weight = if degree == 0 { 1.0 } else { 2.0 } / TERMS as f64;
                *coefficient =
                    angles.iter().zip(values.values()).map(|(a, v)| weight * (degree as f64 * a).cos() * v).sum();
            }
            series
        };
        Self { band, coefficients: values.iter().map(series).collect() }
    }

    /// Writes the functions' values at $s$: Clenshaw's recurrence.
    pub(super) fn at(&self, s: &LineBlock, out: &mut [LineBlock]) {
        let t = s.im.map(|omega| 2.0 * omega / self.band - 1.0);
        for (values, series) in out.iter_mut().zip(&self.coefficients) {
            values.re = clenshaw(&t, series.map(|coefficient| coefficient.re));
            values.im = clenshaw(&t, series.map(|coefficient| coefficient.im));
        }
    }
}

fn clenshaw(t: &[f64; BLOCK], [constant, series @ ..]: [f64; TERMS]) -> [f64; BLOCK] {
    let (mut next, mut after) = ([0.0; BLOCK], [0.0; BLOCK]);
    for coefficient in series.iter().rev() {
        for ((t, next), after) in t.iter().zip(&mut next).zip(&mut after) {
            (*next, *after) = (coefficient + 2.0 * t * *next - *after, *next);
        }
    }
    for ((t, next), after) in t.iter().zip(&mut next).zip(&after) {
        *next = constant + t * *next - after;
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_a_resonance_outside_the_band_is_tabulated_to_rounding() {
        let resonance = |s: Complex64| (s * s + 0.01 * s * 1300.0 * TAU + (1300.0 * TAU).powi(2)).inv();
        let part =
            SmoothPart::tabulate(50.0, 1000.0, 1, |s, out| out[0] = LineBlock::filled(s.values().map(resonance)));
        let frequencies = [0.0, 1.0, 333.3, 712.0, 999.9, 1000.0];
        let s = LineBlock::filled(frequencies.iter().map(|frequency| Complex64::new(50.0, frequency * TAU)));
        let mut found = [LineBlock::ZERO];
        part.at(&s, &mut found);
        for ((s, value), frequency) in s.values().zip(found[0].values()).zip(frequencies) {
            assert!((value / resonance(s) - 1.0).norm() < 1e-8, "{frequency} Hz");
        }
    }
}
