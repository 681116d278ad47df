//! `[[measurement]]`: natural frequencies as read off an analyser, or files of records.

mod files;
mod frequencies;
mod natural_frequencies;
mod places;
mod record_arrays;
mod record_files;
mod recorded;
mod recorded_response;

use std::{collections::BTreeSet, ops::Range, path::Path};

use orthopanel_model::{Piece, Place};
use toml::Spanned;

use super::{pieces::NamedPiece, source::Source, syntax};
use crate::{DataError, Location, limits};
pub use natural_frequencies::NaturalFrequencies;
pub use recorded_response::{ChannelName, Direction, RecordedResponse, Trigger};

/// One measurement on one piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// Index into [`super::ImpactTest::pieces`], from 0.
    pub piece: usize,
    /// What was measured.
    pub data: MeasurementData,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasurementData {
    /// `kind = "natural-frequencies"`.
    NaturalFrequencies(NaturalFrequencies),
    /// `kind = "time-history"`: force and acceleration against time.
    TimeHistory(RecordedResponse),
    /// `kind = "accelerance"`: acceleration / force against frequency.
    Accelerance(RecordedResponse),
}

impl MeasurementData {
    /// Where and how its records were taken; `None` of a list of frequencies.
    pub fn recorded(&self) -> Option<&RecordedResponse> {
        match self {
            Self::NaturalFrequencies(_) => None,
            Self::TimeHistory(recorded) | Self::Accelerance(recorded) => Some(recorded),
        }
    }
}

const KINDS: &str = "\"natural-frequencies\", \"time-history\" or \"accelerance\"";

pub(super) fn measurements(
    source: &Source,
    (given, band): (Vec<Spanned<syntax::Measurement>>, Option<Spanned<[f64; 2]>>),
    pieces: &[NamedPiece],
) -> Result<Vec<Measurement>, DataError> {
    let at = || source.at(given.first().map_or(0..0, Spanned::span), "measurement");
    source.at_most((given.len(), "measurements"), limits::MEASUREMENTS, at, "put some into a test of their own")?;
    let band = band.map(|band| source.band(&band, "band")).transpose()?;
    let read = |(index, entry)| one(source, index, entry, (pieces, band));
    let read: Vec<Vec<Measurement>> = given.into_iter().enumerate().map(read).collect::<Result<_, _>>()?;
    let read: Vec<Measurement> = read.into_iter().flatten().collect();
    count(source, &read)?;
    files_at_most(source, &read)?;
    Ok(read)
}

/// What `measurement[index + 1]` holds.
pub(super) fn one(
    source: &Source,
    index: usize,
    entry: Spanned<syntax::Measurement>,
    (pieces, band): (&[NamedPiece], Option<[f64; 2]>),
) -> Result<Vec<Measurement>, DataError> {
    let key = format!("measurement[{}]", index + 1);
    Entry { source, key, span: entry.span() }.read(entry.into_inner(), pieces, band)
}

/// Refuses more measurements, or frequencies in all of them, than are taken.
pub(super) fn count(source: &Source, read: &[Measurement]) -> Result<(), DataError> {
    let whole = || source.whole("measurement");
    source.at_most(
        (read.len(), "files of measurements"),
        limits::MEASUREMENTS,
        whole,
        "put some into a test of their own",
    )?;
    let listed = |of: &Measurement| match &of.data {
        MeasurementData::NaturalFrequencies(list) => list.values.len(),
        _ => 0,
    };
    let (count, most) = (read.iter().map(listed).sum(), limits::FREQUENCIES_OF_TEST);
    let at = || source.whole("measurement");
    source.at_most((count, "natural frequencies in all"), most, at, "put some pieces into a test of their own")
}

/// Refuses files of records that are too large together.
fn files_at_most(source: &Source, measurements: &[Measurement]) -> Result<(), DataError> {
    // A file of several measurements is read once.
    let files: BTreeSet<&Path> =
        measurements.iter().filter_map(|of| of.data.recorded()).flat_map(RecordedResponse::files).collect();
    // A file that has gone since is missed where it is read.
    let sizes: Vec<u64> =
        files.into_iter().map(|file| std::fs::metadata(file).map_or(0, |found| found.len())).collect();
    let (found, most) = (sizes.iter().fold(0, |sum: u64, size| sum.saturating_add(*size)), limits::RECORD_FILES);
    if found <= most {
        return Ok(());
    }
    Err(DataError::TooLarge { at: source.whole("measurement"), files: sizes.len(), found, most })
}

/// One `[[measurement]]` being read.
struct Entry<'a> {
    source: &'a Source<'a>,
    key: String,
    span: Range<usize>,
}

impl Entry<'_> {
    fn read(
        &self,
        entry: syntax::Measurement,
        pieces: &[NamedPiece],
        band: Option<[f64; 2]>,
    ) -> Result<Vec<Measurement>, DataError> {
        let kind = self.needed(entry.kind.as_ref(), "kind", "one of natural-frequencies, time-history, accelerance")?;
        let (piece, named) = self.piece(entry.piece.as_ref(), pieces)?;
        if let Some(trigger) = entry.trigger.as_ref().filter(|_| kind.get_ref() != "time-history") {
            for (value, key) in [(&trigger.level, "level"), (&trigger.before, "before"), (&trigger.length, "length")] {
                self.unwanted(kind, value.as_ref(), &format!("trigger.{key}"))?;
            }
        }
        let data = match kind.get_ref().as_str() {
            "natural-frequencies" => {
                self.unwanted(kind, entry.file.as_ref(), "file")?;
                self.unwanted(kind, entry.force_at.as_ref(), "force_at")?;
                self.unwanted(kind, entry.unit.as_ref(), "unit")?;
                self.unwanted(kind, entry.direction.as_ref(), "direction")?;
                self.unwanted(kind, entry.record.as_ref(), "record")?;
                self.unwanted(kind, entry.response_unit.as_ref(), "response_unit")?;
                self.unwanted(kind, entry.force_unit.as_ref(), "force_unit")?;
                self.unwanted(kind, entry.quantity.as_ref(), "quantity")?;
                self.unwanted(kind, entry.response_sensitivity.as_ref(), "response_sensitivity")?;
                self.unwanted(kind, entry.force_sensitivity.as_ref(), "force_sensitivity")?;
                self.unwanted(kind, entry.force_channel.as_ref(), "force_channel")?;
                self.unwanted(kind, entry.response_channel.as_ref(), "response_channel")?;
                self.unwanted(kind, entry.sampling_rate.as_ref(), "sampling_rate")?;
                self.unwanted(kind, entry.frequency_unit.as_ref(), "frequency_unit")?;
                self.unwanted(kind, entry.window_decay.as_ref(), "window_decay")?;
                self.unwanted(kind, entry.columns.as_ref(), "columns")?;
                self.unwanted(kind, entry.places.as_ref(), "places")?;
                self.unwanted(kind, entry.origin.as_ref(), "origin")?;
                self.unwanted(kind, entry.band.as_ref(), "band")?;
                vec![MeasurementData::NaturalFrequencies(self.natural_frequencies(&entry, named)?)]
            }
            "time-history" | "accelerance" => {
                self.unwanted(kind, entry.values.as_ref(), "values")?;
                self.unwanted(kind, entry.resolution.as_ref(), "resolution")?;
                self.unwanted(kind, entry.scatter.as_ref(), "scatter")?;
                self.unwanted(kind, entry.shape.as_ref(), "shape")?;
                if kind.get_ref() == "time-history" {
                    self.unwanted(kind, entry.record.as_ref(), "record")?;
                    self.unwanted(kind, entry.frequency_unit.as_ref(), "frequency_unit")?;
                } else {
                    self.unwanted(kind, entry.sampling_rate.as_ref(), "sampling_rate")?;
                }
                let of_kind = if kind.get_ref() == "accelerance" {
                    MeasurementData::Accelerance
                } else {
                    MeasurementData::TimeHistory
                };
                self.recorded(&entry, &named.piece, band)?.into_iter().map(of_kind).collect()
            }
            other => {
                let (name, remedy) = (other.to_owned(), format!("must be {KINDS}"));
                return Err(DataError::UnknownName { at: self.at(kind.span(), "kind"), name, remedy });
            }
        };
        Ok(data.into_iter().map(|data| Measurement { piece, data }).collect())
    }

    fn piece<'p>(
        &self,
        name: Option<&Spanned<String>>,
        pieces: &'p [NamedPiece],
    ) -> Result<(usize, &'p NamedPiece), DataError> {
        match (name, pieces) {
            (None, [only]) => Ok((0, only)),
            (None, _) => Err(DataError::Missing {
                at: self.at(self.span.clone(), "piece"),
                remedy: "there are several pieces: name the one that was measured",
            }),
            (Some(name), _) => {
                let mut numbered = pieces.iter().enumerate();
                numbered.find(|(_, piece)| piece.name == *name.get_ref()).ok_or_else(|| {
                    let names: Vec<_> = pieces.iter().map(|piece| format!("{:?}", piece.name)).collect();
                    let remedy = format!("the pieces are named {}", names.join(", "));
                    DataError::UnknownName { at: self.at(name.span(), "piece"), name: name.get_ref().clone(), remedy }
                })
            }
        }
    }

    fn band(&self, band: Option<&Spanned<[f64; 2]>>, key: &str) -> Result<Option<[f64; 2]>, DataError> {
        band.map(|band| self.source.band(band, &self.name(key))).transpose()
    }

    fn place(&self, place: &Spanned<[f64; 2]>, key: &str, piece: &Piece) -> Result<Place, DataError> {
        let at = Place::from(*place.get_ref());
        piece.contains(at).map_err(|source| DataError::Model { at: self.at(place.span(), key), source })?;
        Ok(at)
    }

    fn needed<'v, T>(
        &self,
        value: Option<&'v Spanned<T>>,
        key: &str,
        remedy: &'static str,
    ) -> Result<&'v Spanned<T>, DataError> {
        value.ok_or_else(|| DataError::Missing { at: self.at(self.span.clone(), key), remedy })
    }

    fn unwanted<T>(&self, kind: &Spanned<String>, value: Option<&Spanned<T>>, key: &str) -> Result<(), DataError> {
        let Some(value) = value else { return Ok(()) };
        let problem = format!("does not belong to kind = {:?}: take it out, or change the kind", kind.get_ref());
        Err(DataError::Contradiction { at: self.at(value.span(), key), problem })
    }

    fn name(&self, key: &str) -> String {
        format!("{}.{key}", self.key)
    }

    fn at(&self, span: Range<usize>, key: &str) -> Box<Location> {
        self.source.at(span, self.name(key))
    }
}
