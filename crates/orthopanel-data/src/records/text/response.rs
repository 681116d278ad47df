//! A table over frequency: a frequency response by its parts, or by magnitude and phase, and what stands beside it.

use std::{f64::consts::TAU, path::Path, sync::Arc};

use num_complex::Complex64;
use orthopanel_model::Readable;

use super::{
    meaning::Meaning,
    table::{Rows, Table},
};
use crate::{
    DataError,
    records::{
        Axis, Port, Record, RecordKind, Samples,
        abscissa::{scale, scaled},
        data_type,
    },
};

/// The frequency response of a table with coherence, variance and decay rate where they are there; numbers are given by the file.
pub(super) fn records(table: &Table, path: &Path, notes: &mut Vec<String>) -> Result<Vec<Record>, DataError> {
    let only = |meaning| table.only(meaning, path);
    let [real, imaginary] = [only(Meaning::Real)?, only(Meaning::Imaginary)?];
    let [magnitude, phase] = [only(Meaning::Magnitude)?, only(Meaning::Phase)?];
    let beside = [
        (only(Meaning::Coherence)?, RecordKind::Coherence),
        (only(Meaning::Variance)?, RecordKind::Variance),
        (only(Meaning::DecayRate)?, RecordKind::DecayRate),
    ];
    let parts = match (real, imaginary, magnitude) {
        (Some(real), Some(imaginary), _) => [Some(real), Some(imaginary)],
        (_, _, Some(magnitude)) => [Some(magnitude), phase],
        (Some(_), None, None) => return Err(missing(table, path, "imag")),
        _ => return Err(missing(table, path, "real")),
    };
    let beside: Vec<(usize, RecordKind)> =
        beside.into_iter().filter_map(|(place, kind)| Some((place?, kind))).collect();
    let abscissa = table.abscissa().unwrap_or(0);
    let places = [Some(abscissa), parts[0], parts[1]].into_iter().flatten();
    let wanted: Vec<usize> = places.chain(beside.iter().map(|(place, _)| *place)).collect();
    let Rows { values, lines } = table.rows(path, &wanted, true)?;
    let mut values = values.into_iter();
    let column = &table.columns[abscissa];
    let factor = scale(&column.unit, RecordKind::FrequencyResponse, &column.name, notes);
    let frequency: Arc<[f64]> =
        values.next().unwrap_or_default().into_iter().map(|value| scaled(value, factor)).collect();
    let first = values.next().unwrap_or_default();
    let second = parts[1].and_then(|_| values.next());
    let of = parts[0].map(|place| &table.columns[place]);
    let label = of.map(|column| column.unit.as_str()).unwrap_or_default();
    let (ordinate, label) = if parts == [real, imaginary] {
        let second = second.unwrap_or_default();
        let pairs = first.into_iter().zip(second).map(|(re, im)| Complex64::new(re, im));
        (Samples::Complex(pairs.collect()), label.to_owned())
    } else {
        let (magnitude, label) = from_level(first, label, notes);
        match (second, parts[1].map(|place| &table.columns[place])) {
            (Some(phase), Some(column)) => {
                let radians = in_radians(&phase, &column.unit, notes);
                let turned =
                    magnitude.iter().zip(&phase).map(|(&size, &angle)| Complex64::from_polar(size, radians * angle));
                (Samples::Complex(turned.collect()), label)
            }
            _ => (Samples::Real(magnitude), label),
        }
    };
    // By this project's own names it is an accelerance; others tell it by their unit, or are asked.
    let is_own = table.columns[abscissa].name == "frequency_hz" && of.is_some_and(|column| column.name == "real");
    let (motion, force) = if is_own {
        (Axis::new(data_type::ACCELERATION, ""), Axis::new(data_type::FORCE, "N"))
    } else {
        (Axis::new(0, &label), Axis::default())
    };
    let record = |kind, title: &str, ordinate, numerator, denominator| Record {
        number: 0,
        kind,
        title: title.into(),
        at: table.at(path, table.names_at, title),
        lines: Some(Arc::clone(&lines)),
        response: Port::default(),
        reference: Port::default(),
        abscissa: Arc::clone(&frequency),
        ordinate,
        numerator,
        denominator,
    };
    let title = if is_own { "accelerance" } else { of.map(|column| column.name.as_str()).unwrap_or_default() };
    let mut records = vec![record(RecordKind::FrequencyResponse, title, ordinate, motion, force)];
    for ((place, kind), values) in beside.into_iter().zip(values) {
        let name = &table.columns[place].name;
        records.push(record(kind, name, Samples::Real(values), Axis::default(), Axis::default()));
    }
    Ok(records)
}

fn missing(table: &Table, path: &Path, what: &str) -> DataError {
    let problem = format!(
        "column {what} is missing among {}: a frequency response has the columns frequency_hz,real,imag, or magnitude and phase; other \
         names are told by columns = {{frequency = .., real = .., imag = ..}} in its [[measurement]]",
        table.names()
    );
    table.refused(path, problem)
}

/// Magnitudes out of decibels, and their unit: 20 dB are a factor of ten.
fn from_level(mut values: Vec<f64>, label: &str, notes: &mut Vec<String>) -> (Vec<f64>, String) {
    let Some(reference) = label.get(..2).filter(|start| start.eq_ignore_ascii_case("db")).and_then(|_| label.get(2..))
    else {
        return (values, label.to_owned());
    };
    values.iter_mut().for_each(|value| *value = 10f64.powf(*value / 20.0));
    let reference = reference.trim().trim_start_matches("re").trim();
    let unit = reference.strip_prefix("1 ").unwrap_or(reference).trim();
    let told = if unit.is_empty() { "of the unit".to_owned() } else { unit.to_owned() };
    notes.push(format!("magnitudes brought from dB, over one {told}"));
    (values, unit.to_owned())
}

/// Radians in one unit of a phase: by its label, else by how far its values go.
fn in_radians(phase: &[f64], label: &str, notes: &mut Vec<String>) -> f64 {
    let degree = TAU / 360.0;
    let lower = label.to_lowercase();
    if lower.starts_with("rad") {
        return 1.0;
    }
    if lower.starts_with("deg") || lower == "°" || lower == "?" {
        return degree;
    }
    let most = phase.iter().fold(0.0f64, |most, angle| most.max(angle.abs()));
    // Radians of a wrapped phase end at a whole turn.
    let (factor, name) = if most > 1.001 * TAU { (degree, "degrees") } else { (1.0, "radians") };
    notes.push(format!("unit of the phase not told, taken as {name}: it goes to {}", Readable(most)));
    factor
}
