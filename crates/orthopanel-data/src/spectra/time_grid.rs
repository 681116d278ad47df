//! The even times of a hit: read off times that are printed with few digits, and refused where they are uneven.

use std::sync::Arc;

use orthopanel_model::Readable;

use super::extremes::median;
use crate::{
    DataError, Location, limits,
    records::{Record, round_rate},
};

/// Samples below which no spectrum is worth the name.
const LEAST_SAMPLES: usize = 16;

/// Part of a step within which times are even, whatever their digits.
const STEP_TOLERANCE: f64 = 0.1;

/// Part by which a step of times printed with few digits stays within the usual one, ...
const LEAP: f64 = 0.5;
/// ... and leaps that are faults of a record whose times else are even.
const LEAPS_AT_MOST: usize = 8;

/// Times that differ from a declared sampling rate by more than this part are told.
const RATE_TOLERANCE: f64 = 1e-3;

/// Samples and sampling rate \[Hz\] that the two records of a hit share; a `declared` rate counts instead of their times.
///
/// # Errors
/// [`DataError::Channels`] where lengths or times differ, where times are uneven, or make a rate that no hammer test has.
pub(super) fn common(
    force: &Record,
    motion: &Record,
    declared: Option<f64>,
    notes: &mut Vec<String>,
) -> Result<(usize, f64), DataError> {
    let (length, other) = (force.abscissa.len(), motion.abscissa.len());
    if length != other {
        let problem = format!("{other} samples of acceleration, {length} of force: must be as many");
        return refused(motion.at.clone(), problem);
    }
    if length < LEAST_SAMPLES {
        return refused(force.at.clone(), format!("{length} samples: at least {LEAST_SAMPLES} are needed"));
    }
    if let Some(rate) = declared {
        let span = force.abscissa.last().zip(force.abscissa.first()).map_or(0.0, |(last, first)| last - first);
        let told = (length - 1) as f64 / span;
        if (told / rate - 1.0).abs() > RATE_TOLERANCE || !told.is_finite() {
            let told = Readable(told);
            notes.push(format!(
                "{}: sampled at {rate} Hz, as the test file declares; its times say {told} Hz",
                force.at.key
            ));
        }
        return Ok((length, rate));
    }
    let grid = Grid::of(force, "force", notes)?;
    if !Arc::ptr_eq(&force.abscissa, &motion.abscissa) {
        grid.holds(motion)?;
    }
    let rate = 1.0 / grid.step;
    let [least, most] = limits::SAMPLING_RATE;
    if (least..=most).contains(&rate) {
        return Ok((length, rate));
    }
    let guess =
        [(1e3, "ms"), (1e6, "µs"), (1e-3, "s")].into_iter().find(|(factor, _)| LIKELY.contains(&(rate * factor)));
    let remedy = match guess {
        Some((factor, unit)) => format!(
            "are its times in {unit}? declare sampling_rate = {} in its [[measurement]]",
            Readable((rate * factor * 1e3).round() / 1e3)
        ),
        None => "times are in s; declare sampling_rate in its [[measurement]] where they are not".into(),
    };
    let problem =
        format!("sampled at {:.3} Hz, where hammer tests are at {least} to {most:e} Hz: {remedy}", Readable(rate));
    refused(force.at.clone(), problem)
}

/// Rates that hammer tests have \[Hz\].
const LIKELY: std::ops::RangeInclusive<f64> = 500.0..=1e6;

fn refused<T>(at: Box<Location>, problem: String) -> Result<T, DataError> {
    Err(DataError::Channels { at, problem })
}

/// Even times.
struct Grid {
    start: f64,
    step: f64,
    rounding: Rounding,
}

impl Grid {
    /// The grid that the times of a record stand on, or round.
    fn of(record: &Record, name: &str, notes: &mut Vec<String>) -> Result<Self, DataError> {
        let times = &record.abscissa;
        let span = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
        let step = span / (times.len() - 1) as f64;
        if let Some(fall) = times.windows(2).position(|pair| pair[1] < pair[0]) {
            let problem = format!(
                "{name}, sample {}: t = {} s follows {} s: the times begin anew, or rows are out of order; give each hit a file of its \
                 own, its rows in the order of time",
                fall + 2,
                Readable(times[fall + 1]),
                Readable(times[fall])
            );
            return refused(record.at_point(fall + 1), problem);
        }
        if !(step.is_finite() && step > 0.0 && (1.0 / step).is_finite()) {
            let problem = format!("a time step of {} s makes no sampling rate", Readable(step));
            return refused(record.at.clone(), problem);
        }
        let rounding = Rounding::of(times);
        let exact = Self { start: times[0], step, rounding };
        if exact.first_off(times, |_| ROUND_OFF * step).is_none() {
            return Ok(exact);
        }
        let Some(off) = exact.first_off(times, |_| STEP_TOLERANCE * step) else {
            return exact.restored(times, record, notes);
        };
        let printed = exact.fitted(times);
        if leap(times).is_none() && printed.first_off(times, |time| ROUNDED * rounding.quantum(time)).is_none() {
            return printed.restored(times, record, notes);
        }
        Err(exact.uneven(record, name, off))
    }

    fn due(&self, index: usize) -> f64 {
        self.start + self.step * index as f64
    }

    /// The first time that lies farther from the grid than is tolerated there.
    fn first_off(&self, times: &[f64], tolerance: impl Fn(f64) -> f64) -> Option<usize> {
        times.iter().enumerate().position(|(index, &time)| (time - self.due(index)).abs() > tolerance(time))
    }

    /// The grid of least squares through the times.
    fn fitted(&self, times: &[f64]) -> Self {
        let middle = (times.len() - 1) as f64 / 2.0;
        let (mut along, mut squares, mut sum) = (0.0, 0.0, 0.0);
        for (index, time) in times.iter().enumerate() {
            let (n, off) = (index as f64 - middle, time - self.due(index));
            along += n * off;
            squares += n * n;
            sum += off;
        }
        let step = self.step + along / squares;
        let mean = sum / times.len() as f64 + self.due(0) + self.step * middle;
        Self { start: mean - step * middle, step, ..*self }
    }

    /// With the round sampling rate that the printed times hide, where there is one; said where it moves a line.
    fn restored(self, times: &[f64], record: &Record, notes: &mut Vec<String>) -> Result<Self, DataError> {
        let last = times.last().copied().unwrap_or_default();
        let quantum = self.rounding.quantum(last);
        let fitted = self.fitted(times);
        // Errors of rounding are spread evenly over a quantum; the step of least squares is off by 1/N^1.5 of it, rms.
        let doubt = FAR * quantum / (times.len() as f64).powf(1.5);
        let rate = round_rate(1.0 / (fitted.step + doubt), 1.0 / (fitted.step - doubt));
        if doubt > MOST_DOUBT * fitted.step {
            let problem = format!(
                "the times are rounded to {} s, and so few tell the sampling rate to {:.1} % only: export them with more digits, or declare \
                 it, such as sampling_rate = {}, in its [[measurement]]",
                Readable(quantum),
                Readable(100.0 * doubt / fitted.step),
                Readable(rate.unwrap_or((1.0 / fitted.step).round()))
            );
            return refused(record.at.clone(), problem);
        }
        let step = rate.map_or(fitted.step, |rate| 1.0 / rate);
        if quantum > STEP_TOLERANCE * step {
            notes.push(format!(
                "{}: the times are rounded to {} s; read on the even times that they round, at {} Hz",
                record.at.key,
                Readable(quantum),
                Readable(1.0 / step)
            ));
        }
        Ok(Self { step, ..fitted })
    }

    /// Refuses a motion that stands at other times than the force.
    fn holds(&self, motion: &Record) -> Result<(), DataError> {
        let own = Rounding::of(&motion.abscissa);
        let tolerance = |time: f64| (STEP_TOLERANCE * self.step).max(own.quantum(time) + self.rounding.quantum(time));
        match self.first_off(&motion.abscissa, tolerance) {
            None => Ok(()),
            Some(off) => Err(self.uneven(motion, "acceleration", off)),
        }
    }

    fn uneven(&self, record: &Record, name: &str, off: usize) -> DataError {
        let times = &record.abscissa;
        let (index, found) = match leap(times) {
            Some((index, ratio)) => (
                index,
                format!(
                    "{ratio:.3} times the usual step after the one before: samples are missing or stand twice; force and acceleration need \
                     the same even times; record again, or where no sample is missing declare sampling_rate"
                ),
            ),
            None => (
                off,
                format!(
                    "t = {} s, {} s expected: force and acceleration need the same even times; export them as they were sampled, or \
                     resample both onto even times; where the column of times alone is wrong declare sampling_rate in the [[measurement]]",
                    Readable(times[off]),
                    Readable(self.due(off))
                ),
            ),
        };
        DataError::Channels { at: record.at_point(index), problem: format!("{name}, sample {}: {found}", index + 1) }
    }
}

/// Quanta that a rounded time lies from its own, at most; half of one, and a last digit.
const ROUNDED: f64 = 0.75;
/// Part of a step that times printed in full are off their grid.
const ROUND_OFF: f64 = 1e-6;
/// Part of a step by which rounded times may leave it open: a frequency is told no better.
const MOST_DOUBT: f64 = 2e-4;
/// Standard deviations beyond which the true step is not sought.
const FAR: f64 = 6.0;

/// The first sample that does not follow the one before after the usual step, where nearly all do, and its step over the usual one.
fn leap(times: &[f64]) -> Option<(usize, f64)> {
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(steps.clone());
    let is_leap = |step: &f64| (step / usual - 1.0).abs() > LEAP;
    let first = steps.iter().position(is_leap)?;
    let few = LEAPS_AT_MOST.max(steps.len() / 1000);
    (usual > 0.0 && steps.iter().filter(|step| is_leap(step)).count() <= few).then(|| (first + 1, steps[first] / usual))
}

/// To how many digits times are printed.
#[derive(Clone, Copy)]
struct Rounding {
    /// Of their decimals the last.
    last_decimal: f64,
    /// Significant digits.
    digits: i32,
    /// True where single precision holds them.
    single: bool,
}

/// Times whose digits are counted.
const COUNTED: usize = 1000;

/// Digits of single precision, printed in full.
const SINGLE_DIGITS: i32 = 9;

impl Rounding {
    fn of(times: &[f64]) -> Self {
        // Counted at places that share no period with the decimals.
        let stride = (times.len() / COUNTED).max(1) | 1;
        let (mut decimals, mut digits, mut single) = (0, 1, true);
        for &time in times.iter().step_by(stride) {
            let text = format!("{time:e}");
            let Some((mantissa, exponent)) = text.split_once('e') else { continue };
            let count = mantissa.bytes().filter(u8::is_ascii_digit).count() as i32;
            digits = digits.max(count);
            decimals = decimals.max(count - 1 - exponent.parse::<i32>().unwrap_or(0));
            single &= f64::from(time as f32) == time;
        }
        Self { last_decimal: 10f64.powi(-decimals), digits, single: single || digits <= SINGLE_DIGITS }
    }

    /// What a last digit of a time stands for: of fixed decimals, or of so many digits.
    fn quantum(&self, time: f64) -> f64 {
        let size = time.abs();
        let of_digits = if size > 0.0 { 10f64.powi(size.log10().floor() as i32 - self.digits + 1) } else { 0.0 };
        let of_single = if self.single { size * f64::from(f32::EPSILON) } else { 0.0 };
        self.last_decimal.max(of_digits).max(of_single)
    }
}
