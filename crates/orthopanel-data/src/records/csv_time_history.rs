//! CSV of one hit: columns `time_s,force_n,acceleration_m_s2`, or `acceleration_g` in its place.

use std::{path::Path, sync::Arc};

use super::{Axis, Format, Port, Record, RecordFile, RecordKind, Samples, csv_columns, data_type};
use crate::{DataError, Location};

pub(super) const FORMAT: Format = Format {
    name: "CSV with the columns time_s,force_n,acceleration_m_s2 (or acceleration_g)",
    recognises: |bytes| csv_columns::starts_with_column(bytes, "time_s"),
    read,
};

fn read(bytes: &[u8], path: &Path) -> Result<RecordFile, DataError> {
    // The column's name is its unit; m/s2 is what is asked for where neither is there.
    let (title, unit) = match csv_columns::has_column(bytes, "acceleration_g") {
        true => ("acceleration_g", "g"),
        false => ("acceleration_m_s2", "m/s2"),
    };
    let csv_columns::Columns { values, names_at, lines } =
        csv_columns::read(bytes, path, &["time_s", "force_n", title], &[])?;
    let mut columns = values.into_iter().map(Option::unwrap_or_default);
    let time: Arc<[f64]> = columns.next().unwrap_or_default().into();
    let force = columns.next().unwrap_or_default();
    let acceleration = columns.next().unwrap_or_default();
    let record = |number, title: &str, abscissa: Arc<[f64]>, ordinate: Vec<f64>, data_type: i64, unit: &str| Record {
        number,
        kind: RecordKind::Time,
        title: title.into(),
        at: Box::new(Location { position: names_at, key: title.into(), ..*Location::whole(path) }),
        lines: Some(Arc::clone(&lines)),
        response: Port::default(),
        reference: Port::default(),
        abscissa,
        ordinate: Samples::Real(ordinate),
        numerator: Axis::new(data_type, unit),
        denominator: Axis::default(),
    };
    let records = vec![
        record(1, "force_n", time.clone(), force, data_type::FORCE, "N"),
        record(2, title, time, acceleration, data_type::ACCELERATION, unit),
    ];
    Ok(RecordFile { records, notes: Vec::new(), nodes: Vec::new() })
}
