//! Starting values, from the data alone.

use orthopanel_model::SHEAR_COEFFICIENT;

use super::problem::FrequencyProblem;
use crate::IdentifyError;

/// $E_x/(k'G_{zx})$ tried: from solid metal to the softest core.
const SOFTNESS: [f64; 7] = [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0];

/// Logarithms of the free constants from which a search converges.
///
/// At a fixed ratio of the constants every frequency goes with $\sqrt{E_x}$, so the best $E_x$ follows in closed form;
/// what remains is a look at a few ratios.
pub(super) fn starting_values(problem: &FrequencyProblem) -> Result<Vec<f64>, IdentifyError> {
    let mut best: Option<(f64, Vec<f64>)> = None;
    for softness in SOFTNESS {
        let shear_ratio = softness * SHEAR_COEFFICIENT;
        let constants = match problem.held {
            [Some(e_x), Some(g_zx)] => [e_x, g_zx],
            [Some(e_x), None] => [e_x, e_x / shear_ratio],
            [None, Some(g_zx)] => [g_zx * shear_ratio, g_zx],
            [None, None] => {
                let guess = 1e9;
                let scale = best_scale(problem, [guess, guess / shear_ratio])?;
                [guess * scale, guess * scale / shear_ratio]
            }
        };
        let logs: Vec<f64> = problem
            .free
            .iter()
            .map(|&index| constants[index].clamp(problem.constants[index].low, problem.constants[index].high).ln())
            .collect();
        let error = problem.error(&logs)?;
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, logs));
        }
    }
    Ok(best.map(|(_, logs)| logs).unwrap_or_default())
}

/// The factor on both constants that fits best: with $q = f_{cal}/f_{exp}$, $\sqrt{factor} = \sum q/\sum q^2$.
fn best_scale(problem: &FrequencyProblem, constants: [f64; 2]) -> Result<f64, IdentifyError> {
    let (mut sum, mut squares) = (0.0, 0.0);
    for set in &problem.sets {
        for (prediction, measured) in set.predict(&constants)?.iter().zip(&set.measured) {
            let quotient = prediction.frequency / measured;
            sum += quotient;
            squares += quotient * quotient;
        }
    }
    Ok((sum / squares).powi(2))
}
