//! How fast the noise of hits dies away: under an exponential window it does, and by itself it stays.

use std::f64::consts::FRAC_PI_2;

use orthopanel_data::{TimeHistory, Transforms};
use rayon::prelude::*;

use super::hits::FLAT;

/// Part of a record at each end that is faded in and out, or its ends' jump would be heard in all of it.
const FADED: f64 = 0.1;
/// Part of a record in which its noise is looked at: what the blow shook above the band has died away by then.
const LOOKED_AT: [f64; 2] = [0.4, 0.85];
/// Pieces of that part.
const PIECES: usize = 16;
/// Passes: what a fast decay leaves of the blow in the noise falls with what is undone already.
const PASSES: usize = 4;
/// A decay stands out of its own standard deviation by so many times, as it would by chance once in three million.
const CLEARLY: f64 = 5.0;

/// Decay rate \[1/s\] that the noise above the band has in all hits, zero where none is clear.
///
/// The variance of noise under $e^{-\sigma t}$ falls as $e^{-2\sigma t}$; $\sigma$ is half the slope of its logarithm, the mean over hits.
/// A decay by less than half over a record spreads its noise over no more than a line: it is left as it is.
pub(super) fn decay_of_noise(histories: &[TimeHistory]) -> f64 {
    let mut sigma = 0.0;
    for _ in 0..PASSES {
        let hits = histories.iter().flat_map(|history| history.hits.iter().map(|hit| (hit, history.rate)));
        let decays: Vec<f64> =
            hits.par_bridge().map(|(hit, rate)| decay_above(&hit.acceleration, rate, sigma)).collect();
        let count = decays.len() as f64;
        let mean = decays.iter().sum::<f64>() / count;
        let variance = decays.iter().map(|decay| (decay - mean).powi(2)).sum::<f64>() / (count * (count - 1.0));
        let longest = |history: &TimeHistory| {
            history.hits.iter().map(|hit| hit.force.len()).max().unwrap_or(0) as f64 / history.rate
        };
        let duration = histories.iter().map(longest).fold(0.0, f64::max);
        let is_clear = (sigma + mean) * duration > std::f64::consts::LN_2 && sigma + mean > CLEARLY * variance.sqrt();
        if !is_clear {
            return 0.0;
        }
        sigma += mean;
    }
    sigma
}

/// The hits as they were before a window $e^{-\sigma t}$ from the record's start.
pub(super) fn undone(histories: &[TimeHistory], sigma: f64) -> Vec<TimeHistory> {
    let mut histories = histories.to_vec();
    for history in &mut histories {
        for channel in history.hits.iter_mut().flat_map(|hit| [&mut hit.force, &mut hit.acceleration]) {
            grow(channel, sigma / history.rate);
        }
    }
    histories
}

fn grow(channel: &mut [f64], by_step: f64) {
    channel.iter_mut().enumerate().for_each(|(n, value)| *value *= (by_step * n as f64).exp());
}

/// Decay rate of what lies above the band, once a decay `sigma` is undone.
fn decay_above(motion: &[f64], rate: f64, sigma: f64) -> f64 {
    let samples = motion.len();
    let mut motion = motion.to_vec();
    grow(&mut motion, sigma / rate);
    let end = (FADED * samples as f64).max(1.0);
    for (n, value) in motion.iter_mut().enumerate() {
        let from_end = n.min(samples - 1 - n) as f64 / end;
        *value *= (FRAC_PI_2 * from_end.min(1.0)).sin().powi(2);
    }
    let mut transforms = Transforms::default();
    let mut spectrum = transforms.lines(motion);
    let lowest = (FLAT * samples as f64) as usize;
    spectrum.iter_mut().take(lowest).for_each(|line| *line = 0.0.into());
    let motion = transforms.samples(spectrum, samples);
    let place = |part: f64| (part * samples as f64) as usize;
    let length = (place(LOOKED_AT[1]) - place(LOOKED_AT[0])) / PIECES;
    let mut slope = [0.0, 0.0];
    for piece in 0..PIECES {
        let from = place(LOOKED_AT[0]) + piece * length;
        let square: f64 = motion.iter().skip(from).take(length).map(|value| value * value).sum();
        let time = (piece as f64 - 0.5 * (PIECES - 1) as f64) * length as f64 / rate;
        slope[0] += time * square.max(f64::MIN_POSITIVE).ln();
        slope[1] += time * time;
    }
    if slope[1] > 0.0 { -0.5 * slope[0] / slope[1] } else { 0.0 }
}
