//! Force and acceleration against time, hit by hit.

use std::{path::PathBuf, sync::Arc};

use orthopanel_model::Place;

use super::{
    accelerance::Accelerance,
    channel_choice,
    channels::{self, Calibration, Quantity},
    derivative::derivative,
    extremes::{LANES, extremes, sampled_median},
    misplaced_channel::{self, Ordered},
    time_grid,
    trigger::{self, Cut},
    window::milliseconds,
};
use crate::{
    DataError, Location, Motion, RecordedResponse, Unit, limits,
    records::{Record, RecordFile, RecordKind, Samples},
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
    /// What was mended or assumed, a sentence each.
    pub notes: Vec<String>,
}

/// One hit: sample $n$ stands at $t = n / \mathrm{rate}$ from the record's start.
#[derive(Debug, Clone, PartialEq)]
pub struct Hit {
    /// Force of the hammer \[N\].
    pub force: Vec<f64>,
    /// Acceleration along the force \[m/s²\], as long as `force`.
    pub acceleration: Vec<f64>,
}

/// A blow on a panel may be as short as this \[s\].
const SHORT_BLOW: f64 = 5e-4;

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
                format!("{problem}; of several to a blow name the channels by force_channel and response_channel")
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
            let of_record = hit((force, acceleration), rate, measurement, &mut notes)?;
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
        Ok(Self { notes, cuts, band: measurement.band, ..Self::new(file, [force_at, response_at], rate, hits) })
    }
}

/// Refuses more hits of one pair of places than are taken.
pub(super) fn check_hits(found: usize, at: impl FnOnce() -> Box<Location>) -> Result<(), DataError> {
    let (what, most, remedy) = ("hits of one pair of places", limits::HITS, "leave some out: their mean needs no more");
    if found <= most { Ok(()) } else { Err(DataError::TooMany { at: at(), found, what, most, remedy }) }
}

/// The two channels of a hit at a sampling rate \[Hz\].
fn hit(
    (force, acceleration): (Record, Record),
    rate: f64,
    measurement: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<Hit, DataError> {
    let directions = [acceleration.response.direction, force.response.direction];
    let to_newtons = channels::force(&force, measurement, notes)?;
    let Calibration { factor, motion } = channels::motion(&acceleration, measurement, directions, notes)?;
    let real = |record: Record| match record.ordinate {
        Samples::Real(values) => Ok(values),
        Samples::Complex(_) => {
            let problem = "a record against time must be real".into();
            Err(DataError::Channels { at: record.at, problem })
        }
    };
    let (force_record, motion_record) = (force.at.clone(), acceleration.at.clone());
    let mut hit = Hit { force: real(force)?, acceleration: real(acceleration)? };
    misplaced_channel::check_apart(&hit, motion_record.clone())?;
    for (channel, factor) in [(&mut hit.force, to_newtons), (&mut hit.acceleration, factor)] {
        if factor != 1.0 {
            channel.iter_mut().for_each(|value| *value *= factor);
        }
    }
    if let Some(tau) = measurement.window_decay {
        undo_window(&mut hit, rate, tau, &motion_record)?;
        notes.push(format!("{}: the exponential window of {} undone", motion_record.key, milliseconds(tau)));
    }
    for _ in 0..motion.derivatives() {
        hit.acceleration = derivative(&hit.acceleration, rate);
    }
    if motion != Motion::Acceleration {
        notes.push(format!("{}: {motion} differentiated to an acceleration, with its noise", motion_record.key));
    }
    // A hammer's channel rests at its offset nearly all the time, and the motion swings about its own.
    let [pulse, ringing] =
        [&hit.force, &hit.acceleration].map(|channel| effective_samples(channel, sampled_median(channel)));
    // A blow is over before the piece has rung, and pushes once or twice: a longer "force" that swings more often than
    // the response is none. Noise alone makes a weak force long, too, but the response then swings more often.
    if pulse > ringing && ringing > 0.0 {
        let pushes = hit.pushes();
        std::mem::swap(&mut hit.force, &mut hit.acceleration);
        let swapped = hit.pushes();
        std::mem::swap(&mut hit.force, &mut hit.acceleration);
        if swapped < pushes {
            let step = 1.0 / rate;
            let missed = if step > SHORT_BLOW {
                format!(
                    ", or at {rate:.1} Hz the blow fell between two samples, which stand {} apart: the sampling rate is too low, or \
                     the record was decimated without a low pass; record at some {:.0} Hz or more",
                    milliseconds(step),
                    2.0 / SHORT_BLOW
                )
            } else {
                String::new()
            };
            let problem = format!(
                "the force lasts longer ({pulse:.0} samples) than the response ({ringing:.0}) and swings more often: the \
                 channels are swapped, or this was no hammer{missed}"
            );
            return Err(DataError::Channels { at: force_record, problem });
        }
    }
    Ok(hit)
}

/// Takes an exponential window $e^{-t/\tau}$ over both channels out of them: what was multiplied is divided.
///
/// # Errors
/// [`DataError::Channels`] where hardly a digit of the record's end outlived it.
fn undo_window(hit: &mut Hit, rate: f64, tau: f64, at: &Location) -> Result<(), DataError> {
    let length = hit.force.len() as f64 / rate;
    if length > MOST_FALL * tau {
        let problem = format!(
            "window_decay = {tau} s leaves e^-{:.1} of the record's end, after {length:.4} s: no digit of it is left; is it the time constant, \
             in s?",
            length / tau
        );
        return Err(DataError::Channels { at: Box::new(at.clone()), problem });
    }
    for channel in [&mut hit.force, &mut hit.acceleration] {
        channel.iter_mut().enumerate().for_each(|(n, value)| *value *= (n as f64 / (rate * tau)).exp());
    }
    Ok(())
}

/// Time constants that a record may last: a converter of 24 bits has no digit below $e^{-16}$.
const MOST_FALL: f64 = 14.0;

/// Number of samples over which the energy of a signal about its `offset` is spread, $(\sum x^2)^2 / \sum x^4$.
fn effective_samples(values: &[f64], offset: f64) -> f64 {
    let [least, greatest] = extremes(values);
    let peak = (greatest - offset).max(offset - least);
    if peak <= 0.0 {
        return 0.0;
    }
    // Scaled, so that no fourth power overflows; several sums side by side, since one would wait for itself.
    let scale = 1.0 / peak;
    let (mut squares, mut fourths) = ([0.0; LANES], [0.0; LANES]);
    for chunk in values.chunks(LANES) {
        for ((two, four), value) in squares.iter_mut().zip(&mut fourths).zip(chunk) {
            let square = ((value - offset) * scale).powi(2);
            *two += square;
            *four += square * square;
        }
    }
    let (squares, fourths) = (squares.iter().sum::<f64>(), fourths.iter().sum::<f64>());
    if fourths > 0.0 { squares * squares / fourths } else { 0.0 }
}
