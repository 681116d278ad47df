//! How far the model lies from the records where it is no matter of noise.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::line_noise::most_likely;
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

/// The variance of each line of a record whose hits do not tell its noise by their scatter, from the misfit $e$ of a model to its lines.
///
/// What a model lacks runs smoothly from line to line, noise does not: of $u = e/\sqrt{1 + r|H|^2}$ the mean square of
/// $u_k - (u_{k-1}+u_{k+1})/2$ is $\tfrac32 + \tfrac12\mathrm{Re}\rho_2 - 2\mathrm{Re}\rho_1$ of the noise's, with the correlation
/// $\rho_m = a/(a + 2\pi jm)$ of lines under the window $e^{-\sigma t}$, $a = 2\sigma T$, and zero without one.
pub(super) fn noise_of_misfit(record: &PlaceRecord, model: &[Complex64]) -> Vec<f64> {
    let power: Vec<f64> = model.iter().map(|value| value.norm_sqr()).collect();
    let misfit: Vec<Complex64> = model.iter().zip(&record.value).map(|(model, value)| model - value).collect();
    let window = 2.0 * record.decay_rate / record.line_step();
    let tied = |lines: f64| {
        let (window, lines) = (window * window, (TAU * lines).powi(2));
        if window.is_finite() { window / (window + lines) } else { 0.0 }
    };
    let of_noise = 1.5 + 0.5 * tied(2.0) - 2.0 * tied(1.0);
    most_likely(&power, |shape| {
        let even: Vec<Complex64> = misfit.iter().zip(shape).map(|(misfit, shape)| misfit / shape.sqrt()).collect();
        let bends = even.windows(3).map(|three| match three {
            [before, at, after] => (at - 0.5 * (before + after)).norm_sqr() / of_noise,
            _ => f64::NAN,
        });
        // The first and the last line have no two neighbours.
        std::iter::once(f64::NAN).chain(bends).chain([f64::NAN]).take(even.len()).collect()
    })
    .0
}
