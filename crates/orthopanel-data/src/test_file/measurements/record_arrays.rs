//! Records that stand in memory, with the places where they were taken.

use std::sync::Arc;

use num_complex::Complex64;
use orthopanel_model::Place;

use super::RecordedResponse;
use crate::{
    DataError,
    records::{RecordFile, arrays_name},
};

impl RecordedResponse {
    /// Hits in memory: `force` and `response`, each hits x samples, at a sampling rate \[Hz\], with the places of force and response.
    ///
    /// As of files, the force is in N and the response an acceleration in m/s² unless [`RecordedResponse::force_unit`],
    /// [`RecordedResponse::response_unit`], [`RecordedResponse::quantity`] or the sensitivities say otherwise. Messages call the arrays
    /// `records added at force_at = ..`, and each by its hit.
    ///
    /// # Errors
    /// [`DataError::Shape`] where force and response have not as many hits, or hits not as many samples;
    /// [`DataError::NoRecords`] where there is none; [`DataError::NotFinite`] for a sample that is no number below 1e30;
    /// [`DataError::OutOfRange`] for a sampling rate outside [`SAMPLING_RATE`](crate::limits::SAMPLING_RATE).
    pub fn of_hits(
        [force, response]: [Vec<Vec<f64>>; 2],
        sampling_rate: f64,
        places: [Place; 2],
    ) -> Result<Self, DataError> {
        let records = RecordFile::of_hits(&arrays_name(places), [force, response], sampling_rate)?;
        Ok(Self { sampling_rate: Some(sampling_rate), ..Self::in_memory(records, places) })
    }

    /// A frequency response in memory: rising frequencies \[Hz\], the complex lines ($e^{+j\omega t}$) of motion over force, and their
    /// coherence where known, with the places of force and response.
    ///
    /// The lines are of acceleration in m/s² over force in N unless [`RecordedResponse::quantity`],
    /// [`RecordedResponse::response_unit`] or [`RecordedResponse::force_unit`] say otherwise.
    ///
    /// # Errors
    /// [`DataError::Shape`] where the arrays are not equally long; [`DataError::NoRecords`] where they are empty;
    /// [`DataError::NotFinite`] for what is no number below 1e30; [`DataError::Channels`] for frequencies that do not rise.
    pub fn of_lines(
        frequency: Vec<f64>,
        value: Vec<Complex64>,
        coherence: Option<Vec<f64>>,
        places: [Place; 2],
    ) -> Result<Self, DataError> {
        let records = RecordFile::of_lines(&arrays_name(places), (frequency, value), coherence)?;
        Ok(Self::in_memory(records, places))
    }

    fn in_memory(records: RecordFile, places: [Place; 2]) -> Self {
        Self { in_memory: Some(Arc::new(records)), ..Self::new(arrays_name(places), places) }
    }
}
