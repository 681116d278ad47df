//! Which constants of a plate are free first, and where those that are not rest.

use super::hidden_constants::{carried, with_freed, worst_hidden};
use super::minimum::{Minimum, least_squares};
use super::noise::Noise;
use super::problem::FrequencyProblem;
use super::uncertainty::with_unseen;
use crate::IdentifyError;
use crate::free_constants::{FreeConstants, Rest};
use crate::starting_constants::{USUAL_SOFTNESS, guess};
use crate::usual_ratios::usual_rest;

/// The minimum over $E_x$ and $G_{zx}$ where the data show both, else over the one modulus that is told best.
pub(super) fn first_minimum(
    problem: &mut FrequencyProblem,
    all: &FreeConstants,
    start: &[f64],
) -> Result<Minimum, IdentifyError> {
    for constant in all.free_constants() {
        if let Some(rest) = usual_rest(all, constant) {
            problem.constants.rest(constant, rest);
        }
    }
    let from = carried(all, start, &problem.constants);
    if problem.count() >= problem.constants.count() {
        match least_squares(problem, &from, None) {
            Ok(minimum) if worst_hidden(problem, &minimum).is_none() => return Ok(minimum),
            Ok(_) | Err(IdentifyError::NotConverged { .. }) => {}
            Err(other) => return Err(other),
        }
    }
    let one = best_leader(problem, all)?;
    problem.constants = one.0;
    least_squares(problem, &one.1, None)
}

/// The constants with one modulus free that the others follow as is usual, and its parameter: of all moduli the one that is
/// told best, what is usual being no better known than it is.
fn best_leader(problem: &FrequencyProblem, all: &FreeConstants) -> Result<(FreeConstants, Vec<f64>), IdentifyError> {
    let resting = Resting::of(all);
    let mut best: Option<(f64, FreeConstants, Vec<f64>)> = None;
    for leader in all.free_constants().into_iter().filter(|&constant| all.is_modulus(constant)) {
        let mut constants = with_freed(&problem.constants, all, leader);
        for other in constants.free_constants().into_iter().filter(|other| *other != leader) {
            constants.rest(other, resting.following(leader, other));
        }
        let led = FrequencyProblem { structure: problem.structure, constants, sets: problem.sets.clone() };
        let usual = (0..led.constants.count())
            .map(|index| led.constants.parameter(index, resting.usual[led.constants.free[index].constant]));
        let from = led.at_right_size(&usual.collect::<Vec<f64>>())?;
        let predictions = led.predictions(&from)?;
        let covariance = with_unseen(&led, &predictions, &from, Noise::stated(&led).variance);
        let std = covariance.map_or(0.0, |covariance| covariance[(0, 0)].sqrt());
        if best.as_ref().is_none_or(|(least, ..)| std < *least) {
            best = Some((std, led.constants, from));
        }
    }
    Ok(best.map_or_else(|| (problem.constants.clone(), Vec::new()), |(_, constants, from)| (constants, from)))
}

/// Where constants rest beside others.
pub(super) struct Resting<'a> {
    /// All constants that the test leaves free.
    all: &'a FreeConstants,
    /// The constants of a usual panel beside those that are held.
    usual: Vec<f64>,
}

impl<'a> Resting<'a> {
    pub(super) fn of(all: &'a FreeConstants) -> Self {
        Self { all, usual: guess(all, USUAL_SOFTNESS) }
    }

    /// Where a constant rests that was free among these: as is usual, or beside the first free modulus.
    pub(super) fn beside(&self, constants: &FreeConstants, constant: usize) -> Rest {
        let others = constants.free_constants().into_iter().filter(|other| *other != constant);
        let leader = others.into_iter().find(|&other| constants.is_modulus(other));
        let is_own_leader =
            |rest: &Rest| matches!(rest, Rest::Follows { leader, .. } if constants.leader(*leader).0 == constant);
        let usual = usual_rest(self.all, constant).filter(|rest| !is_own_leader(rest));
        usual.or(leader.map(|leader| self.following(leader, constant))).unwrap_or(Rest::Held(self.usual[constant]))
    }

    /// As many times another as is usual.
    fn following(&self, leader: usize, constant: usize) -> Rest {
        Rest::Follows { leader, ratio: self.usual[constant] / self.usual[leader] }
    }
}
