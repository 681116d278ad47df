//! The paper's search: downhill simplex with a penalty (section 2.4), by argmin.

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;

use crate::IdentifyError;

/// An error with a penalty that grows with the square of the way past a bound, from the value on the bound.
///
/// The penalty is finite and has a slope: an infinite one lets the simplex stall, and clipping to the bounds without a
/// penalty lets it collapse on one.
pub(crate) struct Penalised<F> {
    /// The error to minimise, asked only inside the bounds.
    pub error: F,
    /// `(low, high)` of each parameter.
    pub bounds: Vec<(f64, f64)>,
}

impl<F: Fn(&[f64]) -> Result<f64, IdentifyError>> CostFunction for &Penalised<F> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, parameters: &Vec<f64>) -> Result<f64, Error> {
        let mut penalty = 0.0;
        let mut inside = parameters.clone();
        for (parameter, &(low, high)) in inside.iter_mut().zip(&self.bounds) {
            let clamped = parameter.clamp(low, high);
            penalty += (*parameter - clamped).powi(2);
            *parameter = clamped;
        }
        Ok((self.error)(&inside)? + penalty)
    }
}

/// Edge of the first simplex, in logarithms.
const FIRST_EDGE: f64 = 0.2;
/// Spread of the error over the corners at which a run ends: the rounding of the frequencies leaves some 1e-18,
const SMALL_SPREAD: f64 = 1e-16;
/// and that of magnitudes at narrow resonances this part of the error: below it corners differ by chance, and a run
/// would never end. It moves no parameter by more than 1e-5.
const ROUNDING: f64 = 1e-11;
const MOST_ITERATIONS: u64 = 2000;
/// A run that moves the logarithms by less has found what the one before it found.
const SETTLED: f64 = 1e-7;
const MOST_RESTARTS: usize = 20;

/// Parameters (logarithms) at the minimum, from `start`.
///
/// The simplex is set up anew around its result, ten times smaller, until that moves it no further: one run alone may
/// end on a flat triangle.
pub(crate) fn downhill_simplex<F: Fn(&[f64]) -> Result<f64, IdentifyError>>(
    problem: &Penalised<F>,
    start: &[f64],
) -> Result<Vec<f64>, IdentifyError> {
    let refused = |_: Error| not_converged(problem, start);
    let mut best = start.to_vec();
    let mut edge = FIRST_EDGE;
    for _ in 0..MOST_RESTARTS {
        let corners = (0..=best.len()).map(|corner| {
            let moved = |(i, log): (usize, &f64)| if i + 1 == corner { log + edge } else { *log };
            best.iter().enumerate().map(moved).collect::<Vec<f64>>()
        });
        let before = problem.cost(&best).map_err(refused)?;
        let spread = SMALL_SPREAD.max(ROUNDING * before);
        let solver = NelderMead::new(corners.collect()).with_sd_tolerance(spread).map_err(refused)?;
        let result = Executor::new(problem, solver)
            .configure(|state| state.max_iters(MOST_ITERATIONS))
            .run()
            .map_err(refused)?;
        let found = result.state().get_best_param().cloned().unwrap_or_else(|| best.clone());
        let moved = found.iter().zip(&best).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let gained = before - problem.cost(&found).map_err(refused)?;
        best = found;
        if moved < SETTLED || gained <= spread {
            return Ok(best);
        }
        edge = (0.1 * edge).max(1e-3);
    }
    Err(not_converged(problem, &best))
}

fn not_converged<F: Fn(&[f64]) -> Result<f64, IdentifyError>>(problem: &Penalised<F>, at: &[f64]) -> IdentifyError {
    let error_percent = (problem.error)(at).map_or(f64::NAN, |error| 100.0 * error.sqrt());
    IdentifyError::NotConverged { iterations: MOST_RESTARTS * MOST_ITERATIONS as usize, error_percent }
}
