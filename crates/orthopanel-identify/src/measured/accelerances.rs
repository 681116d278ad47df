//! An accelerance as its file gives it, as lines.

use num_complex::Complex64;
use orthopanel_data::Accelerance;

use super::lines::RecordLines;

/// Relative standard deviation of a line where a file does not tell its noise: what a good analyser's averages have.
pub(super) const UNTOLD_NOISE: f64 = 1e-2;

impl RecordLines {
    /// From an accelerance, on its lines between two frequencies \[Hz\]. Lines without a finite variance carry nothing and are
    /// left out. Where no variance is told, a line's is taken as 1 % of its size and of the median size of all, and the fit's misfit
    /// scales it.
    pub(super) fn of_accelerance(accelerance: &Accelerance, band: [f64; 2]) -> Self {
        let sizes = || accelerance.value.iter().map(|value| value.norm_sqr());
        let typical = {
            let mut sizes: Vec<f64> = sizes().collect();
            let middle = sizes.len() / 2;
            if sizes.is_empty() { 0.0 } else { *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 }
        };
        let variance = |line: usize, size: f64| match &accelerance.variance {
            Some(told) => told.get(line).copied().unwrap_or(f64::INFINITY),
            None => UNTOLD_NOISE.powi(2) * (size + typical),
        };
        let mut lines = Self {
            force_at: accelerance.force_at,
            response_at: accelerance.response_at,
            s: vec![],
            value: vec![],
            weight: vec![],
            truncations: None,
            force_noise: vec![],
        };
        for (line, (&frequency, &value)) in accelerance.frequency.iter().zip(&accelerance.value).enumerate() {
            let weight = (2.0 / variance(line, value.norm_sqr())).sqrt();
            if !((band[0]..=band[1]).contains(&frequency) && weight.is_finite() && weight > 0.0) {
                continue;
            }
            lines.s.push(Complex64::new(accelerance.decay_rate, std::f64::consts::TAU * frequency));
            lines.value.push(value);
            lines.weight.push(weight);
            let by_force = accelerance.force_noise.as_ref().and_then(|noise| noise.variance.get(line));
            lines.force_noise.push(by_force.map_or(0.0, |variance| variance / value.norm_sqr()));
        }
        lines
    }
}
