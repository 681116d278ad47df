//! The test that an effect acts on.

use crate::{Boundary, ModelError, Piece, Place};

/// What an effect may ask about a test: the piece, how it is held, and one of its records.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectSetting {
    /// The piece.
    pub piece: Piece,
    /// What holds its edges.
    pub boundary: Boundary,
    /// Where it hangs or rests.
    pub suspension: Vec<Place>,
    /// The record.
    pub record: RecordSetting,
}

/// One record of a test.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordSetting {
    /// Its number in the test, from 1.
    pub number: usize,
    /// Where the hammer strikes; none where natural frequencies were read.
    pub force_at: Option<Place>,
    /// Where the sensor sits; none where nothing is on the panel.
    pub response_at: Option<Place>,
    /// When the hammer strikes \[s\], from the beginning of the record.
    pub hit_time: f64,
    /// How far each suspension point moves in this record \[m\]: the effective amplitude of
    /// `cubic-stiffness`. Empty where nobody worked it out.
    pub suspension_amplitudes: Vec<f64>,
}

impl EffectSetting {
    /// The places of the suspension.
    ///
    /// # Errors
    /// [`ModelError::EffectNeeds`] where the test names none.
    pub(super) fn suspension_for(&self, effect: &'static str) -> Result<&[Place], ModelError> {
        if self.suspension.is_empty() {
            return Err(ModelError::EffectNeeds { effect, what: "suspension points ([suspension] at = [...])" });
        }
        Ok(&self.suspension)
    }
}
