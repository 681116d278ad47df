//! How far the model lies from the records where it is no matter of noise.

use num_complex::Complex64;

use super::records::PlaceRecord;

/// Median over the lines of $|H_{cal}-H_{exp}|/|H_{exp}|$ \[%\], where noise that drowns a line counts as its size.
///
/// The median leaves out the peaks, where a right model with a wrong digit misses wholly, and the valleys, where noise does.
pub(super) fn record_misfit_percent(record: &PlaceRecord, model: &[Complex64]) -> f64 {
    scaled_misfit_percent(record, model, 1.0)
}

/// The same with the model's lines times a real factor.
pub(super) fn scaled_misfit_percent(record: &PlaceRecord, model: &[Complex64], factor: f64) -> f64 {
    let lines = model.iter().zip(&record.value).zip(&record.variance);
    100.0
        * median(lines.map(|((model, measured), variance)| {
            let noise = if record.variance_known { 3.0 * variance.sqrt() } else { 0.0 };
            (model * factor - measured).norm() / measured.norm().max(noise)
        }))
}

/// Median; zero of none.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
