//! What each record of a test holds, in a row for people.

use orthopanel_data::{Accelerance, TimeHistory};
use orthopanel_model::Place;

use crate::measured_pairs::told;

pub struct RecordRow {
    pub force: Place,
    pub response: Place,
    /// Such as `3 hits of 1.6 s at 10240 Hz`.
    pub holds: String,
    pub band: String,
    /// Number of the hits that were kept; `None` where the file does not tell.
    pub kept: Option<usize>,
    /// Each hit with a fault, what it is and what became of it.
    pub faults: Vec<String>,
}

impl RecordRow {
    pub fn of_hits(history: &TimeHistory, accelerance: &Accelerance) -> Self {
        let samples = history.hits.first().map_or(0, |hit| hit.force.len());
        let seconds = samples as f64 / history.rate;
        let count = history.hits.len();
        let faults = told(&accelerance.verdicts).into_iter().filter_map(|hit| hit.said());
        Self {
            force: history.force_at,
            response: history.response_at,
            holds: format!("{} of {seconds:.3} s at {} Hz", counted(count, "hit"), history.rate),
            band: band(accelerance),
            kept: Some(accelerance.hits),
            faults: faults.collect(),
        }
    }

    pub fn of_accelerance(accelerance: &Accelerance) -> Self {
        Self {
            force: accelerance.force_at,
            response: accelerance.response_at,
            holds: format!("accelerance, {}", counted(accelerance.frequency.len(), "line")),
            band: band(accelerance),
            kept: (accelerance.hits > 0).then_some(accelerance.hits),
            faults: Vec::new(),
        }
    }
}

fn band(accelerance: &Accelerance) -> String {
    let (first, last) = (accelerance.frequency.first(), accelerance.frequency.last());
    format!("{:.1} to {:.1} Hz", first.copied().unwrap_or(0.0), last.copied().unwrap_or(0.0))
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
