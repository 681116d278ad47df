//! Records of arrays that stand in memory, as a reader of files makes them.

use std::sync::Arc;

use num_complex::Complex64;
use orthopanel_model::Place;

use super::{Axis, Port, Record, RecordFile, RecordKind, Samples, data_type, reading::may_be_read};
use crate::{DataError, Location, Position, limits};

/// What messages call arrays, where they name the file of a record else.
pub(crate) fn name([force_at, response_at]: [Place; 2]) -> String {
    let place = |at: Place| format!("[{}, {}]", at.x, at.y);
    format!("records added at force_at = {}, response_at = {}", place(force_at), place(response_at))
}

/// An array in messages: what it is called, of the arrays with a name.
fn at(name: &str, key: &str) -> Box<Location> {
    Box::new(Location { file: name.into(), position: Position::Whole, key: key.into() })
}

fn shape(name: &str, key: &str, found: (usize, &'static str), needed: usize) -> DataError {
    DataError::Shape { at: at(name, key), found: found.0, what: found.1, needed }
}

/// The first point that no sensor reads.
fn readable(name: &str, key: &str, mut values: impl Iterator<Item = f64>) -> Result<(), DataError> {
    match values.position(|value| !may_be_read(value)) {
        None => Ok(()),
        Some(point) => Err(DataError::NotFinite { at: at(name, key), point: point + 1 }),
    }
}

impl RecordFile {
    /// Force and response of each hit in turn, at times from zero; each array is hits x samples.
    pub(crate) fn of_hits(name: &str, [force, response]: [Vec<Vec<f64>>; 2], rate: f64) -> Result<Self, DataError> {
        let [least, most] = limits::SAMPLING_RATE;
        if !(least..=most).contains(&rate) {
            let range = format!("must be a number of Hz between {least} and {most:e}");
            return Err(DataError::OutOfRange { at: at(name, "sampling_rate"), value: rate, range });
        }
        if force.len() != response.len() {
            return Err(shape(name, "response", (response.len(), "hits"), force.len()));
        }
        let Some(samples) = force.first().map(Vec::len).filter(|samples| *samples > 0) else {
            return Err(DataError::NoRecords { at: at(name, "force"), what: "hit" });
        };
        let times: Arc<[f64]> = (0..samples).map(|sample| sample as f64 / rate).collect();
        let mut records = Vec::with_capacity(2 * force.len());
        for (hit, channels) in (1..).zip(force.into_iter().zip(response)) {
            let (force, response) = channels;
            for (values, channel, data_type) in [(force, "force", data_type::FORCE), (response, "response", 0)] {
                let key = format!("hit {hit}, {channel}");
                if values.len() != samples {
                    return Err(shape(name, &key, (values.len(), "samples"), samples));
                }
                readable(name, &key, values.iter().copied())?;
                let measured = (RecordKind::Time, Arc::clone(&times), Samples::Real(values));
                records.push(Record::of_array(at(name, &key), measured, data_type));
            }
        }
        Ok(Self::of_arrays(records))
    }

    /// A frequency response, with its coherence where there is one; all arrays hold a number a line.
    pub(crate) fn of_lines(
        name: &str,
        (frequency, value): (Vec<f64>, Vec<Complex64>),
        coherence: Option<Vec<f64>>,
    ) -> Result<Self, DataError> {
        let lines = frequency.len();
        if lines == 0 {
            return Err(DataError::NoRecords { at: at(name, "frequency"), what: "line" });
        }
        readable(name, "frequency", frequency.iter().copied())?;
        if let Some(line) = frequency.windows(2).position(|pair| pair[1] <= pair[0]) {
            let problem = format!(
                "line {} is at {} Hz, and the line before it at {} Hz: frequencies must rise",
                line + 2,
                frequency[line + 1],
                frequency[line]
            );
            return Err(DataError::Channels { at: at(name, "frequency"), problem });
        }
        let of_length = |key: &str, found: usize| {
            if found == lines { Ok(()) } else { Err(shape(name, key, (found, "lines"), lines)) }
        };
        of_length("value", value.len())?;
        readable(name, "value", value.iter().map(|value| value.re + value.im))?;
        let frequency: Arc<[f64]> = frequency.into();
        let measured = (RecordKind::FrequencyResponse, Arc::clone(&frequency), Samples::Complex(value));
        let mut records = vec![Record::of_array(at(name, "value"), measured, 0)];
        if let Some(coherence) = coherence {
            of_length("coherence", coherence.len())?;
            readable(name, "coherence", coherence.iter().copied())?;
            let measured = (RecordKind::Coherence, frequency, Samples::Real(coherence));
            records.push(Record::of_array(at(name, "coherence"), measured, 0));
        }
        Ok(Self::of_arrays(records))
    }

    fn of_arrays(mut records: Vec<Record>) -> Self {
        records.iter_mut().zip(1..).for_each(|(record, number)| record.number = number);
        Self { records, notes: Vec::new(), nodes: Vec::new() }
    }
}

impl Record {
    fn of_array(
        at: Box<Location>,
        (kind, abscissa, ordinate): (RecordKind, Arc<[f64]>, Samples),
        data_type: i64,
    ) -> Self {
        Self {
            number: 0,
            kind,
            title: at.key.clone(),
            at,
            lines: None,
            response: Port::default(),
            reference: Port::default(),
            abscissa,
            ordinate,
            numerator: Axis::new(data_type, ""),
            denominator: Axis::default(),
        }
    }
}
