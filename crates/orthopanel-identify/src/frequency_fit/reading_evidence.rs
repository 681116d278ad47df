//! How likely the lists of beams are under a reading of their lines.

use std::f64::consts::TAU;

use faer::prelude::Solve;
use faer::{Mat, Side};
use orthopanel_model::SHEAR_COEFFICIENT;

use super::problem::FrequencyProblem;
use crate::free_constants::CORE_BESIDE_FACES_STD;
use crate::least_squares::{Ending, Linearised, descend};
use crate::model_error::frequency_prior;
use crate::starting_constants::USUAL_SOFTNESS;
use crate::usual_ratios::USUAL_LOG_STD;

/// $\ln\tau$ is summed over from the least to the largest miss \[1\] that frequencies may have,
const SIZES: [f64; 2] = [1e-5, 0.3];
/// in so many steps: a fifth of the width that one residual leaves it.
const STEPS: usize = 60;
/// Searches with the size of miss that the one before has found.
const SEARCHES: usize = 3;

/// What is known of parameters before any list: $\sum_j a_jp_j - c$ is normal.
struct Known {
    /// Parameters in rising order with $a_j$.
    row: Vec<(usize, f64)>,
    mean: f64,
    std: f64,
}

impl Known {
    fn missed(&self, parameters: &[f64]) -> f64 {
        (self.row.iter().map(|(index, by)| by * parameters[*index]).sum::<f64>() - self.mean) / self.std
    }
}

/// A reading with its evidence.
pub(super) struct Weighed {
    /// The most probable parameters.
    pub parameters: Vec<f64>,
    pub log_evidence: f64,
}

/// The logarithm of the marginal likelihood of lists,
/// $$\ln\int p(f\mid\theta,\tau)\,p(\theta)\,p(\tau)\,d\theta\,d\ln\tau,$$
/// where each line has its own variance and $\tau^2$, the size of the model's error as for records (`model_error.rs`). The integral over
/// $\theta$ is Laplace's, that over $\ln\tau$ a sum. Of a panel, $E_x/(k'G_{zx})$ is known within a factor of seven, and a constant that one piece has of
/// its own within half of the other pieces'; the size of all moduli is not known.
pub(super) fn weighed(problem: &FrequencyProblem, variances: &[f64], start: &[f64]) -> Option<Weighed> {
    let known = known_beforehand(problem);
    let (median, factor) = frequency_prior();
    let [low, high] = SIZES.map(f64::ln);
    let step = (high - low) / (STEPS - 1) as f64;
    let sizes: Vec<f64> = (0..STEPS).map(|number| low + step * number as f64).collect();
    let log_prior = |log_size: f64| log_normal((log_size - median.ln()) / factor.ln()) - factor.ln().ln();
    let (mut parameters, mut size) = (start.to_vec(), USUAL_MISS);
    let mut logs: Vec<f64> = Vec::new();
    for _ in 0..SEARCHES {
        let square = |parameters: &[f64]| {
            let at = problem.linearise(parameters)?;
            let mut sum = weighed_sum(&at, variances, size * size, &known, parameters);
            sum.mirror();
            Ok::<_, crate::IdentifyError>(sum)
        };
        let (found, _) = descend(square, &parameters, &problem.constants.bounds(), Ending::SMOOTH).ok()?;
        parameters = found.parameters;
        let at = problem.linearise(&parameters).ok()?;
        let of_size = |log_size: &f64| {
            let laplace = laplace(&at, variances, (2.0 * log_size).exp(), &known, &parameters);
            laplace.unwrap_or(f64::NEG_INFINITY) + log_prior(*log_size)
        };
        logs = sizes.iter().map(of_size).collect();
        let best = (0..STEPS).max_by(|a, b| logs[*a].total_cmp(&logs[*b]))?;
        let found = sizes[best].exp();
        if (found / size).ln().abs() < step {
            break;
        }
        size = found;
    }
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = logs.iter().map(|log| (log - largest).exp()).sum();
    let log_evidence = largest + (step * sum).ln();
    log_evidence.is_finite().then_some(Weighed { parameters, log_evidence })
}

/// Frequencies are missed by about so much \[1\], before any list has told it.
const USUAL_MISS: f64 = 3e-3;

fn log_normal(deviations: f64) -> f64 {
    -0.5 * (deviations * deviations + TAU.ln())
}

/// What is usual of the softness of each set of constants, and of those that a piece has of its own beside those of the others.
fn known_beforehand(problem: &FrequencyProblem) -> Vec<Known> {
    let constants = &problem.constants;
    let position = |name: &str| constants.constants.iter().position(|constant| constant.name == name);
    let mut known = Vec::new();
    let mut pieces: Vec<usize> = problem.sets.iter().map(|set| set.piece).collect();
    pieces.sort_unstable();
    let mut seen: Vec<[Option<usize>; 2]> = Vec::new();
    for piece in pieces {
        let of_constant = constants.parameters_of(piece);
        let Some([e_x, g_zx]) = position("e_x").zip(position("g_zx")).map(|(a, b)| [a, b]) else { continue };
        let pair = [of_constant[e_x], of_constant[g_zx]];
        if pair == [None, None] || seen.contains(&pair) {
            continue;
        }
        seen.push(pair);
        let mut mean = (USUAL_SOFTNESS * SHEAR_COEFFICIENT).ln();
        let mut row: Vec<(usize, f64)> = Vec::new();
        for (constant, parameter, sign) in [(e_x, pair[0], 1.0), (g_zx, pair[1], -1.0)] {
            match (parameter, constants.held[constant]) {
                (Some(parameter), _) => row.push((parameter, sign)),
                (None, Some(held)) => mean -= sign * held.ln(),
                (None, None) => {}
            }
        }
        row.sort_by_key(|(parameter, _)| *parameter);
        known.push(Known { row, mean, std: CORE_BESIDE_FACES_STD });
    }
    for (own, free) in constants.free.iter().enumerate().filter(|(_, free)| free.piece.is_some()) {
        let is_shared =
            |other: &crate::free_constants::FreeConstant| other.piece.is_none() && other.constant == free.constant;
        if let Some(shared) = constants.free.iter().position(is_shared) {
            let mut row = vec![(own, 1.0), (shared, -1.0)];
            row.sort_by_key(|(parameter, _)| *parameter);
            known.push(Known { row, mean: 0.0, std: USUAL_LOG_STD });
        }
    }
    known
}

/// Squares of the lines and of what is known, each over its variance; the lower triangle.
fn weighed_sum(
    at: &Linearised,
    variances: &[f64],
    square: f64,
    known: &[Known],
    parameters: &[f64],
) -> crate::least_squares::Quadratic {
    let mut sum = crate::least_squares::Quadratic::zero(parameters.len());
    for (line, (residual, variance)) in at.residuals.iter().zip(variances).enumerate() {
        let std = (variance + square).sqrt();
        let row: Vec<(usize, f64)> = (0..parameters.len()).map(|j| (j, at.jacobian[(line, j)] / std)).collect();
        sum.add_row(residual / std, &row);
    }
    for known in known {
        let row: Vec<(usize, f64)> = known.row.iter().map(|(index, by)| (*index, by / known.std)).collect();
        sum.add_row(known.missed(parameters), &row);
    }
    sum
}

/// $\ln p(f\mid\tau)$ by what the lines are to first order about these parameters.
fn laplace(at: &Linearised, variances: &[f64], square: f64, known: &[Known], parameters: &[f64]) -> Option<f64> {
    let mut sum = weighed_sum(at, variances, square, known, parameters);
    sum.mirror();
    let slope = Mat::from_fn(parameters.len(), 1, |i, _| sum.gradient[i]);
    let factor = sum.normal.llt(Side::Lower).ok()?;
    let step = factor.solve(&slope);
    let least = sum.cost - (0..parameters.len()).map(|i| sum.gradient[i] * step[(i, 0)]).sum::<f64>();
    let by_lines: f64 = variances.iter().map(|variance| (TAU * (variance + square)).ln()).sum();
    let by_known: f64 = known.iter().map(|known| (TAU * known.std * known.std).ln()).sum();
    let l = factor.L();
    let by_parameters: f64 = (0..parameters.len()).map(|i| 2.0 * l[(i, i)].ln() - TAU.ln()).sum();
    Some(-0.5 * (least + by_lines + by_known + by_parameters))
}
