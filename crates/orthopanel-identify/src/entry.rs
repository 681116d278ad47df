//! The entry: what the test holds decides which of the paper's two problems is solved.

use orthopanel_data::{ImpactTest, MeasurementData};

use crate::{Identification, IdentifyError, Settings, accelerance_fit, frequency_fit, tracing};

/// Finds the constants of a test, and its damping where there are records: eq. 22 for natural frequencies, the whole
/// complex accelerance for records. Starting values are found here. Effects that the test file declares are part of the
/// model; what it leaves out of their parameters is identified too.
///
/// `settings` may be a [`crate::Search`] alone.
///
/// # Errors
/// [`IdentifyError`]: too few data, an unknown constant, no convergence, a constant on its bound or known no better than
/// its own size, records that contradict the test file, records that cannot be
/// read, or a test that this version cannot evaluate.
pub fn identify(test: &ImpactTest, settings: impl Into<Settings>) -> Result<Identification, IdentifyError> {
    let settings = settings.into();
    settings.paper_weights.check()?;
    if !test.effects.is_empty() {
        return tracing::identify_with_effects(test, settings)?.determined();
    }
    let is_frequencies = |data: &MeasurementData| matches!(data, MeasurementData::NaturalFrequencies(_));
    let lists = test.measurements.iter().filter(|measurement| is_frequencies(&measurement.data)).count();
    if lists == test.measurements.len() {
        frequency_fit::identify_frequencies(test, settings.search)?.determined()
    } else if lists == 0 {
        accelerance_fit::identify_records(test, settings)?.determined()
    } else {
        let message = "natural frequencies and records in one test: put them in two test files, since the frequencies \
                       are most likely read off the same records and would count twice";
        Err(IdentifyError::Unsupported(message.to_owned()))
    }
}
