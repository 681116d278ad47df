//! One hit of two records: units and direction put right, windows undone, motions differentiated, channels told apart.

use super::{
    channels::{self, Calibration, Quantity},
    derivative::derivative,
    extremes::{LANES, extremes, sampled_median},
    hit::Hit,
    misplaced_channel,
    read_as::ReadAs,
    window::milliseconds,
};
use crate::{
    DataError, Location, Motion, RecordedResponse,
    records::{Record, Samples},
};

/// A blow on a panel may be as short as this \[s\].
const SHORT_BLOW: f64 = 5e-4;

/// The two channels of a hit at a sampling rate \[Hz\].
pub(super) fn recorded_hit(
    (force, acceleration): (Record, Record),
    rate: f64,
    measurement: &RecordedResponse,
    notes: &mut Vec<String>,
) -> Result<(Hit, ReadAs), DataError> {
    let directions = [acceleration.response.direction, force.response.direction];
    let (to_newtons, of_force) = channels::force(&force, measurement, notes)?;
    let Calibration { factor, motion, unit } = channels::motion(&acceleration, measurement, directions, notes)?;
    let numbers = [force.number, acceleration.number];
    let are_told =
        [&force, &acceleration].iter().any(|record| channels::quantity(&record.numerator) != Quantity::Untold);
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
                 channels are swapped ({}), or this was no hammer{missed}",
                swapping_lines(numbers, are_told)
            );
            return Err(DataError::Channels { at: force_record, problem });
        }
    }
    Ok((hit, ReadAs { motion, response: unit, force: of_force, turned: factor < 0.0 }))
}

/// The lines that swap the records with the numbers of force and motion.
fn swapping_lines([force, motion]: [usize; 2], are_told: bool) -> String {
    // What the records tell of themselves is as wrong as what they are called.
    let units = if are_told { ", with quantity, response_unit and force_unit as the channels are" } else { "" };
    format!("declare force_channel = {motion} and response_channel = {force} in its [[measurement]]{units}")
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
