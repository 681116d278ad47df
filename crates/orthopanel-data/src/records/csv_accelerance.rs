//! CSV of an accelerance: columns `frequency_hz,real,imag` and, where known, `coherence` and `variance`; under an
//! exponential window `decay_rate_1_s` too, the same number in every row.

use std::{path::Path, sync::Arc};

use num_complex::Complex64;

use super::{Axis, Format, Port, Record, RecordFile, RecordKind, Samples, csv_columns, data_type};
use crate::{DataError, Location};

pub(super) const FORMAT: Format = Format {
    name: "CSV with the columns frequency_hz,real,imag[,coherence][,variance][,decay_rate_1_s]",
    recognises: |bytes| csv_columns::starts_with_column(bytes, "frequency_hz"),
    read,
};

fn read(bytes: &[u8], path: &Path) -> Result<RecordFile, DataError> {
    let csv_columns::Columns { values, names_at, lines } = csv_columns::read(
        bytes,
        path,
        &["frequency_hz", "real", "imag"],
        &["coherence", "variance", "decay_rate_1_s"],
    )?;
    let mut columns = values.into_iter();
    let mut next = || columns.next().flatten();
    let (frequency, re, im) = (next().unwrap_or_default(), next().unwrap_or_default(), next().unwrap_or_default());
    let frequency: Arc<[f64]> = frequency.into();
    let value = re.iter().zip(&im).map(|(&re, &im)| Complex64::new(re, im)).collect();
    let record = |number, kind, title: &str, abscissa, ordinate, numerator, denominator| Record {
        number,
        kind,
        title: title.into(),
        at: Box::new(Location { position: names_at, key: title.into(), ..*Location::whole(path) }),
        lines: Some(Arc::clone(&lines)),
        response: Port::default(),
        reference: Port::default(),
        abscissa,
        ordinate,
        numerator,
        denominator,
    };
    let mut records = Vec::new();
    let (motion, force) = (Axis::new(data_type::ACCELERATION, ""), Axis::new(data_type::FORCE, "N"));
    let frf = RecordKind::FrequencyResponse;
    records.push(record(1, frf, "accelerance", frequency.clone(), Samples::Complex(value), motion, force));
    let beside = [
        (RecordKind::Coherence, "coherence"),
        (RecordKind::Variance, "variance"),
        (RecordKind::DecayRate, "decay_rate_1_s"),
    ];
    for (kind, title) in beside {
        if let Some(values) = next() {
            let (abscissa, values) = (Arc::clone(&frequency), Samples::Real(values));
            records.push(record(records.len() + 1, kind, title, abscissa, values, Axis::default(), Axis::default()));
        }
    }
    Ok(RecordFile { records, notes: Vec::new(), nodes: Vec::new() })
}
