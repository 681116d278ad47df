//! What frequencies scatter, and what that leaves open of the constants.

use faer::Side;

use super::problem::FrequencyProblem;
use crate::free_constants::HALF_95;
use crate::least_squares::Linearised;

/// Relative standard deviation of a frequency, where neither a bin is stated nor a fit has told it.
pub(super) const USUAL_SCATTER: f64 = 1e-3;
/// Frequencies that are missed by more scatters than these are not missed by chance.
pub(super) const BEYOND_CHANCE: f64 = 5.0;
/// Student's half of a 95 % interval, where the scatter is that of 1, 2, ... residuals beyond the constants.
const STUDENT: [f64; 9] = [12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26];

/// The scatter of the relative residuals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    pub variance: f64,
    /// Half of a 95 % interval in its roots: few residuals hardly tell their own scatter.
    half_95: f64,
}

impl Noise {
    /// Before a fit has told it.
    pub(super) fn stated(problem: &FrequencyProblem) -> Self {
        let rounding = rounding_variance(problem);
        Self { variance: if rounding > 0.0 { rounding } else { USUAL_SCATTER.powi(2) }, half_95: HALF_95 }
    }

    /// What a fit leaves, or the rounding to bins where that is more.
    pub(super) fn left(problem: &FrequencyProblem, at: &Linearised) -> Self {
        let beyond = problem.count().saturating_sub(at.jacobian.ncols());
        if beyond == 0 {
            return Self::stated(problem);
        }
        let (scatter, rounding) = (at.quadratic().cost / beyond as f64, rounding_variance(problem));
        if scatter <= rounding {
            return Self { variance: rounding, half_95: HALF_95 };
        }
        let half_95 = STUDENT.get(beyond - 1).copied().unwrap_or(HALF_95 + 2.5 / beyond as f64);
        Self { variance: scatter, half_95 }
    }

    /// The square of half of a 95 % interval over 1.96.
    pub(super) fn wide_variance(&self) -> f64 {
        self.variance * (self.half_95 / HALF_95).powi(2)
    }

    /// Half of the 95 % interval of each parameter over 1.96; what nothing shows gets a very large one.
    pub(super) fn standard_deviations(&self, at: &Linearised) -> Vec<f64> {
        let normal = at.quadratic().normal;
        let count = normal.nrows();
        let Ok(decomposition) = normal.self_adjoint_eigen(Side::Lower) else { return vec![f64::INFINITY; count] };
        let (values, vectors) = (decomposition.S(), decomposition.U());
        // Rounding leaves a direction that nothing shows some 1e-16 of the largest.
        let floor = 1e-14 * (0..count).map(|k| values[k]).fold(f64::MIN_POSITIVE, f64::max);
        let square = |i: usize| (0..count).map(|k| vectors[(i, k)].powi(2) / values[k].max(floor)).sum::<f64>();
        (0..count).map(|i| (self.wide_variance() * square(i)).sqrt()).collect()
    }
}

/// Mean relative variance by rounding to the analyser's bins, where these are stated.
pub(super) fn rounding_variance(problem: &FrequencyProblem) -> f64 {
    let relative: Vec<f64> = problem
        .sets
        .iter()
        .flat_map(|set| set.rounding.iter().zip(&set.measured))
        .map(|(rounding, measured)| (rounding / measured).powi(2))
        .collect();
    if relative.is_empty() { 0.0 } else { relative.iter().sum::<f64>() / relative.len() as f64 }
}
