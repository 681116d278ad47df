//! Records made wide: as they would be if every response died away faster.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::records::PlaceRecord;

/// Lines further away than so many widths are left out: all of them together hold a 160th.
const REACH: f64 = 100.0;
/// Lines nearer than this to the end of a record, in widths, are not told: too much of what they hold lies beyond it.
const EDGE: f64 = 3.0;
/// Frequencies that share one width lie within this factor.
const SHARED: f64 = 1.5;
/// A width is no less than so many lines.
const LEAST_LINES: f64 = 1.0;
/// A smeared line is held to count down to this part of what is usual nearby.
const COUNTS: f64 = 0.1;

/// The accelerance at $s = \sigma_0 + \sigma + j\omega$ from the lines on $\sigma_0 + j\omega'$, for $\sigma/2\pi$ = `width`
/// \[Hz\]: Poisson's integral for what has its poles further left,
/// $$H(\sigma_0+\sigma+j\omega) = \frac1\pi\int_{-\infty}^{\infty}\frac{\sigma H(\sigma_0+j\omega')}{(\omega-\omega')^2+\sigma^2}d\omega',$$
/// with $H(\sigma_0-j\omega) = H^*(\sigma_0+j\omega)$. What lies beyond the lines is taken to be like what lies within.
pub(super) fn smeared_value(record: &PlaceRecord, frequency: f64, width: f64) -> Complex64 {
    let (mut sum, mut weights) = (Complex64::ZERO, 0.0);
    let mut add = |from: f64, mirrored: bool| {
        let first = record.frequency.partition_point(|&line| line < from - REACH * width);
        let end = record.frequency.partition_point(|&line| line <= from + REACH * width);
        for (line, value) in record.frequency[first..end].iter().zip(&record.value[first..end]) {
            let weight = width / ((line - from).powi(2) + width * width);
            sum += weight * if mirrored { value.conj() } else { *value };
            weights += weight;
        }
    };
    add(frequency, false);
    add(-frequency, true);
    if weights > 0.0 { sum / weights } else { Complex64::ZERO }
}

/// The lines of a record that may be told at a width that is `part` of the frequency.
pub(super) fn told(record: &PlaceRecord, part: f64) -> (f64, f64) {
    let (step, end) = (record.line_step(), record.band_end());
    let first = record.frequency.first().copied().unwrap_or(0.0);
    let edge = |frequency: f64| EDGE * (part * frequency).max(LEAST_LINES * step);
    // Below a line that is near zero nothing is missing: negative frequencies mirror the positive ones.
    let from = if first > edge(first) + 2.0 * step { first + edge(first) } else { first };
    (from, end - edge(end))
}

/// A record with its resonances as wide as `part` of their frequency and more, in stretches of one width each.
///
/// Lines are weighed by what is usual nearby rather than by their noise: this is for finding where to start.
pub(super) fn smeared(record: &PlaceRecord, part: f64) -> Vec<PlaceRecord> {
    let (mut from, end) = told(record, part);
    let step = record.line_step();
    let mut stretches = Vec::new();
    while from < end && step > 0.0 {
        let top = (from.max(REACH * step) * SHARED).min(end);
        let width = (part * top).max(LEAST_LINES * step);
        let lines = ((top - from) / (0.5 * width)).ceil().max(1.0);
        let frequency: Vec<f64> = (0..lines as usize).map(|line| from + line as f64 * (top - from) / lines).collect();
        let value: Vec<Complex64> = frequency.iter().map(|&line| smeared_value(record, line, width)).collect();
        let usual = value.iter().map(|value| value.norm_sqr()).sum::<f64>() / lines;
        let noise = |frequency: &f64| {
            let line = record.frequency.partition_point(|line| line < frequency).min(record.variance.len() - 1);
            // Of even noise a mean over the kernel leaves this part.
            if record.variance_known { record.variance[line] * step / (TAU * width) } else { 0.0 }
        };
        let variance = frequency.iter().map(|line| COUNTS * COUNTS * usual + noise(line)).collect();
        stretches.push(PlaceRecord {
            force_at: record.force_at,
            response_at: record.response_at,
            variance,
            variance_known: true,
            scatter_told: true,
            decay_rate: record.decay_rate + TAU * width,
            decay_rate_in_doubt: record.decay_rate_in_doubt,
            worth: vec![1.0; frequency.len()],
            by_strength: None,
            tied: None,
            read_as: record.read_as,
            frequency,
            value,
        });
        from = top;
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two modes and a rigid part against their closed form further right.
    #[test]
    fn val_a_smeared_record_is_the_accelerance_further_right() {
        let at = |s: Complex64| {
            let mode = |f: f64, zeta: f64| s * s / (s * s + 2.0 * zeta * f * TAU * s + (f * TAU).powi(2));
            1.4 + 0.8 * mode(400.0, 0.002) - 1.1 * mode(900.0, 0.001)
        };
        let frequency: Vec<f64> = (1..4000).map(|line| 0.5 * f64::from(line)).collect();
        let value = frequency.iter().map(|f| at(Complex64::new(3.0, TAU * f))).collect();
        let record = PlaceRecord {
            variance: vec![1e-6; frequency.len()],
            variance_known: true,
            scatter_told: true,
            decay_rate: 3.0,
            ..PlaceRecord::even(frequency, value)
        };
        for part in [0.02, 0.005] {
            let mut lines = 0;
            for stretch in smeared(&record, part) {
                for (line, value) in stretch.value.iter().enumerate() {
                    let truth = at(stretch.s(line));
                    let frequency = stretch.frequency[line];
                    // Beyond 2000 Hz nothing is known: near there the tails are missing.
                    let tolerance = 0.02 + 2.0 * part * frequency / (2000.0 - frequency);
                    assert!((value - truth).norm() < tolerance * truth.norm().max(1.0), "{frequency}: {value} {truth}");
                    lines += 1;
                }
            }
            assert!(lines > 100);
        }
    }
}
