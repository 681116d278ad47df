//! The paper's beam, whose constants every list of bending modes shows.

mod measured_modes;
mod recorded;

use orthopanel_model::{Boundary, Piece, StructureKind};

use super::{MeasuredModes, RecordedStructure, SearchedStructure, Shown};
use crate::IdentifyError;
use measured_modes::BeamModes;
use recorded::RecordedBeam;

/// An orthotropic Timoshenko beam.
#[derive(Debug)]
pub(super) struct Beam;

impl SearchedStructure for Beam {
    fn kind(&self) -> StructureKind {
        StructureKind::TimoshenkoBeam
    }

    fn shown(&self) -> Shown {
        Shown::Wholly
    }

    fn measured_modes(
        &self,
        piece: &Piece,
        boundary: Boundary,
        nodes: Vec<[usize; 2]>,
    ) -> Result<Box<dyn MeasuredModes>, IdentifyError> {
        Ok(Box::new(BeamModes::new(piece, boundary, nodes)?))
    }

    fn recorded(&self, piece: &Piece, boundary: Boundary) -> Box<dyn RecordedStructure> {
        Box::new(RecordedBeam { piece: *piece, boundary })
    }
}
