//! What stands beside a frequency response in its file, checked: coherence, variance, and the decay rate of a window.

use orthopanel_model::Readable;

use crate::{
    DataError,
    records::{Record, Samples},
};

/// The decay rate of the exponential window under which a frequency response was averaged, as the file and the test file tell it.
pub(super) fn decay_rate(recorded: Option<&Record>, declared: Option<f64>) -> Result<f64, DataError> {
    match (recorded, declared) {
        (None, None) => Ok(0.0),
        (None, Some(tau)) => Ok(1.0 / tau),
        (Some(record), None) => one_decay_rate(record),
        (Some(record), Some(tau)) => {
            let found = one_decay_rate(record)?;
            if (found * tau - 1.0).abs() < 1e-3 {
                return Ok(found);
            }
            let problem = format!(
                "decay rate {} 1/s, and window_decay = {tau} s declares {} 1/s: drop window_decay, the column tells it",
                Readable(found),
                Readable(1.0 / tau)
            );
            Err(DataError::Channels { at: record.at.clone(), problem })
        }
    }
}

/// The decay rate of all lines, checked.
fn one_decay_rate(of: &Record) -> Result<f64, DataError> {
    let Samples::Real(values) = &of.ordinate else {
        return Err(DataError::Channels { at: of.at.clone(), problem: "a decay rate must be real".into() });
    };
    let first = values.first().copied().unwrap_or_default();
    match values.iter().position(|value| *value != first || *value < 0.0) {
        None => Ok(first),
        Some(line) => {
            let value = values[line];
            let problem = format!(
                "decay rate {} at point {}: must be zero or more, the same in every row",
                Readable(value),
                line + 1
            );
            Err(DataError::Channels { at: of.at_point(line), problem })
        }
    }
}

/// The variance of each line, checked.
pub(super) fn matching_variance(response: &Record, variance: &Record) -> Result<Vec<f64>, DataError> {
    let refused = |problem: String| Err(DataError::Channels { at: variance.at.clone(), problem });
    let Samples::Real(values) = &variance.ordinate else { return refused("a variance must be real".into()) };
    if variance.abscissa != response.abscissa {
        return refused("the variance stands at other frequencies than the frequency response".into());
    }
    match values.iter().enumerate().find(|(_, value)| **value < 0.0) {
        None => Ok(values.clone()),
        Some((line, value)) => {
            let problem = format!("variance {} at point {}: must be zero or more", Readable(*value), line + 1);
            Err(DataError::Channels { at: variance.at_point(line), problem })
        }
    }
}

pub(super) fn matching_coherence(response: &Record, coherence: &Record) -> Result<Vec<f64>, DataError> {
    let refused = |problem: String| Err(DataError::Channels { at: coherence.at.clone(), problem });
    if coherence.abscissa != response.abscissa {
        return refused("the coherence stands at other frequencies than the frequency response".into());
    }
    let Samples::Real(values) = &coherence.ordinate else { return refused("a coherence must be real".into()) };
    // A last digit above 1 is rounding; more is another quantity.
    match values.iter().enumerate().find(|(_, value)| !(-1e-6..=1.0 + 1e-6).contains(*value)) {
        None => Ok(values.iter().map(|value| value.clamp(0.0, 1.0)).collect()),
        Some((line, value)) => {
            let problem = format!("coherence {} at point {}: must lie between 0 and 1", Readable(*value), line + 1);
            Err(DataError::Channels { at: coherence.at_point(line), problem })
        }
    }
}
