//! Pieces that miss together what one of them would meet with a constant of its own.

use faer::prelude::Solve;
use faer::{Mat, Side};
use orthopanel_data::ImpactTest;

use super::all_at_once::MET;
use super::minimum::{Minimum, least_squares};
use super::noise::{BEYOND_CHANCE, Noise};
use super::other_starts::cost;
use super::problem::{FrequencyProblem, SetPrediction};
use crate::free_constants::{FreeConstant, FreeConstants};
use crate::least_squares::Quadratic;

/// A constant of a piece's own is told where it leaves less than this part of the sum of squares: half of the error.
const FAR_BETTER: f64 = 0.25;
/// Pairs of piece and constant that are tried, those first of which one step promises most.
const MOST_TRIED: usize = 3;

/// What is said of pieces that miss their lists together by far more than these scatter, and meet them with one constant of one
/// piece's own: then no name is in doubt.
pub(super) fn met_with_an_own_constant(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &Minimum,
) -> Option<String> {
    let (missed, noise) = (cost(problem, found), Noise::stated(problem).variance * problem.count() as f64);
    if missed < BEYOND_CHANCE.powi(2) * noise {
        return None;
    }
    let met = own_constant(test, problem, &found.parameters, &found.predictions, MET.powi(2) * noise)?;
    let percent = 100.0 * (missed / problem.count() as f64).sqrt();
    Some(format!("the pieces together miss their frequencies by {percent:.2} % rms; {met}"))
}

/// The piece and the constant of its own that leave half of the error or less, if any do.
pub(super) fn own_constant_that_helps(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &[f64],
    predictions: &[SetPrediction],
) -> Option<String> {
    let missed = problem.linearised(predictions, &problem.constants).quadratic().cost;
    own_constant(test, problem, found, predictions, FAR_BETTER * missed)
}

/// The piece and the constant of its own that leave the least, and less than `most` of the sum of squares.
fn own_constant(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &[f64],
    predictions: &[SetPrediction],
    most: f64,
) -> Option<String> {
    let mut tried: Vec<(f64, FreeConstants, Vec<f64>, FreeConstant)> = Vec::new();
    for (own, constants, parameters) in with_one_of_its_own(problem, found) {
        let at = problem.linearised(predictions, &constants).quadratic();
        // Fewer lines than constants are met by anything.
        if problem.count() > constants.count() + 1
            && let Some(left) = left_after_a_step(&at)
        {
            tried.push((left, constants, parameters, own));
        }
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f64, FreeConstant)> = None;
    for (_, constants, parameters, own) in tried.into_iter().take(MOST_TRIED) {
        let problem = FrequencyProblem { structure: problem.structure, constants, sets: problem.sets.clone() };
        let Ok(minimum) = least_squares(&problem, &parameters, None) else { continue };
        let left = cost(&problem, &minimum);
        if left < best.map_or(most, |(least, _)| least) {
            best = Some((left, own));
        }
    }
    let (left, FreeConstant { constant, piece }) = best?;
    let (name, piece) = (problem.constants.constants[constant].name, &test.pieces[piece?].name);
    Some(format!(
        "with {name} of its own for piece {piece} (own_constants = [\"{name}\"] in its [[piece]]) the pieces are met to {:.2} % rms",
        100.0 * (left / problem.count() as f64).sqrt()
    ))
}

/// Each piece with each shared constant of its own, at the values that all have.
fn with_one_of_its_own(problem: &FrequencyProblem, found: &[f64]) -> Vec<(FreeConstant, FreeConstants, Vec<f64>)> {
    let mut pieces: Vec<usize> = problem.sets.iter().map(|set| set.piece).collect();
    pieces.sort_unstable();
    pieces.dedup();
    let mut all = Vec::new();
    for (index, shared) in problem.constants.free.iter().enumerate().filter(|(_, free)| free.piece.is_none()) {
        let owns = |piece: usize| FreeConstant { constant: shared.constant, piece: Some(piece) };
        let sharing: Vec<usize> =
            pieces.iter().copied().filter(|piece| !problem.constants.free.contains(&owns(*piece))).collect();
        if sharing.len() < 2 {
            continue;
        }
        for own in sharing.into_iter().map(owns) {
            let (mut constants, mut parameters) = (problem.constants.clone(), found.to_vec());
            constants.free.insert(index + 1, own);
            parameters.insert(index + 1, found[index]);
            all.push((own, constants, parameters));
        }
    }
    all
}

/// The sum of squares that one whole step promises; `None` where a constant moves nothing.
fn left_after_a_step(at: &Quadratic) -> Option<f64> {
    let slope = Mat::from_fn(at.gradient.len(), 1, |i, _| at.gradient[i]);
    let step = at.normal.llt(Side::Lower).ok()?.solve(&slope);
    Some(at.cost - (0..at.gradient.len()).map(|i| at.gradient[i] * step[(i, 0)]).sum::<f64>())
}
