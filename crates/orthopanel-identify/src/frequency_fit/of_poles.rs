//! Constants from the poles of records: eq. 22 over the modes that they show.

use std::sync::Arc;

use orthopanel_model::{Boundary, Piece};

use super::minimum::least_squares;
use super::problem::{FrequencyProblem, FrequencySet};
use super::{seen_constants, unseen_constants};
use crate::free_constants::FreeConstants;
use crate::least_squares::Quadratic;
use crate::structures::{SearchedStructure, Shown};
use crate::{IdentifyError, NotIdentified};

/// Poles of one piece that are known modes.
pub(crate) struct PoleSet {
    /// Index of the piece in the test.
    pub piece: usize,
    pub sizes: Piece,
    pub boundary: Boundary,
    /// Nodal lines of each.
    pub nodes: Vec<[usize; 2]>,
    /// \[Hz\].
    pub frequencies: Vec<f64>,
}

/// What poles tell.
pub(crate) struct PoleFit {
    /// The constants that they show are free, the others rest.
    pub constants: FreeConstants,
    pub parameters: Vec<f64>,
    /// Eq. 22 times its number of modes near the minimum.
    pub at: Quadratic,
    pub not_identified: Vec<NotIdentified>,
}

/// The constants that meet the poles best, from these values for all pieces.
pub(crate) fn fit_poles(
    structure: &'static dyn SearchedStructure,
    constants: &FreeConstants,
    start: &[f64],
    sets: Vec<PoleSet>,
) -> Result<PoleFit, IdentifyError> {
    let sets = sets.into_iter().map(|set| {
        Ok(FrequencySet {
            piece: set.piece,
            modes: structure.measured_modes(&set.sizes, set.boundary, set.nodes)?,
            rounding: match structure.basis_error() {
                0.0 => Vec::new(),
                error => set.frequencies.iter().map(|pole| error * pole).collect(),
            },
            measured: set.frequencies,
        })
    });
    let sets = sets.collect::<Result<Arc<[_]>, IdentifyError>>()?;
    let mut problem = FrequencyProblem { structure, constants: constants.clone(), sets };
    let start: Vec<f64> = constants
        .free
        .iter()
        .enumerate()
        .map(|(index, free)| constants.parameter(index, start[free.constant]))
        .collect();
    let (parameters, not_identified) = match structure.shown() {
        Shown::Wholly if start.is_empty() => (start, Vec::new()),
        Shown::Wholly => (least_squares(&problem, &start, None)?.parameters, Vec::new()),
        Shown::InPart => {
            let seen = seen_constants::minimise_what_is_seen(&mut problem, &start)?;
            let not_identified = unseen_constants::reports(&problem, constants, &seen);
            (seen.parameters, not_identified)
        }
    };
    let at = problem.linearise(&parameters)?.quadratic();
    Ok(PoleFit { constants: problem.constants, parameters, at, not_identified })
}
