//! What the model misses of a suspect as well as of a reference: it is removed from what was measured of the suspect.

use crate::comparison::Comparison;
use crate::outcome::SharedModelError;
use crate::stacked::Predictions;

/// Of each pole of the suspect what the model misses of the same mode of the reference; `None` where the reference does not show it.
pub(crate) struct SharedError {
    missed: Vec<Option<f64>>,
}

impl SharedError {
    /// Removed from the measured frequencies of a suspect: what is missed of the logarithm of the frequency, with the variance of that by noise.
    pub(crate) fn removed_from(comparison: &mut Comparison, missed: Vec<Option<(f64, f64)>>) -> Self {
        for (pole, missed) in missed.iter().enumerate() {
            let Some((missed, variance)) = missed else { continue };
            comparison.values[pole] -= missed;
            comparison.noise[(pole, pole)] += variance;
        }
        Self { missed: missed.into_iter().map(|of| Some(of?.0)).collect() }
    }

    /// Beside what a hypothesis predicts.
    pub(crate) fn beside(&self, comparison: &Comparison, at: &Predictions) -> SharedModelError {
        let left = comparison.values.iter().zip(&at.values).map(|(measured, predicted)| measured - predicted);
        let shared: Vec<(f64, f64)> =
            self.missed.iter().zip(left).filter_map(|(own, left)| Some(((*own)?, left))).collect();
        let rms = |of: fn(&(f64, f64)) -> f64| {
            (shared.iter().map(|one| of(one).powi(2)).sum::<f64>() / shared.len().max(1) as f64).sqrt()
        };
        SharedModelError {
            modes: shared.len(),
            reference: rms(|(missed, _)| *missed),
            suspect: rms(|(missed, left)| missed + left),
            suspect_less_reference: rms(|(_, left)| *left),
        }
    }
}
