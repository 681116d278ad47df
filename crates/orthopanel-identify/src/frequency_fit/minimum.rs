//! The minimum of eq. 22 from where a search begins.

use std::sync::Arc;

use super::problem::{FrequencyProblem, FrequencySet, SetPrediction};
use crate::downhill_simplex::{Penalised, downhill_simplex};
use crate::least_squares::{Ending, Stuck, descend, levenberg_marquardt_until};
use crate::structures::Shown;
use crate::{IdentifyError, Search};

/// Quick searches before one on the whole basis: a start far off wants a second.
const QUICK_SEARCHES: usize = 3;

/// A minimum, the modes there, and what predicts them quickly near by.
pub(super) struct Minimum {
    pub parameters: Vec<f64>,
    pub predictions: Vec<SetPrediction>,
    pub quick: Option<Arc<[FrequencySet]>>,
}

/// The minimum from `start`, where `quick` predicts quickly.
///
/// Where modes are costly, quick searches come first. Their end counts once the modes of the whole basis promise nothing
/// further there: it is the minimum of the whole basis then. What a quick search found is where the whole basis' solution
/// begins, and that solution is where the next quick search is made.
pub(super) fn least_squares(
    problem: &FrequencyProblem,
    start: &[f64],
    quick: Option<&Arc<[FrequencySet]>>,
) -> Result<Minimum, IdentifyError> {
    let (ending, searches) = match problem.structure.shown() {
        Shown::Wholly => (Ending::SMOOTH, 0),
        Shown::InPart => (Ending::WITH_JUMPS, QUICK_SEARCHES),
    };
    let bounds = problem.constants.bounds();
    let mut parameters = start.to_vec();
    let mut quick = quick.cloned();
    let mut known: Option<Vec<SetPrediction>> = None;
    for _ in 0..searches {
        let made_here = quick.is_none();
        if made_here {
            let Some(at) = known.take().or_else(|| problem.predictions(&parameters).ok()) else { break };
            quick = problem.near(&at).ok().flatten();
        }
        let Some(sets) = quick.take() else { break };
        let nearby = problem.on(&sets);
        let linearise = |parameters: &[f64]| nearby.linearise(parameters).map(|at| at.quadratic());
        let Ok((minimum, _)) = descend(linearise, &parameters, &bounds, ending) else { break };
        let Ok(predictions) = problem.predictions_from(&minimum.parameters, Some(&sets)) else { break };
        let moves = minimum.parameters.iter().zip(&parameters).map(|(new, old)| (new - old).abs());
        // Where it is made, the quick prediction has the whole one's values and slopes. A search that stays there stands at a
        // jump.
        let stays = made_here && moves.fold(0.0, f64::max) < ending.small_step;
        parameters = minimum.parameters;
        let at = problem.linearised(&predictions, &problem.constants).quadratic();
        if stays || ending.is_reached(&at, &parameters, &bounds) {
            return Ok(Minimum { parameters, predictions, quick: Some(sets) });
        }
        known = Some(predictions);
    }
    let linearise = |parameters: &[f64]| problem.linearise(parameters).map(|at| at.quadratic());
    let minimum = levenberg_marquardt_until(linearise, &parameters, &bounds, ending).map_err(|stuck| match stuck {
        Stuck::Refused(error) => error,
        Stuck::NotFinite => {
            IdentifyError::NotFinite { what: "error of the frequencies where the search begins".into() }
        }
        Stuck::Iterations { count, cost } => IdentifyError::NotConverged {
            iterations: count,
            error_percent: 100.0 * (cost / problem.count() as f64).sqrt(),
        },
    })?;
    Ok(Minimum { predictions: problem.predictions(&minimum.parameters)?, parameters: minimum.parameters, quick: None })
}

/// The minimum from `start`.
pub(super) fn minimise(problem: &FrequencyProblem, start: &[f64], search: Search) -> Result<Vec<f64>, IdentifyError> {
    if start.is_empty() {
        return Ok(Vec::new());
    }
    match search {
        Search::Simplex => {
            let error = |parameters: &[f64]| problem.error(parameters);
            downhill_simplex(&Penalised { error, bounds: problem.constants.bounds() }, start)
        }
        Search::LeastSquares => Ok(least_squares(problem, start, None)?.parameters),
    }
}
