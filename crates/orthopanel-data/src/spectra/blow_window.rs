//! How much of the force's record holds its blow, and whether the noise of the rest counts.

use super::time_history::Hit;

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
            let blow = hit.blow();
            let near = blow.near(hit.force.len());
            let noise = hit.noise_before(&blow).map_or(0.0, |noise| noise.force.powi(2));
            let square = |n: usize| (hit.force[n] - blow.offset).powi(2);
            let whole: f64 = near.clone().map(square).sum();
            let outside = |reach: f64| {
                let cut = near.clone().filter(|n| n.abs_diff(blow.at) as f64 > reach);
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

/// Part of $S_{ff}$ from which noise counts: $H_1$ is too low by it, and a fit of a few hits knows damping to a thousandth.
const COUNTS: f64 = 1e-4;

impl BlowWindow {
    pub(super) fn of(hits: &[&Hit]) -> Self {
        let mut all = Self { last: 0, half: 0, noise: Some(0.0) };
        let (mut noise, mut impulse) = (Some(0.0), 0.0);
        for hit in hits {
            let blow = hit.blow();
            let near = hit.force.get(blow.near(hit.force.len())).unwrap_or_default();
            let sum: f64 = near.iter().map(|force| force - blow.offset).sum();
            impulse += sum * sum;
            let own = hit.noise_before(&blow).map(|noise| noise.force.powi(2) * hit.force.len() as f64);
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
