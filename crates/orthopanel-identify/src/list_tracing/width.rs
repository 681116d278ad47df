//! The plate in place of the beam.

use orthopanel_data::ImpactTest;
use orthopanel_model::StructureKind;

use super::hypothesis::Hypothesis;
use super::list_fit::ListFit;
use super::list_problem::ListProblem;
use crate::{IdentifyError, Settings, identify};

/// The test of pieces that are plates.
pub(super) fn as_plate(test: &ImpactTest) -> ImpactTest {
    ImpactTest { structure: Some(StructureKind::MindlinPlate), effects: vec![], ..test.clone() }
}

/// Identifies the plate from the same lists; constants that these do not show rest at their usual values.
///
/// # Errors
/// As [`identify`].
pub(super) fn fit_plate(test: &ImpactTest, problem: &ListProblem) -> Result<ListFit, IdentifyError> {
    let found = identify(&as_plate(test), Settings::default())?;
    let residuals: Vec<f64> =
        found.pieces.iter().flat_map(|piece| &piece.modes).map(|mode| mode.error_percent() / 100.0).collect();
    let size = found.constants.iter().filter(|constant| constant.std.is_some()).count();
    let left_out = match found.left_one_out_percent {
        Some(percent) => vec![percent / 100.0; residuals.len()],
        // A plate of which nothing is free foretells each frequency without the others.
        None if size == 0 => residuals.clone(),
        None => {
            let why = format!(
                "without one of these {} frequencies a constant of the plate is not determined, so none can be held out \
                 to judge by: measure more modes, or hold constants that are known",
                residuals.len()
            );
            return Err(IdentifyError::Unsupported(why));
        }
    };
    if residuals.len() != problem.count() {
        return Err(IdentifyError::Unsupported("the plate's modes are not those of the list".to_owned()));
    }
    Ok(ListFit {
        hypothesis: Hypothesis::default(),
        parameters: vec![],
        left_out,
        residuals,
        std: vec![],
        size,
        scatter: problem.scatter(),
        plate: Some(found),
        mirrored: false,
        other_minima: vec![],
        reaches: None,
    })
}
