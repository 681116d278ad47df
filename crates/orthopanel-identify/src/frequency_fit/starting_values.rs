//! Starting values, from the data alone.

use orthopanel_model::ModelError;

use super::problem::FrequencyProblem;
use crate::IdentifyError;
use crate::starting_constants::{SOFTNESS, guess};

/// Factors tried on the free moduli where others are held.
const BESIDE_HELD: [f64; 5] = [1.0, 0.25, 4.0, 0.0625, 16.0];
/// A ratio must fit better by so much of eq. 22 to be another.
const BETTER: f64 = 1e-9;

/// Parameters from which a search converges.
///
/// At fixed ratios of the moduli every frequency goes with their root, so the best size follows in closed form; what
/// remains is a look at a few ratios. Where moduli are held, the free ones lie somewhere beside them.
pub(super) fn starting_values(problem: &FrequencyProblem) -> Result<Vec<f64>, IdentifyError> {
    let constants = &problem.constants;
    let scalable = constants.moduli_are_free();
    let sizes = if scalable { &BESIDE_HELD[..1] } else { &BESIDE_HELD[..] };
    let mut best: Result<(f64, Vec<f64>), Option<ModelError>> = Err(None);
    for (softness, size) in SOFTNESS.iter().flat_map(|softness| sizes.iter().map(move |size| (softness, size))) {
        let guess = constants.free_scaled(&guess(constants, *softness), *size);
        let scaling = match Scaling::of(problem, &guess) {
            Ok(scaling) => scaling,
            // A law that is indefinite beside what is held, say: another ratio may be none.
            Err(error) => {
                best = best.map_err(|first| first.or(Some(error)));
                continue;
            }
        };
        let (factor, error) = if scalable { (scaling.factor(), scaling.best_error()) } else { (1.0, scaling.error()) };
        if best.as_ref().map_or(true, |(least, _)| error < least - BETTER) {
            let scaled = constants.scaled(&guess, factor);
            let parameter = |index: usize| constants.parameter(index, scaled[constants.free[index].constant]);
            best = Ok((error, (0..constants.count()).map(parameter).collect()));
        }
    }
    match best {
        Ok((_, parameters)) => Ok(parameters),
        Err(Some(error)) => Err(error.into()),
        Err(None) => Ok(Vec::new()),
    }
}

/// Sums over $q = f_{cal}/f_{exp}$ at some constants.
struct Scaling {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Scaling {
    fn of(problem: &FrequencyProblem, constants: &[f64]) -> Result<Self, ModelError> {
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
