//! A number with its standard deviation.

use serde::Serialize;

/// A number, with its standard deviation where it was identified; in files `1.07e10` or `{"value", "std"}`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "EstimateText")]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard deviation, where known.
    pub std: Option<f64>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum EstimateText {
    Bare(f64),
    Full { value: f64, std: f64 },
}

impl From<Estimate> for EstimateText {
    fn from(estimate: Estimate) -> Self {
        match estimate.std {
            None => Self::Bare(estimate.value),
            Some(std) => Self::Full { value: estimate.value, std },
        }
    }
}
