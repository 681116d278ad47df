//! Frequency and magnitude of a resonance between the lines: of a record, and of any function of frequency.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::prelude::{Solve, SolveLstsq};
use faer::{Mat, Side};
use num_complex::Complex64;

use super::pole::Pole;
use super::poles::fit_pole;
use super::records::PlaceRecord;

/// A resonance point of eq. 23: where the magnitude is greatest, and how great.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ResonancePoint {
    /// \[Hz\].
    pub frequency: f64,
    /// \[(m/s²)/N\].
    pub magnitude: f64,
}

/// A resonance point read from a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MeasuredPoint {
    /// Flexible mode, from 0.
    pub mode: usize,
    pub point: ResonancePoint,
    /// How well the record knows its resonance's height, as a logarithm: the standard deviation of $\ln\zeta$ there.
    pub log_std: f64,
    /// Variance of $\ln f$ and of $\ln G$ by the record's noise.
    pub variance: [f64; 2],
}

/// A mode must rise this much over what lies behind it, in magnitude: less is no resonance of this record but a place
/// near the mode's node, where the height tells of the neighbours.
const OVER_BACKGROUND: f64 = 3.0;

/// The resonance point of one record near a pole of all records; `None` where the record shows none of its own.
///
/// A pole over a straight background, $As^2/d(s) + B + C(f-f_0)$, is fitted to the lines around the peak, so the point
/// lies between lines and the noise of a single line is averaged out.
pub(super) fn measured_point(record: &PlaceRecord, near: &Pole, mode: usize) -> Option<MeasuredPoint> {
    let power: Vec<f64> = record.value.iter().map(|value| value.norm_sqr()).collect();
    let reach = (6.0 * near.zeta * near.frequency).max(1e-3 * near.frequency);
    let first = record.frequency.partition_point(|&f| f < near.frequency - reach);
    let end = record.frequency.partition_point(|&f| f <= near.frequency + reach);
    let peak = (first..end).max_by(|&a, &b| power[a].total_cmp(&power[b]))?;
    let (pole, lines) = fit_pole(record, &power, peak)?;
    let omega = pole.frequency * TAU;
    let resonance = |s: Complex64| s * s / (s * s + 2.0 * pole.zeta * omega * s + omega * omega) * 2.0 * pole.zeta;
    let terms = |s: Complex64, f: f64| [resonance(s), Complex64::ONE, Complex64::new(f - pole.frequency, 0.0)];
    let weight = |line: usize| if record.variance_known { record.variance[line].powf(-0.5) } else { 1.0 };
    let columns: Vec<[Complex64; 3]> = lines
        .clone()
        .map(|line| terms(record.s(line), record.frequency[line]).map(|term| weight(line) * term))
        .collect();
    let right = Mat::from_fn(lines.len(), 1, |i, _| weight(lines.start + i) * record.value[lines.start + i]);
    let amplitudes = Mat::from_fn(lines.len(), 3, |i, j| columns[i][j]).qr().solve_lstsq(&right);
    let value = |f: f64| {
        let s = Complex64::new(record.decay_rate, TAU * f);
        terms(s, f).iter().enumerate().map(|(i, term)| amplitudes[(i, 0)] * term).sum::<Complex64>()
    };
    let point = greatest(value, pole.frequency, half_width(omega, pole.zeta, record.decay_rate));
    let at_peak = Complex64::new(record.decay_rate, TAU * point.frequency);
    let alone = (amplitudes[(0, 0)] * resonance(at_peak)).norm();
    let behind = amplitudes[(1, 0)].norm();
    if alone <= OVER_BACKGROUND * behind || !point.magnitude.is_finite() {
        return None;
    }
    let amplitudes = [0, 1, 2].map(|term| amplitudes[(term, 0)]);
    let variance = height_variance(record, &pole, lines, amplitudes, point.frequency);
    let variance = [pole.log_frequency_std.powi(2), variance.unwrap_or(f64::INFINITY)];
    Some(MeasuredPoint { mode, point, log_std: pole.log_zeta_std, variance })
}

/// Variance of $\ln G$ at this frequency, of $A\,2\zeta s^2/d(s) + B + C(f-f_0)$ with these amplitudes fitted to these lines; `None`
/// where the lines do not tell it.
///
/// By the derivatives $J$ of the lines by $\ln f_0$, $\ln\zeta$ and the amplitudes it is $g^T(J^TWJ)^{-1}g$, with the gradient $g$ of
/// $\ln G$ at a fixed frequency, since $G$ has no slope at its greatest. Noise of the force that a window ties together is a
/// common factor on the whole resonance.
fn height_variance(
    record: &PlaceRecord,
    pole: &Pole,
    lines: Range<usize>,
    [height, level, slope]: [Complex64; 3],
    at: f64,
) -> Option<f64> {
    let functions = |s: Complex64, frequency: f64| {
        let omega = TAU * pole.frequency;
        let d = s * s + 2.0 * pole.zeta * omega * s + omega * omega;
        let resonance = 2.0 * pole.zeta * s * s / d;
        let by_log_frequency = -height * resonance * (2.0 * omega * omega + 2.0 * pole.zeta * omega * s) / d;
        let by_log_zeta = height * resonance * (1.0 - 2.0 * pole.zeta * omega * s / d);
        let apart = Complex64::from(frequency - pole.frequency);
        let value = height * resonance + level + slope * apart;
        let turned = [resonance, Complex64::ONE, apart].map(|function| [function, Complex64::I * function]);
        let [[a, ja], [b, jb], [c, jc]] = turned;
        (value, [by_log_frequency, by_log_zeta, a, ja, b, jb, c, jc])
    };
    let mut normal = Mat::<f64>::zeros(8, 8);
    let (mut misfit, mut worth) = (0.0, 0.0);
    for line in lines.clone() {
        let (value, by) = functions(record.s(line), record.frequency[line]);
        let weight = 2.0 * record.worth[line] / if record.variance_known { record.variance[line] } else { 1.0 };
        (misfit, worth) = (misfit + weight * (value - record.value[line]).norm_sqr(), worth + record.worth[line]);
        for (i, a) in by.iter().enumerate() {
            for (j, b) in by.iter().enumerate() {
                normal[(i, j)] += weight * (a.conj() * b).re;
            }
        }
    }
    let left = misfit / (2.0 * worth - 8.0).max(1.0);
    let scale = if record.variance_known { left.max(1.0) } else { left };
    let s = Complex64::new(record.decay_rate, TAU * at);
    let (value, by) = functions(s, at);
    let gradient = Mat::from_fn(8, 1, |i, _| (value.conj() * by[i]).re / value.norm_sqr());
    let solved = normal.llt(Side::Lower).ok()?.solve(&gradient);
    let own: f64 = (0..8).map(|i| gradient[(i, 0)] * solved[(i, 0)]).sum();
    let peak = record.frequency.partition_point(|&frequency| frequency < at).min(lines.end - 1);
    let tied = record.tied.as_ref().map_or(0.0, |noise| 0.5 * noise.variance[peak] / record.value[peak].norm_sqr());
    Some(scale * own + tied).filter(|variance| variance.is_finite())
}

/// Half the half-power width \[Hz\] of a mode seen on $s = \sigma + j\omega$.
pub(super) fn half_width(omega: f64, zeta: f64, decay_rate: f64) -> f64 {
    (zeta.max(1e-7) * omega + decay_rate) / std::f64::consts::TAU
}

/// Rounds of the search for the greatest magnitude.
const ROUNDS: usize = 3;
/// Each looks on a part of the width of the one before.
const NARROWING: f64 = 0.2;

/// Where a function's magnitude is greatest, near `frequency`, for a resonance of this half width \[Hz\].
///
/// $1/|H|^2$ of one resonance is nearly a parabola, so three points tell the vertex; the next round begins there.
pub(super) fn greatest(value: impl Fn(f64) -> Complex64, frequency: f64, half_width: f64) -> ResonancePoint {
    let inverse = |f: f64| 1.0 / value(f).norm_sqr();
    let (mut at, mut step) = (frequency, half_width);
    let mut least = inverse(at);
    for _ in 0..ROUNDS {
        let (left, middle, right) = (inverse(at - step), inverse(at), inverse(at + step));
        let (slope, curvature) = (0.5 * (right - left), right - 2.0 * middle + left);
        least = middle;
        // No valley here: the point stays, as the place where a resonance is looked for and not found.
        if curvature.is_nan() || curvature <= 0.0 {
            break;
        }
        let shift = (-slope / curvature).clamp(-2.0, 2.0);
        at += shift * step;
        least = middle + shift * (slope + 0.5 * shift * curvature);
        step *= NARROWING;
    }
    ResonancePoint { frequency: at, magnitude: least.max(f64::MIN_POSITIVE).powf(-0.5) }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Closed form for eq. 21 with one mode: |H| is greatest at $\omega_m/\sqrt{1-2\zeta^2}$, with
    /// $P/(2\zeta\sqrt{1-\zeta^2})$.
    #[test]
    fn val_the_greatest_magnitude_of_one_mode() {
        for zeta in [1e-4, 2e-3, 0.02] {
            let omega = 321.3 * TAU;
            let value = |f: f64| {
                let s = Complex64::new(0.0, f * TAU);
                1.7 * s * s / (s * s + 2.0 * zeta * omega * s + omega * omega)
            };
            let found = greatest(value, 321.3, half_width(omega, zeta, 0.0));
            let frequency = 321.3 / (1.0 - 2.0 * zeta * zeta).sqrt();
            let magnitude = 1.7 / (2.0 * zeta * (1.0 - zeta * zeta).sqrt());
            assert!((found.frequency / frequency - 1.0).abs() < 1e-3 * zeta, "{found:?}, truth {frequency}");
            assert!((found.magnitude / magnitude - 1.0).abs() < 1e-6, "{found:?}, truth {magnitude}");
        }
    }
}
