//! The plate, of whose six constants a list shows what its modes bend and twist.

mod measured_modes;
mod recorded;

use orthopanel_model::{Boundary, MindlinPlate, Piece, StructureKind};

use super::{MeasuredModes, RecordedStructure, SearchedStructure, Shown};
use crate::IdentifyError;
use measured_modes::PlateModes;
use recorded::RecordedPlate;

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
}
