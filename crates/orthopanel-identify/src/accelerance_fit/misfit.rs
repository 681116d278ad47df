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
    100.0 * median(line_misfits(record, model, factor))
}

/// The same over the lines of several records and their models.
pub(super) fn misfit_percent<'a>(records: impl Iterator<Item = (&'a PlaceRecord, &'a Vec<Complex64>)>) -> f64 {
    100.0 * median(records.flat_map(|(record, model)| line_misfits(record, model, 1.0)))
}

fn line_misfits(record: &PlaceRecord, model: &[Complex64], factor: f64) -> impl Iterator<Item = f64> {
    model.iter().zip(&record.value).zip(&record.variance).map(move |((model, measured), variance)| {
        let noise = if record.variance_known { 3.0 * variance.sqrt() } else { 0.0 };
        (model * factor - measured).norm() / measured.norm().max(noise)
    })
}

/// Standard deviation of the median line over its size \[%\]; `None` where a record does not tell its noise.
pub(super) fn noise_percent<'a>(records: impl Iterator<Item = &'a PlaceRecord>) -> Option<f64> {
    let mut parts = Vec::new();
    for record in records {
        if !record.variance_known {
            return None;
        }
        parts.extend(record.value.iter().zip(&record.variance).map(|(value, variance)| variance.sqrt() / value.norm()));
    }
    Some(100.0 * median(parts.into_iter()))
}

/// Median; zero of none.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
