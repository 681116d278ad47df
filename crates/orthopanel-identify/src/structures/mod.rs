//! What an identification asks of each structure. A new structure is one folder here and one line in [`of`]; the searches
//! themselves name none.

mod measured_modes;
mod mindlin_plate;
mod recorded_structure;
mod searched_structure;
mod timoshenko_beam;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Boundary, StructureKind};

use mindlin_plate::Plate;
use timoshenko_beam::Beam;

pub(crate) use measured_modes::{MeasuredModes, Prediction, Solved, SpectrumLine, just_below};
pub(crate) use recorded_structure::{ModeSynthesis, RecordedStructure, SeenMode};
pub(crate) use searched_structure::{SearchedStructure, Shown};

/// The structure of this kind.
pub(crate) fn of(kind: StructureKind) -> &'static dyn SearchedStructure {
    match kind {
        StructureKind::TimoshenkoBeam => &Beam,
        StructureKind::MindlinPlate => &Plate,
    }
}

/// The structure that a test file names; the paper's beam where it names none.
pub(crate) fn of_test(test: &ImpactTest) -> &'static dyn SearchedStructure {
    of(test.structure.unwrap_or(StructureKind::TimoshenkoBeam))
}

/// Nodal lines of bending modes 1 to `count`: what a list of frequencies without shapes holds.
pub(crate) fn bending_nodes(boundary: Boundary, count: usize) -> Vec<[usize; 2]> {
    (0..count).map(|index| [index + boundary.rigid_modes(), 0]).collect()
}
