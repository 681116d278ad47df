//! In what unit the frequencies of a record are, where their label leaves it open.

use orthopanel_model::Readable;

use crate::{DataError, RecordedResponse, limits, records::Record};

/// Lines below which a record is a table of some numbers, of which nothing is asked.
const LEAST_LINES: usize = 100;

/// Sampling rate over the band of an analyser, whose anti-alias filter needs the rest.
const RATE_OVER_BAND: f64 = 2.56;

/// Last lines \[Hz\] that frequency responses of hammer tests have.
const LIKELY: std::ops::RangeInclusive<f64> = 200.0..=4e5;

/// Hertz in one unit of a frequency response's abscissa, as it was read: one, or what the test file declares.
///
/// # Errors
/// [`DataError::Channels`] where the lines end lower, or with what is declared higher, than those of any hammer test.
pub(super) fn to_hertz(record: &Record, measurement: &RecordedResponse) -> Result<f64, DataError> {
    let last = record.abscissa.last().copied().unwrap_or_default();
    let refused = |problem: String| Err(DataError::Channels { at: record.at.clone(), problem });
    match &measurement.frequency_unit {
        Some(unit) if last * unit.to_si() > limits::SAMPLING_RATE[1] / RATE_OVER_BAND => refused(format!(
            "frequency_unit = \"{unit}\" would put the last line at {:e} Hz, and the record says {} Hz: leave it out of its [[measurement]]",
            last * unit.to_si(),
            Readable(last)
        )),
        Some(unit) => Ok(unit.to_si()),
        None => doubt(record).map_or(Ok(1.0), refused),
    }
}

/// The question in what unit the frequencies of a record are, whose lines end lower than those of any hammer test.
pub(crate) fn doubt(record: &Record) -> Option<String> {
    let last = record.abscissa.last().copied()?;
    let least = limits::SAMPLING_RATE[0] / RATE_OVER_BAND;
    let guess = if LIKELY.contains(&(last * 1e3)) { "kHz" } else { "Hz" };
    (record.abscissa.len() >= LEAST_LINES && (0.0..least).contains(&last)).then(|| {
        format!(
            "its lines end at {} Hz, where those of hammer tests go to {least:.0} Hz or more: are they in kHz? write \
             frequency_unit = {guess:?} in its [[measurement]]{}",
            Readable(last),
            if guess == "Hz" { "" } else { ", or \"Hz\" where they are in Hz" }
        )
    })
}
