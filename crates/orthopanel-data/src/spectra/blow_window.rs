//! How much of the force's record holds its blow, and whether the noise of the rest counts.

use std::ops::Range;

use super::{
    channel_noise::{AHEAD, TOUCH},
    extremes::{peak, sampled_median},
    time_history::Hit,
};

/// What a force window cuts off the blows.
pub(super) struct CutBlow {
    /// Root of the part of $\sum f^2$ outside the window, less what noise makes of it, of the hit that loses most \[1\].
    pub(super) lost: f64,
    /// Samples on either side of the peak that are to be kept, so that no blow loses more than [`WHOLE`].
    pub(super) needed: usize,
}

/// Part of a blow, rms, whose loss goes unsaid.
pub(super) const WHOLE: f64 = 0.005;

impl CutBlow {
    /// Of hits under a window of `reach` samples on either side of the peak.
    pub(super) fn of(hits: &[&Hit], reach: f64) -> Self {
        let mut all = Self { lost: 0.0, needed: 0 };
        for hit in hits {
            let blow = Blow::of(hit);
            let noise = blow.noise.unwrap_or(0.0);
            let square = |n: usize| (hit.force[n] - blow.offset).powi(2);
            let whole: f64 = blow.near.clone().map(square).sum();
            let outside = |reach: f64| {
                let cut = blow.near.clone().filter(|n| n.abs_diff(blow.at) as f64 > reach);
                // Noise scatters about its own power by the root of twice the samples.
                let (power, count) = cut.fold((0.0, 0.0), |(power, count), n| (power + square(n), count + 1.0));
                let of_noise = noise * (count + SURELY * f64::sqrt(2.0 * count));
                (f64::max(power - of_noise, 0.0) / whole).sqrt()
            };
            let needed = (0..blow.half).find(|&reach| outside(reach as f64) <= WHOLE).unwrap_or(blow.half);
            (all.lost, all.needed) = (all.lost.max(outside(reach)), all.needed.max(needed));
        }
        all
    }
}

/// Standard deviations that noise may stand above its usual power.
const SURELY: f64 = 3.0;

/// Where the blow of a hit lies in its record.
struct Blow {
    /// The hammer's force where it touches nothing.
    offset: f64,
    /// Sample of the peak.
    at: usize,
    /// Samples on either side of the peak that hold the blow and what a filter makes of it.
    half: usize,
    /// All of these that the record has.
    near: Range<usize>,
    /// Variance of the force's noise, where the record tells it.
    noise: Option<f64>,
}

impl Blow {
    fn of(hit: &Hit) -> Self {
        let offset = sampled_median(&hit.force);
        let (at, height) = peak(&hit.force, offset);
        let touches = |force: &&f64| (**force - offset) * height.signum() > TOUCH * height.abs();
        let (before, after) = hit.force.split_at(at);
        let length = before.iter().rev().take_while(touches).count() + after.iter().take_while(touches).count();
        let half = LENGTHS * length + AHEAD;
        let near = at.saturating_sub(half)..(at + half + 1).min(hit.force.len());
        let noise = hit.noise_before(offset, (at, height)).map(|noise| noise.force.powi(2));
        Self { offset, at, half, near, noise }
    }
}

/// Blow and noise of the hits of a place.
pub(super) struct BlowWindow {
    /// Where the last of all blows peaks.
    pub(super) last: usize,
    /// Samples on either side of the peak that hold the longest of the blows.
    half: usize,
    /// $N\sigma^2/(\sum f)^2$: what the noise of the whole record adds to $S_{ff}$ at its strongest, over that; `None` where a
    /// hit does not tell its noise.
    noise: Option<f64>,
}

/// The blow's own lengths that are kept on either side.
const LENGTHS: usize = 2;

/// Part of $S_{ff}$ from which noise counts: $H_1$ is too low by it, and a fit of a few hits knows damping to a thousandth.
const COUNTS: f64 = 1e-4;

impl BlowWindow {
    pub(super) fn of(hits: &[&Hit]) -> Self {
        let mut all = Self { last: 0, half: 0, noise: Some(0.0) };
        let (mut noise, mut impulse) = (Some(0.0), 0.0);
        for hit in hits {
            let blow = Blow::of(hit);
            let near = hit.force.get(blow.near).unwrap_or_default();
            let sum: f64 = near.iter().map(|force| force - blow.offset).sum();
            impulse += sum * sum;
            let own = blow.noise.map(|noise| noise * hit.force.len() as f64);
            noise = noise.zip(own).map(|(sum, own)| sum + own);
            (all.last, all.half) = (all.last.max(blow.at), all.half.max(blow.half));
        }
        all.noise = noise.map(|noise: f64| noise / impulse);
        all
    }

    /// Samples on either side of the peak that are to be kept; `None` where the noise of the rest counts for nothing, or
    /// is not told.
    pub(super) fn needed(&self) -> Option<usize> {
        self.noise.is_some_and(|noise| noise > COUNTS).then_some(self.half)
    }
}
