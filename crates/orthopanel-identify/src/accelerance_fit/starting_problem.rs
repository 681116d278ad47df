//! The problem of a fit where its search begins.

use super::problem::AcceleranceProblem;
use super::records::PlaceRecord;
use super::sharpening::{Rough, problem_at};
use super::start::{Start, usual_log_zeta};
use crate::{IdentifyError, Settings};

pub(super) fn assemble(start: &Start, settings: Settings) -> Result<AcceleranceProblem, IdentifyError> {
    let rough = Rough {
        constants: start.fit.parameters.clone(),
        log_zetas: vec![Vec::new(); start.recorded.pieces.len()],
        usual_log_zeta: usual_log_zeta(start.poles.iter().flatten()),
        misfit: f64::INFINITY,
    };
    Ok(problem_at(
        start.recorded,
        &start.fit.constants,
        &rough,
        settings.damping_law,
        (f64::INFINITY, <[PlaceRecord]>::to_vec),
    )?
    .0)
}

/// The free constants and the logarithm of each damping ratio, from the poles.
pub(super) fn starting_parameters(problem: &AcceleranceProblem, start: &Start) -> Vec<f64> {
    let mut parameters = start.fit.parameters.clone();
    for ((piece, poles), matched) in problem.pieces.iter().zip(&start.poles).zip(&start.matching.modes) {
        let mut zetas = vec![problem.usual_log_zeta; piece.free_zetas];
        for (pole, mode) in poles.iter().zip(matched) {
            if let Some(zeta) = mode.and_then(|mode| zetas.get_mut(mode)) {
                *zeta = pole.zeta.ln();
            }
        }
        parameters.append(&mut zetas);
    }
    parameters
}
