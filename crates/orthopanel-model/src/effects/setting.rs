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
    /// Where other sensors sit meanwhile.
    pub beside: Vec<Place>,
    /// When the hammer strikes \[s\], from the beginning of the record.
    pub hit_time: f64,
    /// What is known of how the suspension points move.
    pub suspension_motion: SuspensionMotion,
}

/// What is known of how the suspension points move in a record, on which forces that are not linear depend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SuspensionMotion {
    /// Nothing.
    #[default]
    Unknown,
    /// Whoever asks works the forces out of the hits, in time, and joins what they do: the receptance is left linear.
    InTime,
}

impl RecordSetting {
    /// With this number where it has none.
    pub(super) fn numbered(self, number: usize) -> Self {
        if self.number == 0 { Self { number, ..self } } else { self }
    }
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
