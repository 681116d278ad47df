//! All constants of a plate at once, each kept near what is usual: where those that are told one by one do not meet the list.
//!
//! Several constants may move the frequencies together though none of them is told by itself: bending modes of wide pieces
//! follow $E_y$, $\nu_{xy}$ and both moduli of shear, and tell no single one. Freed one by one they all stay at rest, and the
//! list is missed. And near a square two modes share both products of a name, so that a search that begins on the wrong
//! side of it stays there.

use faer::prelude::Solve;
use faer::{Mat, Side};
use rayon::prelude::*;

use super::hidden_constants::{carried, worst_hidden};
use super::minimum::{Minimum, least_squares};
use super::noise::Noise;
use super::other_starts::{cost, starts};
use super::problem::{FrequencyProblem, SetPrediction};
use crate::IdentifyError;
use crate::free_constants::{FreeConstants, Rest};
use crate::least_squares::{Ending, Quadratic, descend};
use crate::usual_ratios::BesideUsual;

/// The list is met where its lines are missed by less than so many times what they scatter, and missed beyond twice that.
pub(super) const MET: f64 = 2.0;
/// No other start is tried where what is left is less than this part of that.
const WELL_MET: f64 = 0.5;
/// A constant is seen where the list leaves less than this part of what was open.
const SEEN: f64 = 0.5;
/// $\ln E_y$, $\ln G_{yz}$ and $\ln G_{xy}$ are looked at in such steps, so many down and up: where modes veer, a basin is little wider.
const ACROSS_STEP: f64 = 0.2;
const ACROSS_STEPS: [(i8, i8); 3] = [(-5, 3), (-5, 3), (-1, 1)];
/// Starts that are followed.
const MOST_STARTS: usize = 8;

/// The minimum over the constants that the list shows when all are free, where that meets a list that `found` misses.
pub(super) fn meets_at_once(problem: &mut FrequencyProblem, all: &FreeConstants, found: &Minimum) -> Option<Minimum> {
    let noise = Noise::stated(problem).variance * problem.count() as f64;
    if problem.count() <= all.count() || cost(problem, found) < (2.0 * MET).powi(2) * noise {
        return None;
    }
    let before = problem.constants.clone();
    problem.constants = all.clone();
    let begun = likely_starts(problem, starts(&before, all, &found.parameters));
    let mut best: Option<(f64, FreeConstants, Minimum)> = None;
    for start in begun {
        problem.constants = all.clone();
        let Ok(minimum) = from_start(problem, all, start) else { continue };
        let reached = cost(problem, &minimum);
        if reached < best.as_ref().map_or(MET.powi(2) * noise, |(least, ..)| *least) {
            best = Some((reached, problem.constants.clone(), minimum));
        }
        if reached < WELL_MET.powi(2) * noise {
            break;
        }
    }
    let (constants, met) = best.map_or((before, None), |(_, constants, met)| (constants, Some(met)));
    problem.constants = constants;
    met
}

/// The minimum from one start; constants that it does not show rest where it has them.
fn from_start(problem: &mut FrequencyProblem, all: &FreeConstants, start: Vec<f64>) -> Result<Minimum, IdentifyError> {
    let pieces = problem.sets.iter().map(|set| set.piece).collect();
    let usual = BesideUsual { constants: all, start: start.clone(), pieces };
    let linearise = |parameters: &[f64]| weighed(problem, &usual, parameters);
    let (found, _) = descend(linearise, &start, &all.bounds(), Ending::WITH_JUMPS).map_err(IdentifyError::refused)?;
    let beside_usual = found.parameters;
    let mut minimum = least_squares_where_told(problem, beside_usual.clone())?;
    while let Some(constant) = worst_hidden(problem, &minimum) {
        let free = problem.constants.clone();
        // Where what is usual had it: by itself the list takes it anywhere.
        rest_there(problem, all, &beside_usual, constant);
        let from = carried(&free, &minimum.parameters, &problem.constants);
        minimum = least_squares(problem, &from, None)?;
    }
    Ok(minimum)
}

/// The minimum from where all were kept near what is usual: one by one, those that the list tells least rest where it has them.
fn least_squares_where_told(
    problem: &mut FrequencyProblem,
    mut parameters: Vec<f64>,
) -> Result<Minimum, IdentifyError> {
    loop {
        let predictions = problem.predictions(&parameters)?;
        let Some(constant) = least_told(problem, &parameters, &predictions) else {
            return least_squares(problem, &parameters, None);
        };
        let free = problem.constants.clone();
        rest_there(problem, &free, &parameters, constant);
        parameters = carried(&free, &parameters, &problem.constants);
    }
}

/// The constant of which the list tells the least beside what is usual, by the scatter that is left, where that is too little.
fn least_told(problem: &FrequencyProblem, parameters: &[f64], predictions: &[SetPrediction]) -> Option<usize> {
    let constants = &problem.constants;
    let at = problem.linearised(predictions, constants);
    let variance = Noise::left(problem, &at).wide_variance();
    let mut sum = at.quadratic();
    let count = parameters.len();
    (0..count).for_each(|i| (0..count).for_each(|j| sum.normal[(i, j)] /= variance));
    let pieces = problem.sets.iter().map(|set| set.piece).collect();
    let usual = BesideUsual { constants, start: parameters.to_vec(), pieces };
    usual.add_to(&mut sum, parameters);
    sum.mirror();
    let covariance = sum.covariance();
    let left = |index: usize| {
        let std = covariance.as_ref().map_or(f64::INFINITY, |matrix| matrix[(index, index)].sqrt());
        (constants.free[index].constant, std / usual.open(index))
    };
    let hidden = (0..count).map(left).filter(|(_, left)| *left > SEEN);
    hidden.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(constant, _)| constant)
}

/// Of these starts and of the first one with the moduli across the panel beside where it has them, those from which one step promises
/// most.
///
/// Modes along a wide piece veer with those across it, which $E_y$, $G_{yz}$ and $G_{xy}$ put above them or below. Each such change of
/// places is a ridge that no search climbs, so all sides are looked at.
fn likely_starts(problem: &FrequencyProblem, mut starts: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let Some(own) = starts.first().cloned() else { return starts };
    let named = |name: &str| (0..own.len()).filter(|&index| problem.constants.constant(index).name == name).collect();
    let across: [Vec<usize>; 3] = ["e_y", "g_yz", "g_xy"].map(named);
    let mut more = vec![own.clone()];
    for (own, (down, up)) in across.iter().zip(ACROSS_STEPS).filter(|(own, _)| !own.is_empty()) {
        let moved = |start: &Vec<f64>, steps: i8| {
            let mut start = start.clone();
            own.iter().for_each(|&index| start[index] += ACROSS_STEP * f64::from(steps));
            start
        };
        more = more.iter().flat_map(|start| (down..=up).map(move |steps| moved(start, steps))).collect();
    }
    starts.append(&mut more);
    let pieces: Vec<usize> = problem.sets.iter().map(|set| set.piece).collect();
    let judged = starts.into_par_iter().filter_map(|start| {
        let usual = BesideUsual { constants: &problem.constants, start: own.clone(), pieces: pieces.clone() };
        let at = weighed(problem, &usual, &start).ok()?;
        let slope = Mat::from_fn(start.len(), 1, |i, _| at.gradient[i]);
        let step = at.normal.llt(Side::Lower).ok()?.solve(&slope);
        let promised: f64 = (0..start.len()).map(|i| at.gradient[i] * step[(i, 0)]).sum();
        Some((at.cost - promised, start))
    });
    let mut judged: Vec<(f64, Vec<f64>)> = judged.collect();
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut likely: Vec<Vec<f64>> = Vec::new();
    for (_, start) in judged {
        let near = |other: &Vec<f64>| other.iter().zip(&start).all(|(a, b)| (a - b).abs() < 0.5 * ACROSS_STEP);
        if likely.len() < MOST_STARTS && !likely.iter().any(near) {
            likely.push(start);
        }
    }
    likely
}

/// The list's sum of squares over what it scatters, and what the parameters lie beside the usual ones.
fn weighed(problem: &FrequencyProblem, usual: &BesideUsual, parameters: &[f64]) -> Result<Quadratic, IdentifyError> {
    let variance = Noise::stated(problem).variance;
    let mut sum = problem.linearise(parameters)?.quadratic();
    let count = parameters.len();
    sum.cost /= variance;
    sum.gradient.iter_mut().for_each(|slope| *slope /= variance);
    (0..count).for_each(|i| (0..count).for_each(|j| sum.normal[(i, j)] /= variance));
    usual.add_to(&mut sum, parameters);
    sum.mirror();
    Ok(sum)
}

/// Lets a constant that is free among these rest at its value.
fn rest_there(problem: &mut FrequencyProblem, constants: &FreeConstants, parameters: &[f64], constant: usize) {
    let owner = constants.free.iter().find(|free| free.constant == constant).and_then(|free| free.piece);
    if problem.constants.free.iter().any(|free| free.constant == constant) {
        let value = constants.values(parameters, owner.unwrap_or(0))[constant];
        problem.constants.rest(constant, Rest::Held(value));
    }
}
