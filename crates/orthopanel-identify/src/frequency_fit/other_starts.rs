//! Other starts where a fit misses: of two modes that veer each holds part of both shapes, and a search that comes from the
//! wrong side stays on a side minimum.

use super::minimum::{Minimum, least_squares};
use super::noise::{BEYOND_CHANCE, Noise};
use super::problem::FrequencyProblem;
use super::seen_constants::{let_hidden_rest, prediction_error};
use crate::free_constants::FreeConstants;

/// A root mean square residual from which no start of the right modes comes.
const HOPELESS: f64 = 0.1;
/// Another minimum is taken where its sum of squares is less than this part.
const FAR_BETTER: f64 = 0.25;
/// Where constants of a panel start beside what is usual, one at a time: factors on moduli.
const FACTORS: [f64; 2] = [0.6, 1.6];

/// Sum of the squares of the residuals.
pub(super) fn cost(problem: &FrequencyProblem, at: &Minimum) -> f64 {
    problem.linearised(&at.predictions, &problem.constants).quadratic().cost
}

/// The best of the minima over all constants that other starts lead to, where the one found misses and that one does not.
pub(super) fn from_other_starts(problem: &mut FrequencyProblem, all: &FreeConstants, found: Minimum) -> Minimum {
    let miss = (cost(problem, &found) / problem.count().max(1) as f64).sqrt();
    let least = BEYOND_CHANCE * Noise::stated(problem).variance.sqrt();
    if problem.count() <= all.count() || !(least..HOPELESS).contains(&miss) {
        return found;
    }
    let most = FAR_BETTER * cost(problem, &found);
    let mut best: Option<(f64, FreeConstants, Minimum)> = None;
    let (constants, noise) = (problem.constants.clone(), Noise::stated(problem).variance * problem.count() as f64);
    for start in starts(&constants, all, &found.parameters) {
        problem.constants = all.clone();
        let Ok(free) = least_squares(problem, &start, None) else { continue };
        let Ok(seen) = let_hidden_rest(problem, all, free) else { continue };
        let reached = cost(problem, &seen);
        let predicts = prediction_error(&problem.linearised(&seen.predictions, &problem.constants)).is_some();
        if predicts && reached < best.as_ref().map_or(most, |(least, ..)| *least) {
            best = Some((reached, problem.constants.clone(), seen));
        }
        if best.as_ref().is_some_and(|(reached, ..)| *reached < noise) {
            break;
        }
    }
    match best {
        Some((_, constants, minimum)) => {
            problem.constants = constants;
            minimum
        }
        None => {
            problem.constants = constants;
            found
        }
    }
}

/// Parameters of all constants: those found, then each modulus beside where it was found.
pub(super) fn starts(constants: &FreeConstants, all: &FreeConstants, found: &[f64]) -> Vec<Vec<f64>> {
    let at = |index: usize| {
        let free = all.free[index];
        all.parameter(index, constants.values(found, free.piece.unwrap_or(0))[free.constant])
    };
    let own: Vec<f64> = (0..all.count()).map(at).collect();
    let moduli = all.free_constants().into_iter().filter(|&constant| all.is_modulus(constant));
    let pairs = moduli.flat_map(|constant| FACTORS.map(|factor| (constant, factor.ln())));
    let moved = pairs.map(|(constant, step)| {
        let parameter = |(index, value): (usize, &f64)| {
            if all.free[index].constant == constant { value + step } else { *value }
        };
        own.iter().enumerate().map(parameter).collect()
    });
    std::iter::once(own.clone()).chain(moved).collect()
}
