//! Records in other units than they were read in, of another quantity, or turned round: one factor explains all, and is said before
//! anything is searched for.
//!
//! Frequencies of resonances stay as they are under any factor $cs^n$. They tell the constants, these the model's lines, and the lines
//! the factor: $H_{cal}/s^nH_{exp}$ is the same real number at all of them for the right $n$ alone.

use num_complex::Complex64;
use orthopanel_data::{Accelerance, ImpactTest, MeasurementData, Motion, Unit};
use orthopanel_model::{Owner, effect};

use super::contradiction::record_name;
use super::misfit::{median, scaled_misfit_percent};
use super::records::PlaceRecord;
use super::start::{Recorded, recorded_of, start};
use super::{assemble, starting_parameters};
use crate::error::{Mend, mend};
use crate::structures::{self, Shown};
use crate::{IdentifyError, Settings};

/// Derivatives by which a record may be another quantity than it was read as, what is mostly right first.
const DERIVATIVES: [i8; 5] = [0, 1, 2, -1, -2];
/// Median misfit of a record's lines \[%\] below which a factor explains them, ...
const EXPLAINED: f64 = 25.0;
/// ... where it is less than this part of what it is without.
const MENDS: f64 = 0.3;
/// The same of a record that wants no factor: an effect that the model lacks may bend it by half.
const BENT: f64 = 40.0;
/// Median misfits \[%\] between which records are looked at once more from nearby.
const CLEAR: f64 = 3.0;
const NEARLY: f64 = 60.0;
/// A factor no further from one than this is a gain's, or the mass's.
const GAIN: f64 = 1.3;
/// Up to here a factor of no unit is left to a search, as an effect; all records want the same within a part.
const EFFECT: f64 = 2.0;
const ALIKE: f64 = 0.05;
/// Lines of a record that are looked at: the median of these is that of all.
const LINES: usize = 1200;
/// Fewer lines than these tell no factor.
const LEAST_LINES: usize = 30;

/// What one record is to the model.
#[derive(Debug, Clone, Copy)]
struct Scaled {
    derivatives: i8,
    /// The model over $s^n$ times the record.
    factor: f64,
    /// Median misfit with factor and derivatives, and without \[%\].
    left: f64,
    without: f64,
}

impl Scaled {
    /// Whether the record is as the model has it, whatever an effect may do to it.
    fn is_as_read(&self) -> bool {
        self.without < BENT || (self.derivatives == 0 && self.is_about_one() && self.left < BENT)
    }

    fn is_about_one(&self) -> bool {
        self.factor > 0.0 && self.factor.ln().abs() < GAIN.ln()
    }

    /// Whether factor and derivatives explain it.
    fn is_explained(&self) -> bool {
        let is_factor = self.derivatives != 0 || !self.is_about_one();
        is_factor && self.left < EXPLAINED && self.left < MENDS * self.without
    }
}

/// Refuses records that a known factor explains, all of them or some, by the line of the test file that mends them.
///
/// Plates are left to their own fit, and so is a test that declares an effect of the measuring chain. What the records refuse
/// otherwise is not said here.
///
/// # Errors
/// [`IdentifyError::OtherUnits`].
pub(crate) fn refuse_other_units(
    test: &ImpactTest,
    accelerances: &[(usize, Accelerance)],
) -> Result<(), IdentifyError> {
    // What cannot be read off the records is said by what needs it.
    recorded_of(test, accelerances).map_or(Ok(()), |recorded| refuse_read_in_other_units(test, accelerances, &recorded))
}

/// The same, with their poles as they were read.
///
/// # Errors
/// [`IdentifyError::OtherUnits`].
pub(super) fn refuse_read_in_other_units(
    test: &ImpactTest,
    accelerances: &[(usize, Accelerance)],
    as_read: &Recorded,
) -> Result<(), IdentifyError> {
    let is_of_channel = |id: &str| effect(id).is_ok_and(|effect| effect.owner() == Owner::Channel);
    if structures::of_test(test).shown() != Shown::Wholly || test.effects.iter().any(|of| is_of_channel(&of.id)) {
        return Ok(());
    }
    let mut best: Option<Vec<Scaled>> = None;
    let mut readings: Vec<Reading> = Vec::new();
    for derivatives in DERIVATIVES {
        if let Some(records) = read_with(test, accelerances, derivatives) {
            readings.push(Reading { derivatives, records });
        }
        // The next quantity is read where this one does not explain all.
        let found = match derivatives {
            0 => scaled(as_read, &readings),
            _ => readings.last().and_then(|last| scaled(&recorded_of(test, &last.records).ok()?, &readings)),
        };
        let Some(mut found) = found else { continue };
        if found.iter().any(|one| !one.is_as_read() && (CLEAR..NEARLY).contains(&one.left)) {
            found = once_more(test, &readings, &found);
        }
        if found.iter().all(Scaled::is_as_read) {
            return Ok(());
        }
        let explained = |of: &[Scaled]| of.iter().filter(|one| one.is_explained() || one.is_as_read()).count();
        if best.as_ref().is_none_or(|best| explained(best) < explained(&found)) {
            best = Some(found);
        }
        if best.as_ref().is_some_and(|best| explained(best) == best.len()) {
            break;
        }
    }
    let Some(found) = best else { return Ok(()) };
    let of_record = |(one, (_, record)): (&Scaled, &(usize, Accelerance))| {
        mend(one.factor, one.derivatives, record.read_as).filter(|_| one.is_explained())
    };
    let mends: Vec<Option<Mend>> = found.iter().zip(accelerances).map(of_record).collect();
    let mends = if mends.iter().all(Option::is_none) { of_no_unit(&found) } else { mends };
    let Some(due) = mends.iter().flatten().next() else { return Ok(()) };
    let wrong: Vec<usize> =
        (0..found.len()).filter(|&index| mends[index].as_ref().is_some_and(|other| other.is_same(due))).collect();
    let is_clear = found.iter().zip(&mends).all(|(one, mend)| one.is_as_read() || mend.is_some());
    if !is_clear && 2 * wrong.len() <= found.len() {
        return Ok(());
    }
    let records = (wrong.len() < found.len()).then(|| {
        let name = |&index: &usize| {
            let (piece, record) = &accelerances[index];
            record_name(test, *piece, (record.force_at, record.response_at))
        };
        wrong.iter().map(name).collect()
    });
    let numbers = (wrong.len() < found.len()).then(|| wrong.iter().map(|index| index + 1).collect::<Vec<_>>());
    let of_wrong = |value: fn(&Scaled) -> f64| median(wrong.iter().map(|&index| value(&found[index])));
    Err(IdentifyError::OtherUnits {
        lines: due.lines(&records, numbers.as_deref()),
        records,
        factor: of_wrong(|one| one.factor),
        derivatives: found[wrong[0]].derivatives,
        percent: [of_wrong(|one| one.without), of_wrong(|one| one.left)],
    })
}

/// The same from records that the factor found has put near the model: of what is far too strong or too weak noise hides other modes than
/// it should.
fn once_more(test: &ImpactTest, readings: &[Reading], found: &[Scaled]) -> Vec<Scaled> {
    let by = median(found.iter().map(|one| one.factor));
    let near: Vec<Reading> = readings
        .iter()
        .map(|Reading { derivatives, records }| {
            let records = records.iter().map(|(piece, record)| (*piece, times(record, by))).collect();
            Reading { derivatives: *derivatives, records }
        })
        .collect();
    let again = near.last().and_then(|last| scaled(&recorded_of(test, &last.records).ok()?, &near));
    let Some(again) = again else { return found.to_vec() };
    let kept = |(one, again): (&Scaled, Scaled)| match again.left < one.left {
        true => Scaled { factor: by * again.factor, without: one.without, ..again },
        false => *one,
    };
    found.iter().zip(again).map(kept).collect()
}

/// A gain for all records, where one factor explains them that is no unit's; none where they differ, or where it is no more than an
/// effect may be.
fn of_no_unit(found: &[Scaled]) -> Vec<Option<Mend>> {
    let factor = median(found.iter().map(|one| one.factor));
    let is_alike = |one: &Scaled| {
        one.derivatives == 0 && one.is_explained() && (one.factor / factor - 1.0).abs() < ALIKE && factor > 0.0
    };
    let is_one = factor.abs().ln().abs() > EFFECT.ln() && found.iter().all(is_alike);
    let cause = "a sensitivity, or the mass of the piece".to_owned();
    vec![is_one.then_some(Mend::Gain { measurement: None, gain: 1.0 / factor, cause }); found.len()]
}

/// All records as they are where they are another quantity.
struct Reading {
    derivatives: i8,
    records: Vec<(usize, Accelerance)>,
}

/// The records times $s^n$; `None` where they cannot be. Hits are read anew, for what a record's end cuts off is not the same of a motion
/// and its derivative.
fn read_with(
    test: &ImpactTest,
    accelerances: &[(usize, Accelerance)],
    derivatives: i8,
) -> Option<Vec<(usize, Accelerance)>> {
    let are_hits = test.measurements.iter().all(|of| matches!(of.data, MeasurementData::TimeHistory(_)));
    if derivatives == 0 || !are_hits {
        return Some(accelerances.iter().map(|(piece, record)| (*piece, times_s(record, derivatives))).collect());
    }
    let read = accelerances.first()?.1.read_as;
    let due = i8::try_from(read.motion.derivatives()).ok()? + derivatives;
    let motion = Motion::ALL.into_iter().find(|motion| i8::try_from(motion.derivatives()) == Ok(due))?;
    let mut other = test.clone();
    for measurement in &mut other.measurements {
        if let MeasurementData::TimeHistory(recorded) = &mut measurement.data {
            (recorded.quantity, recorded.response_unit) = (Some(motion), Unit::parse(motion.si_unit()));
        }
    }
    let mut found = other.accelerances(Settings::default().estimation).ok()?;
    for (_, record) in &mut found {
        // As a factor on what was read, in whatever unit that was.
        *record = times(record, read.response);
    }
    (found.len() == accelerances.len()).then_some(found)
}

/// What each record is to the model whose resonances are those of the last reading; `None` where no model has them.
fn scaled(recorded: &Recorded, readings: &[Reading]) -> Option<Vec<Scaled>> {
    let last = readings.last()?;
    let start = start(recorded).ok()?;
    let problem = assemble(&start, Settings::default()).ok()?;
    let lines = problem.lines(&starting_parameters(&problem, &start)).ok()?;
    // Records stand by pieces there, in their order within each.
    let mut found: Vec<Option<Scaled>> = vec![None; last.records.len()];
    let of_pieces =
        problem.pieces.iter().flat_map(|piece| piece.records.iter().map(move |record| (piece.piece, record)));
    for ((piece, record), lines) in of_pieces.zip(&lines) {
        let at = (0..found.len()).find(|&at| last.records[at].0 == piece && found[at].is_none())?;
        found[at] = best_scale(at, record, lines, readings);
    }
    found.into_iter().collect()
}

/// The factor and the derivatives with which record number `at` is nearest to its model, which has `lines` where `as_modelled` has its.
fn best_scale(at: usize, as_modelled: &PlaceRecord, lines: &[Complex64], readings: &[Reading]) -> Option<Scaled> {
    let of_reading = |reading: &Reading| {
        let record = PlaceRecord::of(&reading.records.get(at)?.1);
        // Noise leaves lines out of one reading and not of another.
        let line_of = |frequency: &f64| {
            let next = as_modelled.frequency.partition_point(|line| *line < frequency * (1.0 - 1e-9));
            let found = as_modelled.frequency.get(next).is_some_and(|line| (line / frequency - 1.0).abs() < 1e-9);
            found.then_some(next)
        };
        let mut thin = record.thinned(LINES);
        let places: Vec<Option<usize>> = thin.frequency.iter().map(line_of).collect();
        let shared = |line: &usize| places[*line].is_some();
        let kept: Vec<usize> = (0..thin.value.len()).filter(shared).collect();
        thin.value = kept.iter().map(|&line| thin.value[line]).collect();
        thin.variance = kept.iter().map(|&line| thin.variance[line]).collect();
        let model: Vec<Complex64> = places.iter().flatten().filter_map(|&line| lines.get(line).copied()).collect();
        if model.len() < LEAST_LINES || model.len() != thin.value.len() {
            return None;
        }
        let factor = median(thin.value.iter().zip(&model).map(|(measured, model)| (measured / model).re));
        let left = if factor == 0.0 { f64::INFINITY } else { scaled_misfit_percent(&thin, &model, factor) };
        Some((1.0 / factor, left, scaled_misfit_percent(&thin, &model, 1.0)))
    };
    let mut best: Option<Scaled> = None;
    let without = readings.iter().find(|reading| reading.derivatives == 0).and_then(of_reading)?.2;
    for reading in readings {
        let Some((factor, left, _)) = of_reading(reading) else { continue };
        // Another quantity has to be much nearer than the one that was read.
        if best.as_ref().is_none_or(|best| left < 0.5 * best.left) {
            best = Some(Scaled { derivatives: reading.derivatives, factor, left, without });
        }
    }
    best
}

/// An accelerance times a factor, with its noise.
fn times(record: &Accelerance, factor: f64) -> Accelerance {
    let mut taken = record.clone();
    taken.value.iter_mut().for_each(|value| *value *= factor);
    taken.variance.iter_mut().flatten().for_each(|variance| *variance *= factor * factor);
    taken.force_noise = None;
    taken
}

/// An accelerance times $s^n$, with its noise.
fn times_s(record: &Accelerance, derivatives: i8) -> Accelerance {
    let mut taken = record.clone();
    if derivatives == 0 {
        return taken;
    }
    let power = i32::from(derivatives);
    let s = |frequency: &f64| Complex64::new(record.decay_rate, std::f64::consts::TAU * frequency).powi(power);
    let factors: Vec<Complex64> = record.frequency.iter().map(s).collect();
    taken.value.iter_mut().zip(&factors).for_each(|(value, by)| *value *= by);
    if let Some(variance) = &mut taken.variance {
        variance.iter_mut().zip(&factors).for_each(|(variance, by)| *variance *= by.norm_sqr());
    }
    taken.force_noise = None;
    taken
}
