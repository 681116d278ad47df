//! Records of one good hit, and what they become.

use orthopanel_data::{Hit, RecordFile, RecordedResponse, TimeHistory};
use orthopanel_model::Place;

use super::{
    Dataset,
    hammer::{Noise, Resonator},
};

pub const DAMPED: Resonator = Resonator { radius: 0.9, angle: 0.5 };

pub fn good() -> Hit {
    Noise(3).over(&DAMPED.soft_hit(1000, 100.0), 0.01, 0.01)
}

pub fn measurement() -> RecordedResponse {
    let place = Place { x: 0.0, y: 0.0 };
    RecordedResponse::new("hits.uff", [place; 2])
}

/// A force and an acceleration record of one hit.
pub fn pair() -> [Dataset; 2] {
    let hit = good();
    [Dataset::time(&hit.force, (13, "N")), Dataset::time(&hit.acceleration, (12, "m/s^2"))]
}

pub fn records(datasets: &[Dataset]) -> RecordFile {
    let bytes: Vec<u8> = datasets.iter().flat_map(|dataset| dataset.binary(false)).collect();
    RecordFile::from_bytes(&bytes, "hits.uff").unwrap()
}

pub fn history(datasets: &[Dataset], measurement: &RecordedResponse) -> Result<TimeHistory, String> {
    TimeHistory::from_records(records(datasets), measurement).map_err(|error| error.to_string())
}
