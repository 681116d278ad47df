//! What is said of the constants that the frequencies do not show.

use faer::{Mat, Side};
use orthopanel_model::Constant;

use super::Minimum;
use super::noise::{HALF_95, Noise};
use super::problem::FrequencyProblem;
use super::seen_constants::as_if_freed;
use crate::NotIdentified;
use crate::free_constants::FreeConstants;

/// A report on each constant that rests, in the order of the structure.
pub(super) fn reports(problem: &FrequencyProblem, all: &FreeConstants, minimum: &Minimum) -> Vec<NotIdentified> {
    let Minimum { parameters, predictions, .. } = minimum;
    let mut resting: Vec<usize> = problem.constants.resting.iter().map(|(constant, _)| *constant).collect();
    resting.sort_unstable();
    let (constants, values) = as_if_freed(problem, all, parameters, &resting);
    let at = problem.linearised(predictions, &constants);
    let mut noise = Noise::left(problem, &problem.linearised(predictions, &problem.constants));
    let stated = Noise::stated(problem);
    // A constant that rests where it was found has taken up the scatter of what was left.
    if problem.constants.count() == 0 && noise.variance < stated.variance {
        noise = stated;
    }
    let stds = noise.standard_deviations(&at);
    let normal = at.quadratic().normal;
    let report = |&constant: &usize| {
        let index = constants.free.iter().position(|free| free.constant == constant).unwrap_or(0);
        let Constant { name, unit, .. } = constants.constants[constant];
        let end = |sign: f64| constants.value(index, values[index] + sign * HALF_95 * stds[index]);
        NotIdentified {
            name,
            unit,
            held_at: constants.value(index, values[index]),
            interval: [end(-1.0), end(1.0)],
            direction: blind_direction(&constants, &normal, index),
        }
    };
    resting.iter().map(report).collect()
}

/// Where all parameters go when one moves and the others make up for it as far as they can: its column of the covariance.
fn blind_direction(constants: &FreeConstants, normal: &Mat<f64>, parameter: usize) -> Vec<(&'static str, f64)> {
    let Ok(decomposition) = normal.self_adjoint_eigen(Side::Lower) else { return Vec::new() };
    let (values, vectors) = (decomposition.S(), decomposition.U());
    let count = normal.nrows();
    let floor = 1e-14 * (0..count).map(|k| values[k]).fold(f64::MIN_POSITIVE, f64::max);
    let share = |k: usize| vectors[(parameter, k)] / values[k].max(floor);
    let column: Vec<f64> = (0..count).map(|i| (0..count).map(|k| vectors[(i, k)] * share(k)).sum()).collect();
    constants.direction(parameter, &column)
}
