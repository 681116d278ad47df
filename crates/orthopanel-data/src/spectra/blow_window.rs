//! How much of the force's record holds its blow, and whether the noise of the rest counts.

use super::hit::Hit;

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
            // Power and number of the samples farther from the peak than so many, summed from the outermost inwards.
            let mut beyond = vec![(0.0, 0.0); blow.half + 1];
            for distance in (1..=blow.half).rev() {
                let both = [blow.at.checked_sub(distance), Some(blow.at + distance)].into_iter().flatten();
                let both = both.filter(|n| near.contains(n));
                beyond[distance - 1] =
                    both.fold(beyond[distance], |(power, count), n| (power + square(n), count + 1.0));
            }
            let outside = |(power, count): (f64, f64)| {
                // Noise scatters about its own power by the root of twice the samples.
                let of_noise = noise * (count + SURELY * f64::sqrt(2.0 * count));
                (f64::max(power - of_noise, 0.0) / whole).sqrt()
            };
            let needed = beyond.iter().position(|&cut| outside(cut) <= WHOLE).unwrap_or(blow.half);
            let cut = beyond.get(reach as usize).copied().unwrap_or_default();
            (all.lost, all.needed) = (all.lost.max(outside(cut)), all.needed.max(needed));
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

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    /// A half sine about the middle of the record.
    fn half_sine(samples: usize, width: usize) -> Hit {
        let from = (samples - width) / 2;
        let value = |n: usize| match n.checked_sub(from).filter(|&n| n < width) {
            Some(n) => (std::f64::consts::PI * n as f64 / width as f64).sin(),
            None => 0.0,
        };
        let force: Vec<f64> = (0..samples).map(value).collect();
        Hit { acceleration: force.clone(), force }
    }

    #[test]
    fn a_window_cuts_off_what_lies_beyond_it() {
        let hit = half_sine(1001, 201);
        // Of sin^2 from 0 to pi what lies farther than x from the middle is 1 - 2x/pi - sin(2x)/pi.
        let outside = |reach: f64| {
            let x = std::f64::consts::PI * (reach + 0.5) / 201.0;
            (1.0 - (2.0 * x + (2.0 * x).sin()) / std::f64::consts::PI).sqrt()
        };
        for reach in [10.0, 50.5, 90.0] {
            let found = CutBlow::of(&[&hit], reach);
            let expected = outside(reach.floor());
            assert!((found.lost - expected).abs() < 0.01 * expected, "{} {expected}", found.lost);
            let needed = (0..201).find(|&reach| outside(f64::from(reach)) <= WHOLE).unwrap_or_default();
            assert!(found.needed.abs_diff(needed as usize) <= 1, "{} {needed}", found.needed);
        }
        assert_eq!(CutBlow::of(&[&hit], 1e9).lost, 0.0);
    }

    #[test]
    fn a_push_that_lasts_the_record_takes_no_longer_than_a_blow() {
        let hit = half_sine(1_000_001, 800_001);
        let begun = Instant::now();
        assert!(CutBlow::of(&[&hit], 100.0).lost > 0.9);
        // Milliseconds; summed anew for every width it would be a quarter of an hour.
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
}
