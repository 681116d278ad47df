//! Starting values, from the data alone.

use orthopanel_model::SHEAR_COEFFICIENT;

use super::problem::FrequencyProblem;
use crate::IdentifyError;

/// $E_x/(k'G_{zx})$ tried: from solid metal to the softest core.
const SOFTNESS: [f64; 4] = [2.0, 16.0, 128.0, 1024.0];

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
            [None, None] => [GUESS, GUESS / shear_ratio],
        };
        let scaling = Scaling::of(problem, constants)?;
        let both_free = problem.free.len() == 2;
        let (factor, error) = if both_free { (scaling.factor(), scaling.best_error()) } else { (1.0, scaling.error()) };
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            let value = |&index: &usize| {
                let constant = problem.constants[index];
                (factor * constants[index]).clamp(constant.low, constant.high).ln()
            };
            best = Some((error, problem.free.iter().map(value).collect()));
        }
    }
    Ok(best.map(|(_, logs)| logs).unwrap_or_default())
}

/// Any value will do: the factor puts it right.
const GUESS: f64 = 1e9;

/// Sums over $q = f_{cal}/f_{exp}$ at some constants.
struct Scaling {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Scaling {
    fn of(problem: &FrequencyProblem, constants: [f64; 2]) -> Result<Self, IdentifyError> {
        let mut scaling = Self { count: 0.0, sum: 0.0, squares: 0.0 };
        for set in &problem.sets {
            for (calculated, measured) in set.frequencies(&constants)?.iter().zip(&set.measured) {
                let quotient = calculated / measured;
                scaling.count += 1.0;
                scaling.sum += quotient;
                scaling.squares += quotient * quotient;
            }
        }
        Ok(scaling)
    }

    /// The factor on both constants that fits best, $(\sum q/\sum q^2)^2$.
    fn factor(&self) -> f64 {
        (self.sum / self.squares).powi(2)
    }

    /// Eq. 22 with that factor.
    fn best_error(&self) -> f64 {
        1.0 - self.sum * self.sum / (self.squares * self.count)
    }

    /// Eq. 22 as it is.
    fn error(&self) -> f64 {
        (self.squares - 2.0 * self.sum + self.count) / self.count
    }
}
