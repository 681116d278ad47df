//! Starting values, from the data alone.

use super::problem::FrequencyProblem;
use crate::IdentifyError;
use crate::starting_constants::guess;

/// $E_x/(k'G_{zx})$ tried: from solid metal to the softest core.
const SOFTNESS: [f64; 4] = [2.0, 16.0, 128.0, 1024.0];

/// Parameters from which a search converges.
///
/// At fixed ratios of the moduli every frequency goes with their root, so the best size follows in closed form; what
/// remains is a look at a few ratios.
pub(super) fn starting_values(problem: &FrequencyProblem) -> Result<Vec<f64>, IdentifyError> {
    let constants = &problem.constants;
    let scalable = constants.moduli_are_free();
    let mut best: Option<(f64, Vec<f64>)> = None;
    for softness in SOFTNESS {
        let guess = guess(problem.structure, constants, softness);
        let scaling = Scaling::of(problem, &guess)?;
        let (factor, error) = if scalable { (scaling.factor(), scaling.best_error()) } else { (1.0, scaling.error()) };
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            let scaled = constants.scaled(&guess, factor);
            let parameter = |index: usize| constants.parameter(index, scaled[constants.free[index].constant]);
            best = Some((error, (0..constants.count()).map(parameter).collect()));
        }
    }
    Ok(best.map(|(_, parameters)| parameters).unwrap_or_default())
}

/// Sums over $q = f_{cal}/f_{exp}$ at some constants.
struct Scaling {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Scaling {
    fn of(problem: &FrequencyProblem, constants: &[f64]) -> Result<Self, IdentifyError> {
        let mut scaling = Self { count: 0.0, sum: 0.0, squares: 0.0 };
        for set in problem.sets.iter() {
            for (calculated, measured) in set.modes.rough_frequencies(constants)?.iter().zip(&set.measured) {
                let quotient = calculated / measured;
                scaling.count += 1.0;
                scaling.sum += quotient;
                scaling.squares += quotient * quotient;
            }
        }
        Ok(scaling)
    }

    /// The factor on all moduli that fits best, $(\sum q/\sum q^2)^2$.
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
