//! Force and acceleration against time, hit by hit.

use std::{path::PathBuf, sync::Arc};

use orthopanel_model::Place;

use super::{
    accelerance::Accelerance,
    channel_choice,
    channels::{self, Quantity},
    hit::Hit,
    misplaced_channel::{self, Ordered},
    read_as::ReadAs,
    recorded_hit::recorded_hit,
    time_grid,
    trigger::{self, Cut},
};
use crate::{
    DataError, Location, Motion, RecordedResponse, Unit, limits,
    records::{RecordFile, RecordKind},
};

/// The hits of one pair of places, sampled alike.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeHistory {
    /// The file, for messages.
    pub file: PathBuf,
    /// Where the hammer hit.
    pub force_at: Place,
    /// Where the accelerometer sat.
    pub response_at: Place,
    /// Sampling rate \[Hz\].
    pub rate: f64,
    /// The hits; at least one, all of one length.
    pub hits: Vec<Hit>,
    /// Where hits of several files stand together: each further file, and the index of its first hit.
    pub further_files: Vec<(usize, PathBuf)>,
    /// Lines \[Hz\] of an accelerance that count, from and to; all where nothing is declared.
    pub band: Option<[f64; 2]>,
    /// How continuous records were cut into these hits.
    pub cuts: Vec<Cut>,
    /// As what the records were read; of several files the first.
    pub read_as: ReadAs,
    /// What was mended or assumed, a sentence each.
    pub notes: Vec<String>,
}

impl TimeHistory {
    /// Hits of one length at the sampling rate \[Hz\], from a force at the first place to a response at the second; `file` is
    /// what messages call them.
    pub fn new(file: impl Into<PathBuf>, [force_at, response_at]: [Place; 2], rate: f64, hits: Vec<Hit>) -> Self {
        Self {
            file: file.into(),
            force_at,
            response_at,
            rate,
            hits,
            further_files: Vec::new(),
            band: None,
            cuts: Vec::new(),
            read_as: ReadAs::SI,
            notes: Vec::new(),
        }
    }

    /// A hit by its number from 1, and by its file where there are several.
    pub(super) fn hit_name(&self, index: usize) -> String {
        if self.further_files.is_empty() {
            return format!("hit {}", index + 1);
        }
        let later = self.further_files.iter().rev().find(|(from, _)| *from <= index);
        let file = later.map_or(&self.file, |(_, file)| file);
        format!("hit {} ({})", index + 1, file.file_name().unwrap_or(file.as_os_str()).display())
    }

    /// The hits that an accelerance of this history stands on: what it left out helps nobody else either.
    #[must_use]
    pub fn kept_in(&self, accelerance: &Accelerance) -> Self {
        let (kept, hits): (Vec<usize>, Vec<Hit>) =
            self.kept(&accelerance.verdicts).into_iter().map(|(index, hit)| (index, hit.clone())).unzip();
        let files = self
            .further_files
            .iter()
            .map(|(from, file)| (kept.iter().take_while(|index| *index < from).count(), file.clone()));
        Self { hits, further_files: files.collect(), ..self.clone() }
    }

    /// Reads the file of a time-history measurement.
    ///
    /// # Errors
    /// As [`RecordFile::read`], and as [`TimeHistory::from_records`].
    pub fn read(measurement: &RecordedResponse) -> Result<Self, DataError> {
        Self::from_records(measurement.records()?, measurement)
    }

    /// Pairs the force and acceleration records of a file, in the order of the file, and puts unit and direction right.
    ///
    /// # Errors
    /// [`DataError::Channels`] where a channel is missing or swapped, where lengths or rates differ, where samples are
    /// uneven in time, or where a unit is unknown or contradicts the declared one.
    pub fn from_records(file: RecordFile, measurement: &RecordedResponse) -> Result<Self, DataError> {
        Self::of_chosen(channel_choice::hits(Arc::new(file), measurement)?, measurement)
    }

    /// As [`TimeHistory::from_records`], of the records that belong to the measurement.
    pub(super) fn of_chosen(file: RecordFile, measurement: &RecordedResponse) -> Result<Self, DataError> {
        let RecordFile { records, mut notes, .. } = file;
        let (mut forces, mut accelerations) = (Vec::new(), Vec::new());
        let mut untold = Vec::new();
        let mut order: Vec<Ordered> = Vec::new();
        let Some(first) = records.first().map(|record| record.at.clone()) else {
            return Err(DataError::Contradiction {
                at: Location::whole(&measurement.file),
                problem: "no record is given".into(),
            });
        };
        let mut others = Vec::new();
        let by_unit = measurement.response_unit.as_ref().and_then(Unit::motion);
        let untold_motion = measurement.quantity.or(by_unit).unwrap_or(Motion::Acceleration);
        let in_time = || records.iter().filter(|record| record.kind == RecordKind::Time);
        let is_there =
            |wanted: fn(Quantity) -> bool| in_time().any(|record| wanted(channels::quantity(&record.numerator)));
        let is_motion = |quantity| matches!(quantity, Quantity::Motion(_));
        // Beside one channel that is told, what tells nothing is the other.
        let beside = match (is_there(|quantity| quantity == Quantity::Force), is_there(is_motion)) {
            (true, false) => Some((Quantity::Motion(untold_motion), untold_motion.name())),
            (false, true) => Some((Quantity::Force, "force")),
            _ => None,
        };
        for record in records.into_iter().filter(|record| record.kind == RecordKind::Time) {
            let quantity = match (channels::quantity(&record.numerator), beside) {
                (Quantity::Untold, Some((quantity, name))) => {
                    notes.push(format!("{}: tells neither type nor unit, taken as {name}", record.at.key));
                    quantity
                }
                (told, _) => told,
            };
            match quantity {
                Quantity::Force => {
                    order.push((record.at.clone(), true));
                    forces.push(record);
                }
                Quantity::Motion(_) => {
                    order.push((record.at.clone(), false));
                    accelerations.push(record);
                }
                Quantity::Untold => untold.push(record),
                Quantity::Other(kind) => {
                    let name = channels::type_name(kind);
                    let note =
                        format!("{}: data type {kind}{name} is neither force nor motion: left out", record.at.key);
                    others.push(note.clone());
                    notes.push(note);
                }
            }
        }
        if forces.is_empty() && accelerations.is_empty() && !untold.is_empty() {
            notes.push("the records do not tell what they measure: taken as force, acceleration, force, ...".into());
            for (index, record) in untold.into_iter().enumerate() {
                if index % 2 == 0 { forces.push(record) } else { accelerations.push(record) }
            }
        }
        if forces.len() != accelerations.len() || forces.is_empty() {
            let (f, a) = (forces.len(), accelerations.len());
            let problem = format!("{f} force and {a} acceleration records against time: one of each a hit is needed");
            let problem = if f > 0 && a > 0 {
                let several = if a > f { ("response_channel", &accelerations) } else { ("force_channel", &forces) };
                format!(
                    "{problem}; of several to a blow each has a [[measurement]] of its own, with {}",
                    channel_choice::written(several)
                )
            } else {
                format!(
                    "{problem}; where they stand in two files, name both by file = {{force = \"..\", response = \"..\"}}"
                )
            };
            let problem = others.first().map_or(problem.clone(), |other| format!("{problem} ({other})"));
            return Err(misplaced_channel::alone(&order, problem, first));
        }
        misplaced_channel::check_order(&order)?;
        check_hits(forces.len(), || first)?;
        let (mut hits, mut cuts) = (Vec::with_capacity(forces.len()), Vec::new());
        let mut grid: Option<(usize, f64)> = None;
        let mut read_as: Option<ReadAs> = None;
        let mut times: Option<(Arc<[f64]>, f64)> = None;
        for (force, acceleration) in forces.into_iter().zip(accelerations) {
            // Records of one file mostly share their times: what was found even stays even.
            let known = times
                .as_ref()
                .filter(|(known, _)| Arc::ptr_eq(known, &force.abscissa) && Arc::ptr_eq(known, &acceleration.abscissa));
            let (length, rate) = match known {
                Some((known, rate)) => (known.len(), *rate),
                None => time_grid::common(&force, &acceleration, measurement.sampling_rate, &mut notes)?,
            };
            times = Some((Arc::clone(&force.abscissa), rate));
            match grid {
                Some((first_length, first_rate))
                    if first_length != length || (first_rate - rate).abs() > 1e-6 * first_rate =>
                {
                    let problem = format!(
                        "hit {}: {length} samples at {rate:.3} Hz, the hit before had {first_length} at {first_rate:.3} Hz",
                        hits.len() + 1
                    );
                    return Err(DataError::Channels { at: force.at, problem });
                }
                _ => grid = Some((length, rate)),
            }
            let at = force.at.clone();
            let (of_record, as_read) = recorded_hit((force, acceleration), rate, measurement, &mut notes)?;
            read_as = read_as.or(Some(as_read));
            let blows = trigger::cut(of_record, rate, measurement.trigger, &at, &mut notes)?;
            hits.extend(blows.hits);
            cuts.extend(blows.cut);
        }
        let rate = grid.map_or(0.0, |(_, rate)| rate);
        check_hits(hits.len(), || Location::whole(&measurement.file))?;
        // Records that were cut by gaps of their own have hits of one length too: the shortest.
        let shortest = hits.iter().map(|hit: &Hit| hit.force.len()).min().unwrap_or_default();
        for hit in &mut hits {
            hit.force.truncate(shortest);
            hit.acceleration.truncate(shortest);
        }
        let RecordedResponse { force_at, response_at, .. } = *measurement;
        let file = measurement.file.clone();
        let read_as = read_as.unwrap_or(ReadAs::SI);
        let band = measurement.band;
        Ok(Self { notes, cuts, read_as, band, ..Self::new(file, [force_at, response_at], rate, hits) })
    }
}

/// Refuses more hits of one pair of places than are taken.
pub(super) fn check_hits(found: usize, at: impl FnOnce() -> Box<Location>) -> Result<(), DataError> {
    let (what, most, remedy) = ("hits of one pair of places", limits::HITS, "leave some out: their mean needs no more");
    if found <= most { Ok(()) } else { Err(DataError::TooMany { at: at(), found, what, most, remedy }) }
}
