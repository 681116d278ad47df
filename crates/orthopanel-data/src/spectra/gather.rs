//! All accelerances of a test, hits of the same places put together.

use std::{
    collections::{HashMap, hash_map::Entry},
    hash::{DefaultHasher, Hash as _, Hasher as _},
    path::PathBuf,
    sync::Arc,
};

use orthopanel_model::Place;
use rayon::prelude::*;

use super::channel_choice;
use super::node_numbers::{self, NumberedPlace};
use super::time_history::check_hits;
use super::{Accelerance, Estimation, Hit, TimeHistory};
use crate::{DataError, ImpactTest, Location, Measurement, MeasurementData, RecordFile, RecordedResponse};

impl TimeHistory {
    /// Force and response.
    fn places(&self) -> (Place, Place) {
        (self.force_at, self.response_at)
    }

    /// Adds the hits of `other`, as where each hit has a file of its own.
    ///
    /// # Errors
    /// [`DataError::Channels`], naming `other`'s file, where places, rate or length differ.
    pub fn join(&mut self, other: Self) -> Result<(), DataError> {
        let length = |history: &Self| history.hits.first().map_or(0, |hit| hit.force.len());
        let (mine, theirs) = ((length(self), self.rate), (length(&other), other.rate));
        let problem = if self.places() != other.places() {
            "the places differ from those of the hits before".to_owned()
        } else if mine.0 != theirs.0 || (mine.1 - theirs.1).abs() > 1e-6 * mine.1 {
            let file = self.file.display();
            format!(
                "{} samples at {:.3} Hz, {file} has {} at {:.3} Hz: hits of one place must agree",
                theirs.0, theirs.1, mine.0, mine.1
            )
        } else {
            let joined = self.hits.len();
            check_hits(joined + other.hits.len(), || Location::whole(&other.file))?;
            self.further_files.push((joined, other.file));
            self.further_files.extend(other.further_files.into_iter().map(|(from, file)| (joined + from, file)));
            self.hits.extend(other.hits);
            self.cuts.extend(other.cuts);
            self.notes.extend(other.notes);
            return Ok(());
        };
        Err(DataError::Channels { at: Location::whole(other.file), problem })
    }
}

/// Records of one pair of places.
enum Gathered {
    Hits(TimeHistory),
    Line(Accelerance),
}

/// What a measurement's file holds.
struct GatheredFile {
    piece: usize,
    path: PathBuf,
    record: Option<usize>,
    numbered: Vec<NumberedPlace>,
    content: Gathered,
}

impl GatheredFile {
    /// What a measurement takes of its file.
    fn of(piece: usize, data: &MeasurementData, file: Arc<RecordFile>) -> Result<Option<Self>, DataError> {
        let (recorded, numbered, content) = match data {
            MeasurementData::NaturalFrequencies(_) => return Ok(None),
            MeasurementData::TimeHistory(recorded) => {
                let file = channel_choice::hits(file, recorded)?;
                let numbered = NumberedPlace::of(&file, recorded)?;
                (recorded.clone(), numbered, Gathered::Hits(TimeHistory::of_chosen(file, recorded)?))
            }
            MeasurementData::Accelerance(recorded) => {
                let record = match channel_choice::response(&file, recorded)?[..] {
                    [number] => Some(number),
                    _ => None,
                };
                let recorded = RecordedResponse { record, ..recorded.clone() };
                let numbered = NumberedPlace::of(&file, &recorded)?;
                let line = Accelerance::of_file(&file, &recorded)?;
                (recorded, numbered, Gathered::Line(line))
            }
        };
        Ok(Some(Self { piece, path: recorded.file, record: recorded.record, numbered, content }))
    }

    /// What all these measurements take of their files; a file of several is read once.
    fn all(measurements: &[&Measurement]) -> Result<Vec<Self>, DataError> {
        let mut files: Vec<(RecordedResponse, Vec<(usize, &Measurement)>)> = Vec::new();
        let mut places = HashMap::new();
        for (index, measurement) in measurements.iter().enumerate() {
            let Some(own) = measurement.data.recorded().cloned() else { continue };
            let in_memory = own.in_memory.as_ref().map(Arc::as_ptr);
            let key = (own.file.clone(), in_memory, own.response_file.clone(), own.columns.clone());
            match places.entry(key) {
                Entry::Occupied(place) => {
                    let place: usize = *place.get();
                    if let Some((_, of_file)) = files.get_mut(place) {
                        of_file.push((index, measurement));
                    }
                }
                Entry::Vacant(place) => {
                    place.insert(files.len());
                    files.push((own, vec![(index, *measurement)]));
                }
            }
        }
        type Read = (usize, Result<Option<GatheredFile>, DataError>);
        let read = |(recorded, of_file): (RecordedResponse, Vec<(usize, &Measurement)>)| -> Vec<Read> {
            match (recorded.records(), of_file.as_slice()) {
                (Err(error), [(first, _), ..]) => vec![(*first, Err(error))],
                (Ok(file), [(index, only)]) => vec![(*index, Self::of(only.piece, &only.data, Arc::new(file)))],
                (Ok(file), several) => {
                    let file = Arc::new(file);
                    let of = |(index, one): &(usize, &Measurement)| {
                        (*index, Self::of(one.piece, &one.data, Arc::clone(&file)))
                    };
                    several.par_iter().map(of).collect()
                }
                (Err(_), []) => vec![],
            }
        };
        let read: Vec<Vec<Read>> = files.into_par_iter().map(read).collect();
        let mut read: Vec<Read> = read.into_iter().flatten().collect();
        // The first error in the order of the test file: the same message whichever thread was quicker.
        read.sort_by_key(|(index, _)| *index);
        read.into_iter().filter_map(|(_, read)| read.transpose()).collect()
    }
}

/// A number that tells hits or lines apart, but for rare chances.
type Fingerprint = u64;

fn fingerprint(values: impl Iterator<Item = f64>) -> Fingerprint {
    let mut hasher = DefaultHasher::new();
    values.for_each(|value| value.to_bits().hash(&mut hasher));
    hasher.finish()
}

impl Gathered {
    /// Of each hit, or of all lines.
    fn fingerprints(&self) -> Vec<Fingerprint> {
        match self {
            Self::Hits(history) => {
                let of_hit = |hit: &Hit| fingerprint(hit.force.iter().chain(&hit.acceleration).copied());
                history.hits.iter().map(of_hit).collect()
            }
            Self::Line(line) => vec![fingerprint(line.value.iter().flat_map(|value| [value.re, value.im]))],
        }
    }

    /// Whether any hit or all lines of both are the same to the last digit, as in no two noisy measurements.
    fn repeats(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Hits(own), Self::Hits(others)) => own.hits.iter().any(|hit| others.hits.contains(hit)),
            (Self::Line(own), Self::Line(other)) => own.value == other.value,
            _ => false,
        }
    }

    /// Force and response.
    fn places(&self) -> (Place, Place) {
        match self {
            Self::Hits(history) => history.places(),
            Self::Line(accelerance) => (accelerance.force_at, accelerance.response_at),
        }
    }

    fn notes(&mut self) -> &mut Vec<String> {
        match self {
            Self::Hits(history) => &mut history.notes,
            Self::Line(accelerance) => &mut accelerance.notes,
        }
    }
}

/// Refuses a file that the test lists twice for the same places, for it would count twice, and tells files that hold the same record.
fn tell_repetitions(files: &mut [GatheredFile]) -> Result<(), DataError> {
    // The first file that holds each; all pairs of files would be too many.
    let mut holders: HashMap<Fingerprint, usize> = HashMap::new();
    for index in 0..files.len() {
        let (before, rest) = files.split_at_mut(index);
        let Some(file) = rest.first_mut() else { continue };
        let prints = file.content.fingerprints();
        let holder = prints.iter().filter_map(|print| holders.get(print)).min().copied();
        for print in prints {
            holders.entry(print).or_insert(index);
        }
        let Some(earlier) = holder.and_then(|holder| before.get(holder)) else { continue };
        if !file.content.repeats(&earlier.content) {
            continue;
        }
        let places = file.content.places() == earlier.content.places();
        if places && earlier.path == file.path && earlier.record == file.record {
            let problem = "the test lists this record twice: it would count twice; list it once".into();
            return Err(DataError::Contradiction { at: Location::whole(&file.path), problem });
        }
        let note = format!("{} holds a record of {} again: is it a copy?", file.path.display(), earlier.path.display());
        file.content.notes().push(note);
    }
    Ok(())
}

impl ImpactTest {
    /// Reads every time history of the test, in the order of the file, each with its piece's index.
    ///
    /// Files of one piece with the same places are joined, as in [`ImpactTest::accelerances`].
    ///
    /// # Errors
    /// As [`TimeHistory::read`] and [`TimeHistory::join`]; [`DataError::Contradiction`] where the files' node numbers
    /// contradict the places (one node at two places, or several nodes in the hits of one place), and where the test
    /// lists one record twice.
    pub fn time_histories(&self) -> Result<Vec<(usize, TimeHistory)>, DataError> {
        let hits = self.gathered(|data| matches!(data, MeasurementData::TimeHistory(_)))?.into_iter();
        let hits = hits.filter_map(|(piece, gathered)| match gathered {
            Gathered::Hits(history) => Some((piece, history)),
            Gathered::Line(_) => None,
        });
        Ok(hits.collect())
    }

    /// Reads every accelerance that a file of the test tells, in the order of the file, each with its piece's index.
    ///
    /// # Errors
    /// As [`ImpactTest::time_histories`], and [`Accelerance::read`].
    pub fn recorded_accelerances(&self) -> Result<Vec<(usize, Accelerance)>, DataError> {
        let lines = self.gathered(|data| matches!(data, MeasurementData::Accelerance(_)))?.into_iter();
        let lines = lines.filter_map(|(piece, gathered)| match gathered {
            Gathered::Line(line) => Some((piece, line)),
            Gathered::Hits(_) => None,
        });
        Ok(lines.collect())
    }

    /// Reads every time history and accelerance of the test, in the order of the file, each with its piece's index.
    ///
    /// Time histories of one piece with the same places are hits of one accelerance, which stands where the first of
    /// them does.
    ///
    /// # Errors
    /// As [`ImpactTest::time_histories`], [`TimeHistory::accelerance`] and [`Accelerance::read`].
    pub fn accelerances(&self, estimation: Estimation) -> Result<Vec<(usize, Accelerance)>, DataError> {
        let estimated = self.gathered(|_| true)?.into_par_iter().map(|(piece, gathered)| match gathered {
            Gathered::Hits(history) => {
                let mut line = history.accelerance(estimation)?;
                line.cut_to(history.band, || Location::whole(&history.file))?;
                Ok((piece, line))
            }
            Gathered::Line(accelerance) => Ok((piece, accelerance)),
        });
        // First all, then the first error in the order of the file: the same message whichever thread was quicker.
        estimated.collect::<Vec<_>>().into_iter().collect()
    }

    fn gathered(&self, wanted: impl Fn(&MeasurementData) -> bool) -> Result<Vec<(usize, Gathered)>, DataError> {
        let measurements: Vec<_> = self.measurements.iter().filter(|measurement| wanted(&measurement.data)).collect();
        let mut read = GatheredFile::all(&measurements)?;
        for piece in 0..self.pieces.len() {
            node_numbers::check(read.iter().filter(|file| file.piece == piece).flat_map(|file| &file.numbered))?;
        }
        tell_repetitions(&mut read)?;
        let mut gathered: Vec<(usize, Gathered)> = Vec::new();
        for GatheredFile { piece, content, .. } in read {
            match content {
                Gathered::Hits(history) => {
                    let same = gathered.iter_mut().find_map(|(of, earlier)| match earlier {
                        Gathered::Hits(earlier) if *of == piece && earlier.places() == history.places() => {
                            Some(earlier)
                        }
                        _ => None,
                    });
                    match same {
                        Some(earlier) => earlier.join(history)?,
                        None => gathered.push((piece, Gathered::Hits(history))),
                    }
                }
                line => gathered.push((piece, line)),
            }
        }
        Ok(gathered)
    }
}
