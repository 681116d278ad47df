//! A table over time: a record a channel.

use std::{path::Path, sync::Arc};

use super::{
    meaning::{Column, Meaning},
    table::{Rows, Table},
};
use crate::{
    DataError, Motion,
    records::{
        Axis, Port, Record, RecordKind, Samples,
        abscissa::{scale, scaled},
        data_type,
    },
};

/// The channels of a table; numbers are given by the file.
pub(super) fn records(table: &Table, path: &Path, notes: &mut Vec<String>) -> Result<Vec<Record>, DataError> {
    let is_channel = |column: &Column| !column.meaning.is_abscissa() && column.meaning != Meaning::NotRead;
    let channels: Vec<usize> = (0..table.columns.len()).filter(|&place| is_channel(&table.columns[place])).collect();
    let abscissa = table.abscissa();
    let wanted: Vec<usize> = abscissa.into_iter().chain(channels.iter().copied()).collect();
    let Rows { values, lines } = table.rows(path, &wanted, false)?;
    let mut values = values.into_iter();
    let times: Arc<[f64]> = match (abscissa, table.even) {
        (Some(place), _) => {
            let column = &table.columns[place];
            let factor = scale(&column.unit, RecordKind::Time, &column.name, notes);
            values.next().unwrap_or_default().into_iter().map(|time| scaled(time, factor)).collect()
        }
        (None, even) => {
            let (start, step) = even.unwrap_or((0.0, 1.0));
            (0..lines.len()).map(|row| start + step * row as f64).collect()
        }
    };
    let record = |(place, values): (usize, Vec<f64>)| {
        let Column { name, unit, meaning } = &table.columns[place];
        Record {
            number: 0,
            kind: RecordKind::Time,
            title: name.clone(),
            at: table.at(path, table.names_at, name),
            lines: Some(Arc::clone(&lines)),
            response: Port::default(),
            reference: Port::default(),
            abscissa: Arc::clone(&times),
            ordinate: Samples::Real(values),
            numerator: Axis::new(type_of(*meaning), unit),
            denominator: Axis::default(),
        }
    };
    Ok(channels.into_iter().zip(values).map(record).collect())
}

/// The specific data type of a universal file that says the same; 0 where nothing is told.
pub(super) fn type_of(meaning: Meaning) -> i64 {
    match meaning {
        Meaning::Force => data_type::FORCE,
        Meaning::Motion(Motion::Acceleration) => data_type::ACCELERATION,
        Meaning::Motion(Motion::Velocity) => data_type::VELOCITY,
        Meaning::Motion(Motion::Displacement) => data_type::DISPLACEMENT,
        _ => 0,
    }
}
