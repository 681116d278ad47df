//! The plate, of whose six constants a list shows what its modes bend and twist.

mod measured_modes;
mod recorded;

use orthopanel_model::{Boundary, MindlinPlate, Piece, StructureKind};

use super::{MeasuredModes, RecordedStructure, SearchedStructure, Shown};
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use measured_modes::PlateModes;
use recorded::RecordedPlate;

/// A constant within this factor of the limit of a definite law was kept from where the data want it: the stiffness
/// $E_x^2/(E_x-\nu_{xy}^2E_y)$ is least at twice the limit, so a plate that should be softer ends there.
const NEAR_LIMIT: f64 = 2.5;

/// An orthotropic Mindlin plate.
#[derive(Debug)]
pub(super) struct Plate;

impl SearchedStructure for Plate {
    fn kind(&self) -> StructureKind {
        StructureKind::MindlinPlate
    }

    fn shown(&self) -> Shown {
        Shown::InPart
    }

    fn measured_modes(
        &self,
        piece: &Piece,
        boundary: Boundary,
        nodes: Vec<[usize; 2]>,
    ) -> Result<Box<dyn MeasuredModes>, IdentifyError> {
        Ok(Box::new(PlateModes::new(piece, boundary, nodes)?))
    }

    fn recorded(&self, piece: &Piece, boundary: Boundary) -> Box<dyn RecordedStructure> {
        Box::new(RecordedPlate { piece: *piece, boundary })
    }

    // On the basis chosen for a list.
    fn basis_error(&self) -> f64 {
        1e-4
    }

    fn estimated_frequency(&self, piece: &Piece, boundary: Boundary, values: &[f64], nodes: [usize; 2]) -> Option<f64> {
        MindlinPlate::estimated_frequency(piece, boundary, values, nodes).ok()
    }

    // The law is definite while $E_x > \nu_{xy}^2E_y$.
    fn near_limit(&self, constants: &FreeConstants, values: &[f64]) -> Option<String> {
        let &[e_x, e_y, ..] = values else { return None };
        match ["e_x", "e_y", "nu_xy"].map(|name| constants.held_at(name)) {
            [None, Some(e_y), Some(nu_xy)] if e_x < NEAR_LIMIT * nu_xy * nu_xy * e_y => Some(format!(
                "nu_xy = {nu_xy} and e_y = {e_y:.3e} Pa as held ask for e_x above nu_xy^2 e_y = {:.3e} Pa, which keeps it from what \
                 the frequencies want: look at what is held",
                nu_xy * nu_xy * e_y
            )),
            [Some(e_x), None, Some(nu_xy)] if NEAR_LIMIT * e_y * nu_xy * nu_xy > e_x => Some(format!(
                "nu_xy = {nu_xy} and e_x = {e_x:.3e} Pa as held ask for e_y below e_x/nu_xy^2 = {:.3e} Pa, which keeps it from \
                 what the frequencies want: look at what is held",
                e_x / (nu_xy * nu_xy)
            )),
            _ => None,
        }
    }
}
