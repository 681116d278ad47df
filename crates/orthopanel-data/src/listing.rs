//! What the records of a file are, for people: quantity, unit, place, length, rate, peak, coherence.

use orthopanel_model::Readable;
use serde::Serialize;

use crate::{
    records::{Port, Quantity, Record, RecordFile, RecordKind, Samples, quantity, type_name},
    spectra::{doubt_of_frequencies, own_coherence},
    units::{Measured, Unit},
};

/// One record of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ListedRecord {
    /// Number among the file's records, from 1; `force_channel`, `response_channel` and `record` of a measurement take it.
    pub record: usize,
    /// What it holds: `force`, `acceleration`, `acceleration / force`, `coherence`, ...; `untold` where the file does not tell.
    pub quantity: String,
    /// Its unit, as the file tells it; empty where it does not.
    pub unit: String,
    /// Node and direction of the response, as `response_channel` takes them; empty where the file does not tell.
    pub response: String,
    /// Those of the reference, as `force_channel` takes them.
    pub reference: String,
    /// Number of points.
    pub points: usize,
    /// First and last time \[s\] or frequency \[Hz\].
    pub span: [f64; 2],
    /// Sampling rate \[Hz\] of a record against time, where it has one.
    pub sampling_rate_hz: Option<f64>,
    /// Distance between the lines \[Hz\] of one against frequency.
    pub line_step_hz: Option<f64>,
    /// Greatest value, of whatever sign, in the record's own unit.
    pub peak: f64,
    /// Mean coherence of a frequency response, where the file has it.
    pub mean_coherence: Option<f64>,
    /// The file's words on it.
    pub title: String,
}

impl RecordFile {
    /// What each record is, in the order of the file.
    pub fn listed(&self) -> Vec<ListedRecord> {
        (0..self.records.len()).filter_map(|index| self.listed_record(index)).collect()
    }

    /// What its records leave open and a test file has to answer, a sentence each.
    pub fn questions(&self) -> Vec<String> {
        let of_response = |record: &&Record| record.kind == RecordKind::FrequencyResponse;
        let asked = |record: &Record| Some(format!("record {}: {}", record.number, doubt_of_frequencies(record)?));
        self.records.iter().filter(of_response).filter_map(asked).collect()
    }

    fn listed_record(&self, index: usize) -> Option<ListedRecord> {
        let record = self.records.get(index)?;
        let span = [record.abscissa.first().copied()?, record.abscissa.last().copied()?];
        let step = (span[1] - span[0]) / (record.abscissa.len().max(2) - 1) as f64;
        let in_time = record.kind == RecordKind::Time;
        let coherence =
            (record.kind == RecordKind::FrequencyResponse).then(|| own_coherence(&self.records, index)).flatten();
        Some(ListedRecord {
            record: record.number,
            quantity: quantity_of(record),
            unit: unit_of(record),
            response: port_text(record.response),
            reference: port_text(record.reference),
            points: record.ordinate.len(),
            span,
            sampling_rate_hz: (in_time && step > 0.0).then(|| nice(1.0 / step)),
            line_step_hz: (!in_time && step > 0.0).then_some(step),
            peak: match &record.ordinate {
                Samples::Real(values) => values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs())),
                Samples::Complex(values) => values.iter().fold(0.0, |peak: f64, value| peak.max(value.norm())),
            },
            mean_coherence: coherence.and_then(|record| match &record.ordinate {
                Samples::Real(values) => Some(values.iter().sum::<f64>() / values.len() as f64),
                Samples::Complex(_) => None,
            }),
            title: record.title.clone(),
        })
    }
}

/// What seven digits of a time leave of a rate.
const LAST_DIGITS: f64 = 1e-6;

/// A rate without the errors of its last digits, which steps of few digits bring.
fn nice(rate: f64) -> f64 {
    let rounded = format!("{rate:.5e}").parse().unwrap_or(rate);
    if (rate / rounded - 1.0).abs() < LAST_DIGITS { rounded } else { rate }
}

/// `"12:+z"`, `"12"`, or nothing.
pub(crate) fn port_text(port: Port) -> String {
    let Port { node, direction } = port;
    let sign = if direction < 0 { '-' } else { '+' };
    match (node, direction.abs()) {
        (0, _) => String::new(),
        (_, along @ 1..=3) => format!("{node}:{sign}{}", ["x", "y", "z"][along as usize - 1]),
        _ => node.to_string(),
    }
}

fn quantity_of(record: &Record) -> String {
    let of = |quantity| match quantity {
        Quantity::Force => "force".to_owned(),
        Quantity::Motion(motion) => motion.name().to_owned(),
        Quantity::Other(kind) => format!("data type {kind}{}", type_name(kind)),
        Quantity::Untold => "untold".to_owned(),
    };
    match record.kind {
        RecordKind::Time => of(quantity(&record.numerator)),
        RecordKind::FrequencyResponse => {
            let under = match (quantity(&record.numerator), quantity(&record.denominator)) {
                // A unit of the whole quotient tells the denominator, too.
                (Quantity::Motion(_), Quantity::Untold) => Quantity::Force,
                (_, under) => under,
            };
            format!("{} / {}", of(quantity(&record.numerator)), of(under))
        }
        RecordKind::AutoSpectrum => format!("auto spectrum of {}", of(quantity(&record.numerator))),
        RecordKind::CrossSpectrum => "cross spectrum".to_owned(),
        RecordKind::Coherence => "coherence".to_owned(),
        RecordKind::Variance => "variance".to_owned(),
        RecordKind::DecayRate => "decay rate".to_owned(),
        RecordKind::Other(kind) => format!("function type {kind}, not read"),
    }
}

/// The unit by label, else by the units of the whole file.
fn unit_of(record: &Record) -> String {
    let of = |axis: &crate::Axis| {
        if !axis.unit.is_empty() {
            return axis.unit.clone();
        }
        let measured = match quantity(axis) {
            Quantity::Force => Measured::Force,
            Quantity::Motion(motion) => Measured::Motion(motion),
            _ => return String::new(),
        };
        axis.unit_by_system(measured).map_or(String::new(), |unit| format!("{} (164)", usual_name(&unit, measured)))
    };
    let (over, under) = (of(&record.numerator), of(&record.denominator));
    match (record.kind, over.is_empty(), under.is_empty()) {
        (RecordKind::FrequencyResponse, false, false) => format!("{over} / {under}"),
        (RecordKind::Time | RecordKind::FrequencyResponse, false, true) => over,
        (RecordKind::Time, ..) => over,
        _ => String::new(),
    }
}

/// The name of a unit that dataset 164 tells by its factor alone.
fn usual_name(unit: &Unit, measured: Measured) -> String {
    let names: Vec<String> = match measured {
        Measured::Motion(motion) => {
            let rate = ["/s2", "/s", ""][usize::from(motion.derivatives())];
            ["m", "mm", "cm", "um", "in", "ft", "mil"].map(|length| format!("{length}{rate}")).to_vec()
        }
        _ => ["N", "mN", "kN", "lbf", "kgf", "gf", "dyn"].map(str::to_owned).to_vec(),
    };
    let is_it = |name: &&String| Unit::parse(name).is_some_and(|known| known.is_same(unit));
    let known = names.iter().find(is_it).cloned();
    known.unwrap_or_else(|| format!("{} {}", Readable(unit.to_si()), si_unit(measured)))
}

fn si_unit(measured: Measured) -> &'static str {
    match measured {
        Measured::Motion(motion) => motion.si_unit(),
        _ => "N",
    }
}

impl ListedRecord {
    /// Length and rate in words: `1.28 s at 12800 Hz`, `0 to 1250 Hz by 0.78125 Hz`.
    pub fn extent(&self) -> String {
        let [from, to] = self.span;
        match (self.sampling_rate_hz, self.line_step_hz) {
            (Some(rate), _) => format!("{:.4} s at {} Hz", self.points as f64 / rate, Readable(rate)),
            (None, Some(step)) => {
                format!("{} to {} Hz by {} Hz", Readable(from), Readable(to), Readable((step * 1e6).round() / 1e6))
            }
            (None, None) => String::new(),
        }
    }
}
