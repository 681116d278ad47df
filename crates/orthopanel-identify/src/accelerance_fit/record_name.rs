//! A record by name, for notes and messages.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::Place;

/// A record by its places, for notes and messages.
pub(super) fn pair_name(force: Place, response: Place) -> String {
    format!("force at ({}, {}), response at ({}, {})", force.x, force.y, response.x, response.y)
}

/// A record by its files and places of force and response, and by its piece where there are several.
pub(super) fn record_name(test: &ImpactTest, piece: usize, places: (Place, Place)) -> String {
    let files = test.measurements.iter().filter_map(|measurement| match &measurement.data {
        MeasurementData::TimeHistory(of) | MeasurementData::Accelerance(of) => (measurement.piece == piece
            && (of.force_at, of.response_at) == places)
            .then(|| of.file.display().to_string()),
        MeasurementData::NaturalFrequencies(_) => None,
    });
    let mut files: Vec<String> = files.collect();
    files.dedup();
    let more = match files.len() {
        0 | 1 => String::new(),
        count => format!(" and {} more", count - 1),
    };
    let file = files.first().map_or(String::new(), |file| format!("{file}{more}, "));
    let of_piece = match test.pieces.get(piece) {
        Some(piece) if test.pieces.len() > 1 => format!("piece {}, ", piece.name),
        _ => String::new(),
    };
    file + &of_piece + &pair_name(places.0, places.1)
}
