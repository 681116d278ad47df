//! The records of a test, piece by piece, and their poles.

use orthopanel_model::{Boundary, Piece};

use super::matching::PiecePoles;
use super::pole::Pole;
use super::records::PlaceRecord;
use crate::free_constants::FreeConstants;
use crate::structures::SearchedStructure;

/// The records of a test and their poles.
pub(super) struct Recorded {
    pub structure: &'static dyn SearchedStructure,
    pub boundary: Boundary,
    /// Constants that the test leaves free.
    pub constants: FreeConstants,
    pub pieces: Vec<StartPiece>,
    pub poles: Vec<PiecePoles>,
    pub notes: Vec<String>,
}

impl Recorded {
    /// The records of all pieces.
    pub fn records(&self) -> impl Iterator<Item = &PlaceRecord> {
        self.pieces.iter().flat_map(|piece| &piece.records)
    }
}

pub(super) struct StartPiece {
    pub index: usize,
    pub sizes: Piece,
    pub records: Vec<PlaceRecord>,
    pub poles: Vec<Pole>,
}
