//! An accelerance as its file gives it, as lines.

use num_complex::Complex64;
use orthopanel_data::Accelerance;

use super::lines::RecordLines;
use super::medians::{NEIGHBOURS, about, median};

/// Relative standard deviation of a line where a file does not tell its noise: what a good analyser's averages have.
pub(super) const UNTOLD_NOISE: f64 = 1e-2;

impl RecordLines {
    /// From an accelerance, on its lines between two frequencies \[Hz\]. Lines without a finite variance carry nothing and are
    /// left out. Where no variance is told, a line's is taken as 1 % of its size and of the median size of all, and the fit's misfit
    /// scales it; one that is told may stem from a few averages, and by chance be far too small: it counts no less than the median of its neighbours.
    pub(super) fn of_accelerance(accelerance: &Accelerance, band: [f64; 2]) -> Self {
        let typical = median(accelerance.value.iter().map(|value| value.norm_sqr()));
        let per_datum = lines_per_datum(accelerance);
        let neighbours = (NEIGHBOURS as f64 * per_datum) as usize;
        let variance = |line: usize, size: f64| match &accelerance.variance {
            Some(told) => told.get(line).map_or(f64::INFINITY, |own| {
                own.max(median(told[about(line, neighbours, told.len())].iter().copied()))
            }),
            None => UNTOLD_NOISE.powi(2) * (size + typical),
        };
        let mut lines = Self {
            force_at: accelerance.force_at,
            response_at: accelerance.response_at,
            s: vec![],
            value: vec![],
            weight: vec![],
            per_datum,
            truncations: None,
            force_noise: vec![],
        };
        for (line, (&frequency, &value)) in accelerance.frequency.iter().zip(&accelerance.value).enumerate() {
            if !(band[0]..=band[1]).contains(&frequency) {
                continue;
            }
            let weight = (2.0 / (per_datum * variance(line, value.norm_sqr()))).sqrt();
            if !(weight.is_finite() && weight > 0.0) {
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

/// $\sigma T\coth\sigma T$: see [`RecordLines`].
fn lines_per_datum(accelerance: &Accelerance) -> f64 {
    let step = match accelerance.frequency[..] {
        [first, .., last] => (last - first) / (accelerance.frequency.len() - 1) as f64,
        _ => return 1.0,
    };
    let decayed = accelerance.decay_rate / step;
    if decayed > 0.0 { decayed / decayed.tanh() } else { 1.0 }
}
