//! One hypothesis fitted to the records, from the widest peaks to the narrowest.

use std::ops::RangeInclusive;

use faer::linalg::solvers::DenseSolveCore;
use faer::prelude::Solve;
use faer::{Mat, Side};

use super::core_modes::{CoreModes, creeps};
use super::record_problem::{Grouping, State, total};
use super::records_of_test::TestRecords;
use super::starts::Costed;
use super::widened_lines::WIDENINGS;
use crate::IdentifyError;
use crate::least_squares::{Ending, Quadratic, descend_along};

/// A hypothesis with its sums of squares on the narrowest lines.
#[derive(Clone)]
pub(super) struct Fit {
    pub state: State,
    /// What a search moved.
    pub parameters: Vec<f64>,
    /// Sums of squares by place, the last being what is known of damping beforehand.
    pub places: Vec<Quadratic>,
    /// Sum of squares at the minimum.
    pub cost: f64,
    /// Number of free parameters.
    pub size: usize,
    /// Where the search for it was given up: its parameters are no minimum, and `cost` is a promise.
    pub given_up: Option<usize>,
}

impl Fit {
    /// Misfit per datum, in units of the records' noise.
    pub(super) fn chi_square(&self, records: &TestRecords) -> f64 {
        self.cost / records.problem(LAST).data().max(1) as f64
    }
}

/// The narrowest lines.
pub(super) const LAST: usize = WIDENINGS.len() - 1;

/// Evaluations at each widening: a valley that bends, as a core's modulus over frequency makes one, takes many. What wide lines do not
/// tell waits for narrow ones where it is.
pub(super) const PATIENCE: [Ending; WIDENINGS.len()] = [
    Ending::far(16, 1.0).resting(),
    Ending::far(12, 1.0).resting(),
    Ending::far(8, 1.0).resting(),
    Ending::far(30, 0.2),
];

/// Fits from `state`, beginning at the widening of this number.
///
/// # Errors
/// What the model refuses, as where a place comes to lie off the piece.
pub(super) fn fit(records: &TestRecords, state: State, from: usize) -> Result<Fit, IdentifyError> {
    let (state, _) = polished_through(records, (state, f64::INFINITY), from..=LAST)?;
    settle(records, state, None)
}

/// A state taken from minimum to minimum through these widenings, each with its patience.
///
/// # Errors
/// As [`polish`].
pub(super) fn polished_through(
    records: &TestRecords,
    begun: Costed,
    mut stages: RangeInclusive<usize>,
) -> Result<Costed, IdentifyError> {
    stages.try_fold(begun, |(state, _), stage| polish(records, &state, stage, PATIENCE[stage]))
}

/// A hypothesis as it stands; where the search was given up at a widening, with the sum of squares that one more step
/// promises.
///
/// # Errors
/// What the model refuses.
pub(super) fn settle(records: &TestRecords, state: State, given_up: Option<usize>) -> Result<Fit, IdentifyError> {
    let problem = records.problem(LAST);
    let parameters = problem.parameters(&state);
    let places = problem.by_group(&parameters, &state, Grouping::Places)?;
    let whole = total(&places);
    let cost = if given_up.is_some() { promise(&whole).max(0.0) } else { whole.cost };
    Ok(Fit { size: parameters.len(), parameters, places, cost, state, given_up })
}

/// The state at the minimum of one widening, and its sum of squares.
pub(super) fn polish(
    records: &TestRecords,
    state: &State,
    stage: usize,
    patience: Ending,
) -> Result<(State, f64), IdentifyError> {
    let problem = records.problem(stage);
    let (start, bounds) = (problem.parameters(state), problem.bounds(state));
    let modes = if creeps(&state.hypothesis) { CoreModes::of(&problem, state) } else { None };
    let advance = |from: &[f64], trial: &[f64]| modes.as_ref()?.straightened(&state.hypothesis, from, trial);
    let searched = descend_along((|p| problem.linearise(p, state), advance), &start, &bounds, patience);
    let (minimum, _) = searched.map_err(IdentifyError::refused)?;
    Ok((problem.state(&minimum.parameters, state), minimum.at.cost))
}

/// What is left of a sum of squares after one step, to first order: how good a start is.
///
/// The step is damped a little, so that a direction without slope promises nothing.
pub(super) fn promise(at: &Quadratic) -> f64 {
    let mut normal = at.normal.clone();
    for i in 0..normal.nrows() {
        normal[(i, i)] = normal[(i, i)] * (1.0 + DAMPED) + f64::MIN_POSITIVE;
    }
    let gradient = faer::Mat::from_fn(at.gradient.len(), 1, |i, _| at.gradient[i]);
    let Ok(factor) = normal.llt(Side::Lower) else { return at.cost };
    let step = factor.solve(&gradient);
    at.cost - (gradient.transpose() * step)[(0, 0)]
}

const DAMPED: f64 = 1e-3;

/// Covariance of everything that a search moved where a misfit of `unit` per datum counts as one; what is known beforehand
/// stays as sure as it is. `None` where the data do not tell.
pub(super) fn covariance(fit: &Fit, unit: f64) -> Option<Mat<f64>> {
    let (beforehand, data) = fit.places.split_last()?;
    let normal = faer::Scale(1.0 / unit) * total(data).normal + &beforehand.normal;
    Some(normal.llt(Side::Lower).ok()?.inverse())
}

/// Sums of squares at a fit, hit by hit where places are not what is left out, the last being what is known of damping beforehand.
pub(super) fn by_group(records: &TestRecords, fit: &Fit, grouping: Grouping) -> Result<Vec<Quadratic>, IdentifyError> {
    if grouping == Grouping::Places {
        return Ok(fit.places.clone());
    }
    Ok(records.problem(LAST).by_group(&fit.parameters, &fit.state, grouping)?)
}
