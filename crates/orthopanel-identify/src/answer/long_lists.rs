//! Lists that are too long to be traced.

use orthopanel_data::{ImpactTest, Measurement, MeasurementData, limits};

use crate::IdentifyError;

/// # Errors
/// [`IdentifyError::TooManyFrequencies`], [`IdentifyError::TooManyFrequenciesOfPiece`].
pub(super) fn refuse_many(test: &ImpactTest) -> Result<(), IdentifyError> {
    let listed = |measurement: &Measurement| match &measurement.data {
        MeasurementData::NaturalFrequencies(list) => list.values.len(),
        _ => 0,
    };
    let found = test.measurements.iter().map(listed).max().unwrap_or(0);
    if found > limits::FREQUENCIES_TRACED {
        return Err(IdentifyError::TooManyFrequencies { found, most: limits::FREQUENCIES_TRACED });
    }
    let most = limits::FREQUENCIES_TRACED_OF_PIECE;
    for (index, piece) in test.pieces.iter().enumerate() {
        let found = test.measurements.iter().filter(|of| of.piece == index).map(listed).sum();
        if found > most {
            return Err(IdentifyError::TooManyFrequenciesOfPiece { piece: piece.name.clone(), found, most });
        }
    }
    Ok(())
}
