//! What each start of an effect leaves of lists of frequencies, once the constants have taken what they can of it.
//!
//! A mass shifts all frequencies down, and so does a lower modulus: with the constants held where the base left them a start at the right
//! place stands no higher than others. The constants' derivatives are projected out of each start's residuals $r$:
//! $\lVert r - QQ^Tr\rVert^2$ with the orthonormal $Q$ of the derivatives at the base.

use orthopanel_model::ModelError;
use rayon::prelude::*;

use super::hypothesis::Hypothesis;
use super::list_problem::ListProblem;

/// Step of a constant's parameter, its logarithm, in a derivative.
const STEP: f64 = 1e-4;
/// What is left of a column of derivatives that the others already span.
const SPANNED: f64 = 1e-6;

/// What each start leaves, infinite where the model refuses it.
///
/// # Errors
/// What the base's model refuses.
pub(super) fn left_by_each(
    problem: &ListProblem,
    (declared, constants): (&Hypothesis, &[f64]),
    starts: &[Hypothesis],
) -> Result<Vec<f64>, ModelError> {
    let directions = directions(problem, declared, constants)?;
    let left = |hypothesis: &Hypothesis| -> f64 {
        let parameters = [constants, &hypothesis.coordinates()].concat();
        problem.weighed(&parameters, hypothesis).map_or(f64::INFINITY, |mut residuals| {
            project_out(&mut residuals, &directions);
            dot(&residuals, &residuals)
        })
    };
    Ok(starts.par_iter().map(left).collect())
}

/// Orthonormal directions into which the constants move the residuals.
fn directions(problem: &ListProblem, declared: &Hypothesis, constants: &[f64]) -> Result<Vec<Vec<f64>>, ModelError> {
    let at = |constants: &[f64]| problem.weighed(&[constants, &declared.coordinates()].concat(), declared);
    let here = at(constants)?;
    let mut directions: Vec<Vec<f64>> = Vec::new();
    for moved in 0..constants.len() {
        let mut there = constants.to_vec();
        there[moved] += STEP;
        let mut column: Vec<f64> = at(&there)?.iter().zip(&here).map(|(there, here)| (there - here) / STEP).collect();
        let whole = dot(&column, &column).sqrt();
        project_out(&mut column, &directions);
        let norm = dot(&column, &column).sqrt();
        if norm > SPANNED * whole {
            column.iter_mut().for_each(|value| *value /= norm);
            directions.push(column);
        }
    }
    Ok(directions)
}

fn project_out(residuals: &mut [f64], directions: &[Vec<f64>]) {
    for direction in directions {
        let along = dot(residuals, direction);
        residuals.iter_mut().zip(direction).for_each(|(residual, part)| *residual -= along * part);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
