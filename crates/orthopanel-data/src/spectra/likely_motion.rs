//! Which motion a frequency response holds that does not tell it, by how it falls over frequency.

use num_complex::Complex64;

use super::extremes::median;
use crate::Motion;

/// Bands, each as wide as the others in logarithms, ...
const BANDS: usize = 12;
/// ... over a decade at least, with so many lines in all: fewer tell no slope.
const LEAST_RANGE: f64 = 10.0;
const LEAST_LINES: usize = 200;

/// Slopes of level over frequency, both in logarithms, below which a response is no accelerance, and no mobility: those of accelerances
/// of real beams and of made ones lie between -0.12 and 0.64, of mobilities one lower, of receptances two.
const MOBILITY: f64 = -0.25;
const RECEPTANCE: f64 = -1.25;

/// The motion over force whose level changes with frequency as this does; `None` where the lines are too few to tell.
///
/// An accelerance stays level or rises a little, a mobility falls by $1/f$ beside it, a receptance by $1/f^2$; the medians of bands pass
/// over resonances.
pub(super) fn likely_motion(frequency: &[f64], value: &[Complex64]) -> Option<Motion> {
    let lines = || frequency.iter().zip(value).filter(|(f, value)| **f > 0.0 && value.norm() > 0.0);
    let (first, last) = (*lines().next()?.0, *lines().next_back()?.0);
    if lines().count() < LEAST_LINES || last < LEAST_RANGE * first {
        return None;
    }
    // The lowest lines hold what swings on its suspension.
    let from = first.max(last / 50.0);
    let width = (last / from).ln() / BANDS as f64;
    let level = |band: usize| {
        let low = from * (width * band as f64).exp();
        let within = lines().filter(|(f, _)| (low..=low * width.exp()).contains(*f));
        let levels: Vec<f64> = within.map(|(_, value)| value.norm().ln()).collect();
        (!levels.is_empty()).then(|| (width * band as f64, median(levels)))
    };
    let points: Vec<(f64, f64)> = (0..BANDS).filter_map(level).collect();
    let count = points.len() as f64;
    let [x, y] = [
        points.iter().map(|point| point.0).sum::<f64>() / count,
        points.iter().map(|point| point.1).sum::<f64>() / count,
    ];
    let slope = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum::<f64>()
        / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>();
    match slope {
        slope if slope < RECEPTANCE => Some(Motion::Displacement),
        slope if slope < MOBILITY => Some(Motion::Velocity),
        slope if slope.is_finite() => Some(Motion::Acceleration),
        _ => None,
    }
}
