//! Records in other units than they were read in, of another quantity, or turned round: one factor explains all, and is said before
//! anything is searched for.
//!
//! Frequencies of resonances stay as they are under any factor $cs^n$, and under a delay. They tell the constants, these the model's lines,
//! and the lines the factor: $H_{cal}/s^ne^{sT}H_{exp}$ is the same real number at all of them for the right $n$ and $T$ alone.

use num_complex::Complex64;
use orthopanel_data::{Accelerance, ImpactTest, MeasurementData, Motion, ReadAs, Unit};
use orthopanel_model::{GAIN as GAIN_EFFECT, Place, RECORD_GAIN};
use rayon::prelude::*;

use super::misfit::median;
use super::record_name::record_name;
use super::recorded::Recorded;
use super::records::PlaceRecord;
use super::scale::{Compared, Scale, common_delay};
use super::start::{recorded_of, start};
use super::{assemble, starting_parameters};
use crate::error::{Factor, Mend, gain_of_no_unit, mend};
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
/// All records want the same factor within this part.
const ALIKE: f64 = 0.05;

/// Part of a record's band in which sums over samples are integrals: the rule of trapezoids is off by 5 % at an eighth of the sampling
/// rate, and bands end below half of it.
const PART: f64 = 0.25;

/// What one record is to the model.
#[derive(Debug, Clone, Copy)]
struct Scaled {
    derivatives: i8,
    /// By how much it is sampled late \[s\].
    delay: f64,
    /// What is left beside both.
    scale: Scale,
    /// Median misfit as it was read \[%\].
    as_read: f64,
    /// Standard deviation of the factor's logarithm.
    std: f64,
}

impl Scaled {
    /// Whether the record is as the model has it, whatever an effect may do to it.
    fn is_as_read(&self) -> bool {
        self.as_read < BENT || (self.derivatives == 0 && self.is_about_one() && self.scale.left < BENT)
    }

    fn is_about_one(&self) -> bool {
        self.scale.factor > 0.0 && self.scale.factor.ln().abs() < GAIN.ln()
    }

    /// Whether factor, derivatives and delay explain it.
    fn is_explained(&self) -> bool {
        let is_factor = self.derivatives != 0 || !self.is_about_one();
        is_factor && self.scale.left < EXPLAINED && self.scale.left < MENDS * self.as_read
    }
}

/// Refuses records that a known factor explains, all of them or some, by the line of the test file that mends them.
///
/// Plates are left to their own fit, and so is a test that declares a gain. What the records refuse otherwise is not said here.
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
    if structures::of_test(test).shown() != Shown::Wholly || declares_a_gain(test) {
        return Ok(());
    }
    let mut best: Option<Vec<Scaled>> = None;
    let mut readings: Vec<Reading> = Vec::new();
    for derivatives in DERIVATIVES {
        if let Some(records) = read_with(test, accelerances, derivatives) {
            readings.push(Reading::of(derivatives, records));
        }
        // The next quantity is read where this one does not explain all.
        let found = match derivatives {
            0 => scaled(as_read, &readings),
            _ => readings.last().and_then(|last| scaled(&recorded_of(test, &last.accelerances).ok()?, &readings)),
        };
        let Some(mut found) = found else { continue };
        if found.iter().any(|one| !one.is_as_read() && (CLEAR..NEARLY).contains(&one.scale.left)) {
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
    let records: Vec<Named> = accelerances
        .iter()
        .map(|(piece, record)| Named {
            piece: *piece,
            places: (record.force_at, record.response_at),
            read_as: record.read_as,
        })
        .collect();
    said(test, &records, &found).map_or(Ok(()), Err)
}

fn declares_a_gain(test: &ImpactTest) -> bool {
    test.effects.iter().any(|effect| [GAIN_EFFECT, RECORD_GAIN].contains(&effect.id.as_str()))
}

/// What explains records that miss their model's `lines`, as a fit of them ended; `None` where no factor does.
pub(super) fn other_units(
    test: &ImpactTest,
    records: &[(usize, &PlaceRecord)],
    lines: &[Vec<Complex64>],
) -> Option<IdentifyError> {
    let with_s = |derivatives: i8| {
        let records = records.iter().map(|(_, record)| record.times_s(derivatives)).collect();
        Reading { derivatives, accelerances: Vec::new(), records }
    };
    let readings = DERIVATIVES.map(with_s);
    let models: Vec<Modelled> = records
        .iter()
        .zip(lines)
        .map(|((_, record), lines)| Modelled { frequency: &record.frequency, lines, poles: 1 })
        .collect();
    let found = scaled_beside(&models, &readings)?;
    let named = |(piece, record): &(usize, &PlaceRecord)| Named {
        piece: *piece,
        places: (record.force_at, record.response_at),
        read_as: record.read_as,
    };
    said(test, &records.iter().map(named).collect::<Vec<_>>(), &found)
}

/// A record as messages name it.
struct Named {
    piece: usize,
    places: (Place, Place),
    read_as: ReadAs,
}

/// The line that mends most of the records, where one does.
fn said(test: &ImpactTest, records: &[Named], found: &[Scaled]) -> Option<IdentifyError> {
    // Records that want the same factor are judged by what they say together.
    let together = |one: &Scaled| {
        let is_alike = |other: &&Scaled| {
            other.derivatives == one.derivatives && (other.scale.factor / one.scale.factor - 1.0).abs() < ALIKE
        };
        median(found.iter().filter(is_alike).map(|other| other.scale.factor))
    };
    let of_record = |(one, record): (&Scaled, &Named)| {
        let piece = test.pieces.get(record.piece)?;
        let of_mass = piece.doubt.mass_per_area / piece.piece.mass_per_area;
        let factor = Factor { value: together(one), derivatives: one.derivatives, std: one.std.hypot(of_mass) };
        mend(factor, record.read_as).filter(|_| one.is_explained())
    };
    let mends: Vec<Option<Mend>> = found.iter().zip(records).map(of_record).collect();
    let mends = if mends.iter().all(Option::is_none) { of_no_unit(records, found) } else { mends };
    let due = mends.iter().flatten().next()?;
    let wrong: Vec<usize> =
        (0..found.len()).filter(|&index| mends[index].as_ref().is_some_and(|other| other.is_same(due))).collect();
    let is_clear = found.iter().zip(&mends).all(|(one, mend)| one.is_as_read() || mend.is_some());
    if !is_clear && 2 * wrong.len() <= found.len() {
        return None;
    }
    let is_of_some = wrong.len() < found.len();
    let name = |&index: &usize| record_name(test, records[index].piece, records[index].places);
    let names = is_of_some.then(|| wrong.iter().map(name).collect());
    let numbers = is_of_some.then(|| wrong.iter().map(|index| index + 1).collect::<Vec<_>>());
    let is_plate = structures::of_test(test).shown() == Shown::InPart;
    let plate = test.pieces.get(records[wrong[0]].piece).filter(|_| is_plate).map(|piece| piece.piece.mass_per_area);
    let of_wrong = |value: fn(&Scaled) -> f64| median(wrong.iter().map(|&index| value(&found[index])));
    Some(IdentifyError::OtherUnits {
        lines: due.lines(&names, numbers.as_deref(), plate),
        records: names,
        factor: of_wrong(|one| one.scale.factor),
        derivatives: found[wrong[0]].derivatives,
        delay: found[wrong[0]].delay,
        percent: [of_wrong(|one| one.as_read), of_wrong(|one| one.scale.left)],
    })
}

/// The same from records that the factor found has put near the model: of what is far too strong or too weak noise hides other modes than
/// it should, and what is sampled late has other shapes.
fn once_more(test: &ImpactTest, readings: &[Reading], found: &[Scaled]) -> Vec<Scaled> {
    let by = median(found.iter().map(|one| one.scale.factor));
    let delay = found.first().map_or(0.0, |one| one.delay);
    let near: Vec<Reading> = readings
        .iter()
        .map(|Reading { derivatives, accelerances, .. }| {
            let of = |s: Complex64| by * (s * delay).exp();
            let records = accelerances.iter().map(|(piece, record)| (*piece, times(record, of))).collect();
            Reading::of(*derivatives, records)
        })
        .collect();
    let again = near.last().and_then(|last| scaled(&recorded_of(test, &last.accelerances).ok()?, &near));
    let Some(again) = again else { return found.to_vec() };
    let kept = |(one, again): (&Scaled, Scaled)| match again.scale.left < one.scale.left {
        true => {
            let scale = Scale { factor: by * again.scale.factor, ..again.scale };
            Scaled { scale, delay: delay + again.delay, as_read: one.as_read, ..again }
        }
        false => *one,
    };
    found.iter().zip(again).map(kept).collect()
}

/// A gain for all records, where one factor explains them that is no unit's; none where they differ, or where the sign differs too: modes that
/// are counted wrongly turn a record of two ends round.
fn of_no_unit(records: &[Named], found: &[Scaled]) -> Vec<Option<Mend>> {
    let value = median(found.iter().map(|one| one.scale.factor));
    let derivatives = found.first().map_or(0, |one| one.derivatives);
    let is_alike = |one: &Scaled| {
        one.derivatives == derivatives && one.is_explained() && (one.scale.factor / value - 1.0).abs() < ALIKE
    };
    let gain = records.first().filter(|_| value > 0.0 && found.iter().all(is_alike));
    vec![gain.and_then(|first| gain_of_no_unit(Factor { value, derivatives, std: 0.0 }, first.read_as)); found.len()]
}

/// All records as they are where they are another quantity, in the order of the test.
struct Reading {
    derivatives: i8,
    accelerances: Vec<(usize, Accelerance)>,
    records: Vec<PlaceRecord>,
}

impl Reading {
    fn of(derivatives: i8, accelerances: Vec<(usize, Accelerance)>) -> Self {
        let records = accelerances.par_iter().map(|(_, record)| PlaceRecord::of(record)).collect();
        Self { derivatives, accelerances, records }
    }
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
        let with_s = |(piece, record): &(usize, Accelerance)| match derivatives {
            0 => (*piece, record.clone()),
            _ => (*piece, times(record, |s| s.powi(i32::from(derivatives)))),
        };
        return Some(accelerances.iter().map(with_s).collect());
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
        *record = times(record, |_| read.response.into());
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
    let mut models: Vec<Option<Modelled>> = last.records.iter().map(|_| None).collect();
    let of_pieces =
        problem.pieces.iter().flat_map(|piece| piece.records.iter().map(move |record| (piece.piece, record)));
    for ((piece, record), lines) in of_pieces.zip(&lines) {
        let at = (0..models.len()).find(|&at| last.accelerances[at].0 == piece && models[at].is_none())?;
        let poles = recorded.pieces.iter().find(|of| of.index == piece).map_or(1, |of| of.poles.len().max(1));
        models[at] = Some(Modelled { frequency: &record.frequency, lines, poles });
    }
    scaled_beside(&models.into_iter().collect::<Option<Vec<_>>>()?, readings)
}

/// The lines of the model for one record.
struct Modelled<'a> {
    frequency: &'a [f64],
    lines: &'a [Complex64],
    /// Resonances of its piece.
    poles: usize,
}

/// The factor, the derivatives and the delay with which each record is nearest to its model.
fn scaled_beside(models: &[Modelled], readings: &[Reading]) -> Option<Vec<Scaled>> {
    let mut best: Vec<Option<Scaled>> = vec![None; models.len()];
    for reading in readings {
        let compared: Vec<Option<Compared>> = models
            .par_iter()
            .zip(&reading.records)
            .map(|(model, record)| Compared::of(record, model.frequency, model.lines))
            .collect();
        let Some(compared) = compared.into_iter().collect::<Option<Vec<_>>>() else { continue };
        let delay = common_delay(&compared);
        for ((best, of), model) in best.iter_mut().zip(&compared).zip(models) {
            let scale = of.scale(delay);
            // Each resonance has an error of its own, which the lines around it share.
            let std = 0.01 * scale.left / (model.poles as f64).sqrt();
            let derivatives = reading.derivatives;
            // Rules of integration agree at low frequencies alone.
            let scale = if derivatives == 0 { scale } else { Scale { factor: of.factor_below(PART, delay), ..scale } };
            let as_read = of.misfit_as_read(derivatives);
            // Another quantity has to be much nearer than the one that was read.
            if best.is_none_or(|known| scale.left < 0.5 * known.scale.left) {
                *best = Some(Scaled { derivatives, delay, scale, as_read, std });
            }
        }
    }
    best.into_iter().collect()
}

/// An accelerance times a function of $s$, with its noise.
fn times(record: &Accelerance, of: impl Fn(Complex64) -> Complex64) -> Accelerance {
    let mut taken = record.clone();
    let s = |frequency: &f64| Complex64::new(record.decay_rate, std::f64::consts::TAU * frequency);
    let factors: Vec<Complex64> = record.frequency.iter().map(|frequency| of(s(frequency))).collect();
    taken.value.iter_mut().zip(&factors).for_each(|(value, by)| *value *= by);
    if let Some(variance) = &mut taken.variance {
        variance.iter_mut().zip(&factors).for_each(|(variance, by)| *variance *= by.norm_sqr());
    }
    taken.force_noise = None;
    taken
}
