//! A structure whose constants are searched for.

use orthopanel_model::{Boundary, Piece, StructureKind};

use super::{MeasuredModes, RecordedStructure};
use crate::IdentifyError;
use crate::free_constants::FreeConstants;

/// How far the modes of a usual test show a structure's constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shown {
    /// Wholly: modes bend one way and rise in order, and as many as there are constants show all of them. They are searched for
    /// at once.
    Wholly,
    /// In part: modes go both ways, are told by their nodal lines and may cross. Constants are freed one by one as the modes show
    /// them, and the others rest at what is usual.
    InPart,
}

/// A structure whose constants are searched for.
pub(crate) trait SearchedStructure: std::fmt::Debug + Sync {
    /// Which one it is.
    fn kind(&self) -> StructureKind;

    /// How far its modes show its constants.
    fn shown(&self) -> Shown;

    /// The modes that a list measures, told by their nodal lines.
    ///
    /// # Errors
    /// Nodal lines that the structure has no mode for.
    fn measured_modes(
        &self,
        piece: &Piece,
        boundary: Boundary,
        nodes: Vec<[usize; 2]>,
    ) -> Result<Box<dyn MeasuredModes>, IdentifyError>;

    /// A piece of it with records.
    fn recorded(&self, piece: &Piece, boundary: Boundary) -> Box<dyn RecordedStructure>;

    /// Relative error of a frequency by the basis: poles of records are read far more finely. Zero of exact modes.
    fn basis_error(&self) -> f64 {
        0.0
    }

    /// Natural frequency \[Hz\] of the mode with these nodal lines within a quarter, without solving for it; `None` where nothing
    /// tells it, and then no name in a list is refused as impossible.
    fn estimated_frequency(&self, _: &Piece, _: Boundary, _values: &[f64], _nodes: [usize; 2]) -> Option<f64> {
        None
    }

    /// What held constants ask of a free one, where it ends near that limit at these values of all constants.
    fn near_limit(&self, _constants: &FreeConstants, _values: &[f64]) -> Option<String> {
        None
    }
}
