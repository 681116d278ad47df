//! The hammer's blow in its channel: where it lies, how long it pushes, how far it stands out, and whether it touches again.

use std::ops::Range;

use super::{
    extremes::{Levels, median, peak, peak_among, sampled_median},
    hit::Hit,
    hit_faults::{HitFault, LEAST_SIGNAL_TO_NOISE},
};

/// Force that counts as a touch, over the peak: less does not change the spectrum by more than this.
const TOUCH: f64 = 0.05;

/// Samples before a blow that an anti-alias filter may ring ahead.
const AHEAD: usize = 32;

/// The blow's own lengths, on either side of its peak, that hold it and what a filter makes of it.
const LENGTHS: usize = 2;

/// Standard deviations of the channel's noise that a touch must pass: of a million samples of noise, not one in fifty does.
const ABOVE_NOISE: f64 = 5.5;

/// Push over the peak that a force window may cut off unsaid.
const LEAST_PUSH: f64 = 0.002;

/// Next to the pulse, within three times its length, up to this the anti-alias filter rings.
const FILTER_RINGING: f64 = 0.2;

/// Samples that a pulse lasts at most where the sampling rate decides its shape: a band-limited pulse is no shorter.
const SHORTEST_PULSE: usize = 4;

/// Samples below a touch in a row after which a filter has rung out.
const RUNG_OUT: usize = 8;

/// Samples in a row that push: from, to (not with it), and the highest.
type Run = (usize, usize, f64);

/// Runs of pushes above a threshold.
fn runs(pushes: impl Iterator<Item = f64>, threshold: f64) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (n, value) in pushes.enumerate() {
        if value <= threshold {
            continue;
        }
        match runs.last_mut() {
            Some((_, to, top)) if *to == n => (*to, *top) = (n + 1, top.max(value)),
            _ => runs.push((n, n + 1, value)),
        }
    }
    runs
}

/// Where the blow of a hit lies in its record.
pub(super) struct Blow {
    /// What the hammer's channel shows where it touches nothing \[N\].
    pub(super) offset: f64,
    /// Sample of the peak.
    pub(super) at: usize,
    /// The peak, over the offset \[N\].
    pub(super) height: f64,
    /// Samples before the first touch, and before what a filter rings ahead of it: there neither hammer nor piece moves. `None`
    /// where the record begins later.
    pub(super) quiet: Option<usize>,
    /// Samples on either side of the peak that hold the blow and what a filter makes of it.
    pub(super) half: usize,
}

impl Blow {
    /// All samples within [`Blow::half`] that a record of this length has.
    pub(super) fn near(&self, length: usize) -> Range<usize> {
        self.at.saturating_sub(self.half)..(self.at + self.half + 1).min(length)
    }
}

impl Hit {
    /// Where its blow lies.
    pub(super) fn blow(&self) -> Blow {
        let offset = sampled_median(&self.force);
        let (at, height) = peak(&self.force, offset);
        let touches = |force: &&f64| (**force - offset) * height.signum() > TOUCH * height.abs();
        let (before, after) = self.force.split_at(at);
        let foot = before.iter().rev().take_while(touches).count();
        let length = foot + after.iter().take_while(touches).count();
        Blow { offset, at, height, quiet: at.checked_sub(foot + AHEAD), half: LENGTHS * length + AHEAD }
    }

    /// The greatest push farther than `reach` samples from the blow's peak that is no noise, nor what a filter makes of the blow: how
    /// many samples after the peak it lies, and its height over the blow's. `None` without one, and where the record does not
    /// tell its noise.
    pub(super) fn push_beyond(&self, reach: f64) -> Option<(f64, f64)> {
        let blow = self.blow();
        let noise = self.noise_before(&blow)?.force / blow.height.abs();
        let near = blow.near(self.force.len());
        let beyond = |n: &usize| !near.contains(n) && n.abs_diff(blow.at) as f64 > reach;
        let push = |n: usize| (n as f64 - blow.at as f64, (self.force[n] - blow.offset) / blow.height);
        let pushes = (0..self.force.len()).filter(beyond).map(push);
        pushes.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, ratio)| *ratio > (ABOVE_NOISE * noise).max(LEAST_PUSH))
    }

    /// How often the force stands above a touch and above its noise before the blow.
    pub(super) fn pushes(&self) -> usize {
        let blow = self.blow();
        let noise = self.noise_before(&blow).map_or(0.0, |noise| noise.force);
        let threshold = (TOUCH * blow.height.abs()).max(ABOVE_NOISE * noise);
        runs(self.force.iter().map(|value| blow.height.signum() * (value - blow.offset)), threshold).len()
    }
}

/// A second touch, a force that is too weak, or a blow too short for the rate \[Hz\].
pub(super) fn force_fault(force: &[f64], Levels { extremes, middle: offset }: Levels, rate: f64) -> Option<HitFault> {
    let (peak, height) = peak_among(force, offset, extremes);
    let sign = height.signum();
    let push = |value: f64| sign * (value - offset);
    let threshold = TOUCH * height.abs();
    let runs = runs(force.iter().map(|&value| push(value)), threshold);
    let &(from, to, _) = runs.iter().find(|(from, to, _)| (*from..*to).contains(&peak))?;
    let near = 3 * (to - from);
    let before = force.get(..from.saturating_sub(near)).unwrap_or_default();
    let after = force.get(to + near..).unwrap_or_default();
    let stride = ((before.len() + after.len()) / 1000).max(1);
    let quiet = before.iter().chain(after).step_by(stride).map(|&value| push(value).abs()).collect();
    // The median of |noise| is 0.6745 standard deviations; second touches hardly move it.
    let noise = median(quiet) / 0.674_49;
    let signal_to_noise = height.abs() / noise;
    if noise > 0.0 && signal_to_noise < LEAST_SIGNAL_TO_NOISE {
        return Some(HitFault::WeakForce { signal_to_noise });
    }
    let stands_out = |run: &&Run| run.0 != from && run.2 > ABOVE_NOISE * noise;
    let second = runs.iter().filter(stands_out).find(|&&(other_from, other_to, top)| {
        let gap = if other_from >= to { other_from - to } else { from.saturating_sub(other_to) };
        gap > near || top > FILTER_RINGING * height.abs()
    });
    let &(other, _, top) = second?;
    // A hammer only pushes, a filter swings both ways and does not pause. Pulls all the way from the pulse to what looks
    // like a second touch of a pulse this short tell the filter's ringing.
    let between = force.get(from.min(other)..to.max(other)).unwrap_or_default();
    let pulls = between.iter().any(|&value| push(value) < -threshold);
    let pauses = between.windows(RUNG_OUT).any(|samples| samples.iter().all(|&value| push(value).abs() <= threshold));
    Some(match to - from {
        samples if samples <= SHORTEST_PULSE && pulls && !pauses => HitFault::RateTooLow { samples, rate },
        _ => HitFault::DoubleHit { after: (other as f64 - from as f64) / rate, ratio: top / height.abs() },
    })
}
