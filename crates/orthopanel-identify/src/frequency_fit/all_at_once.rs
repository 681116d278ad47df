//! All constants of a plate at once, each kept near what is usual: where those that are told one by one do not meet the list.
//!
//! Several constants may move the frequencies together though none of them is told by itself: bending modes of wide pieces
//! follow $E_y$, $\nu_{xy}$ and both moduli of shear, and tell no single one. Freed one by one they all stay at rest, and the
//! list is missed. And near a square two modes share both products of a name, so that a search that begins on the wrong
//! side of it stays there.

use super::noise::Noise;
use super::other_starts::{cost, starts};
use super::problem::FrequencyProblem;
use super::seen_constants::{carried, worst_hidden};
use super::{Minimum, least_squares};
use crate::IdentifyError;
use crate::free_constants::{FreeConstants, Rest};
use crate::least_squares::{Ending, Quadratic, descend};
use crate::usual_plate::BesideUsual;

/// The list is met where its lines are missed by less than so many times what they scatter, and missed beyond twice that.
const MET: f64 = 2.0;
/// A constant is seen where the list leaves less than this part of what was open.
const SEEN: f64 = 0.5;

/// The minimum over the constants that the list shows when all are free, where that meets a list that `found` misses.
pub(super) fn meets_at_once(problem: &mut FrequencyProblem, all: &FreeConstants, found: &Minimum) -> Option<Minimum> {
    let noise = Noise::stated(problem).variance * problem.count() as f64;
    if problem.count() <= all.count() || cost(problem, found) < (2.0 * MET).powi(2) * noise {
        return None;
    }
    let before = problem.constants.clone();
    for start in starts(&before, all, &found.parameters) {
        problem.constants = all.clone();
        match from_start(problem, all, start) {
            Ok(minimum) if cost(problem, &minimum) < MET.powi(2) * noise => return Some(minimum),
            _ => {}
        }
    }
    problem.constants = before;
    None
}

/// The minimum from one start; constants that it does not show rest where it has them.
fn from_start(problem: &mut FrequencyProblem, all: &FreeConstants, start: Vec<f64>) -> Result<Minimum, IdentifyError> {
    let pieces = problem.sets.iter().map(|set| set.piece).collect();
    let usual = BesideUsual { constants: all, start: start.clone(), pieces };
    let variance = Noise::stated(problem).variance;
    let linearise = |parameters: &[f64]| -> Result<Quadratic, IdentifyError> {
        let mut sum = problem.linearise(parameters)?.quadratic();
        let count = parameters.len();
        sum.cost /= variance;
        sum.gradient.iter_mut().for_each(|slope| *slope /= variance);
        (0..count).for_each(|i| (0..count).for_each(|j| sum.normal[(i, j)] /= variance));
        usual.add_to(&mut sum, parameters);
        sum.mirror();
        Ok(sum)
    };
    let (found, _) = descend(linearise, &start, &all.bounds(), Ending::WITH_JUMPS).map_err(IdentifyError::refused)?;
    let parameters = found.parameters;
    let covariance = found.at.covariance();
    let open = |index: usize| {
        let std = covariance.as_ref().map_or(f64::INFINITY, |matrix| matrix[(index, index)].sqrt());
        std > SEEN * usual.open(index)
    };
    let hidden: Vec<usize> =
        (0..all.count()).filter(|&index| open(index)).map(|index| all.free[index].constant).collect();
    hidden.into_iter().for_each(|constant| rest_there(problem, all, &parameters, constant));
    let from = carried(all, &parameters, &problem.constants);
    let mut minimum = least_squares(problem, &from, None)?;
    while let Some(constant) = worst_hidden(problem, &minimum) {
        let free = problem.constants.clone();
        rest_there(problem, &free, &minimum.parameters, constant);
        let from = carried(&free, &minimum.parameters, &problem.constants);
        minimum = least_squares(problem, &from, None)?;
    }
    Ok(minimum)
}

/// Lets a constant that is free among these rest at its value.
fn rest_there(problem: &mut FrequencyProblem, constants: &FreeConstants, parameters: &[f64], constant: usize) {
    let owner = constants.free.iter().find(|free| free.constant == constant).and_then(|free| free.piece);
    if problem.constants.free.iter().any(|free| free.constant == constant) {
        let value = constants.values(parameters, owner.unwrap_or(0))[constant];
        problem.constants.rest(constant, Rest::Held(value));
    }
}
