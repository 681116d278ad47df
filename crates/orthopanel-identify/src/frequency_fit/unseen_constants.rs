//! What is said of the constants that the frequencies do not show.

use faer::{Mat, Side};

use super::minimum::Minimum;
use super::noise::Noise;
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
    let open = open_covariance(&at.quadratic().normal);
    let report = |&constant: &usize| {
        let index = constants.free.iter().position(|free| free.constant == constant).unwrap_or(0);
        constants.not_identified(index, values[index], stds[index], open.as_ref())
    };
    resting.iter().map(report).collect()
}

/// The covariance of all parameters, of which the data may leave some open: what has next to no curvature has much of it.
fn open_covariance(normal: &Mat<f64>) -> Option<Mat<f64>> {
    let decomposition = normal.self_adjoint_eigen(Side::Lower).ok()?;
    let (values, vectors) = (decomposition.S(), decomposition.U());
    let count = normal.nrows();
    let floor = 1e-14 * (0..count).map(|k| values[k]).fold(f64::MIN_POSITIVE, f64::max);
    let share = |i: usize, j: usize, k: usize| vectors[(i, k)] * (vectors[(j, k)] / values[k].max(floor));
    Some(Mat::from_fn(count, count, |i, j| (0..count).map(|k| share(i, j, k)).sum()))
}
