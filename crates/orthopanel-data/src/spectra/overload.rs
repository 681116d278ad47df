//! A channel cut off at the end of its range: flat tops, and crests that meet at the very same value.

use std::collections::HashMap;

use super::{
    extremes::{Levels, extremes, sampled_median},
    hit::Hit,
    hit_faults::{Channel, HitFault},
};

/// Samples in a row at the extreme that are clipped, unless they hardly drop beside them.
const FLAT_RUN: usize = 8;

/// That drop, in steps of the converter: a smooth crest of so many samples drops by two, noise adds one.
const FLAT_DROP: f64 = 3.5;

/// Samples in a row at the extreme that are clipped where the signal drops steeply beside them.
const CLIPPED_RUN: usize = 3;

/// That drop, in steps of the converter. A smooth crest whose two middle samples share a code drops by 9 steps at most
/// beside them, one of three by 4.
const CLIPPED_DROP: f64 = 12.0;

/// That drop, in steps of the converter, beside two equal samples: of a free crest they are equal with a chance of one
/// over it.
const PAIR_DROP: f64 = 5000.0;

/// Difference of its two neighbours, as a part of its reach, below which a crest is that of a computed blow.
const EVEN: f64 = 1e-9;

/// How far the flanks of a pulse must point over two equal top samples, as a part of its reach; a smooth pulse is
/// rounder than a parabola, so its flanks point below its top.
const OVERSHOOT: f64 = 0.01;

/// Nearest samples below the extreme are counted within this part of the signal's reach, and ...
const NEAR: f64 = 1e-3;

/// ... within as many steps of the converter.
const NEAR_STEPS: f64 = 64.0;

/// Chance at which crests that meet at one value are taken for clipped: a test has some hundred channels.
const CHANCE: f64 = 1e-4;

/// The overload of one channel of a hit.
pub(super) fn overload(channel: Channel, values: &[f64], levels: Levels) -> Option<HitFault> {
    levels.far().filter_map(|extreme| Touches::of(values, extreme)).find_map(|touches| {
        let samples = touches.clipped(channel, values, levels.reach())?;
        Some(HitFault::Overload { channel, first: touches.first(), samples, value: touches.extreme })
    })
}

/// Where the samples of a channel stand exactly on one of its extremes.
struct Touches {
    extreme: f64,
    /// First sample and length of each run.
    runs: Vec<(usize, usize)>,
}

impl Touches {
    /// `None` for a crest that is met once, as nearly all are.
    fn of(values: &[f64], extreme: f64) -> Option<Self> {
        // Counted first, in one pass without branches.
        if values.iter().filter(|&&value| value == extreme).count() < 2 {
            return None;
        }
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for (n, _) in values.iter().enumerate().filter(|(_, value)| **value == extreme) {
            match runs.last_mut() {
                Some((start, length)) if *start + *length == n => *length += 1,
                _ => runs.push((n, 1)),
            }
        }
        Some(Self { extreme, runs })
    }

    /// The first sample on the extreme, from 1.
    fn first(&self) -> usize {
        self.runs.first().map_or(0, |(start, _)| start + 1)
    }

    fn samples(&self) -> usize {
        self.runs.iter().map(|(_, length)| length).sum()
    }

    /// Samples on the extreme where they cannot be there by chance.
    fn clipped(&self, channel: Channel, values: &[f64], reach: f64) -> Option<usize> {
        let step = converter_step(values);
        let top_step = step.max(printed_step(values, self.extreme));
        let flat = self.runs.iter().any(|&(start, length)| {
            let beside = [start.checked_sub(1), Some(start + length)].map(|n| n.and_then(|n| values.get(n).copied()));
            let drops = || beside.into_iter().flatten().map(|next| (self.extreme - next).abs());
            let (drop, least) = (drops().fold(0.0, f64::max), drops().fold(f64::INFINITY, f64::min));
            (length >= FLAT_RUN && drop > FLAT_DROP * step)
                || (length >= CLIPPED_RUN && drop > CLIPPED_DROP * step)
                || (length == 2 && least > PAIR_DROP * top_step && uneven(&beside, reach))
                // A response may turn within two samples, a blow's flanks tell where its top would have been.
                || (length == 2 && channel == Channel::Force && self.flanks_point_over(values, start, reach))
        });
        (flat || self.meet_too_often(values, reach, step)).then(|| self.samples())
    }

    /// True where a parabola through the two samples on either side of two equal ones has its top well over these.
    fn flanks_point_over(&self, values: &[f64], start: usize, reach: f64) -> bool {
        let Some(&[outer_left, left, _, _, right, outer_right]) =
            start.checked_sub(2).and_then(|from| values.get(from..from + 6))
        else {
            return false;
        };
        // Even about the middle, samples at 3/2 and 5/2 steps: a + b t^2 at 1/2.
        let (inner, outer) = (left.midpoint(right), outer_left.midpoint(outer_right));
        let expected = inner + 0.5 * (inner - outer);
        let upwards = (self.extreme - inner).signum();
        upwards * (expected - self.extreme) > OVERSHOOT * reach
    }

    /// True where free crests would hardly meet at one value this often.
    ///
    /// Of a crest's samples, a part $\sqrt{q/w}$ of those within $w$ of its top lies on the converter's top step $q$
    /// (a parabola's share); the number of further crests on that step is Poisson's.
    fn meet_too_often(&self, values: &[f64], reach: f64, step: f64) -> bool {
        let width = (NEAR * reach).max(NEAR_STEPS * step);
        let near =
            values.iter().filter(|&&value| value != self.extreme && (value - self.extreme).abs() < width).count();
        let mean = (near + 1) as f64 * (step / width).sqrt();
        let chance: f64 = (1..self.runs.len()).map(|count| mean / count as f64).product();
        self.runs.len() > 1 && chance < CHANCE
    }
}

/// False where both neighbours of a flat top are alike too: a computed blow, even about its middle.
fn uneven(beside: &[Option<f64>; 2], reach: f64) -> bool {
    !matches!(beside, [Some(left), Some(right)] if (left - right).abs() < EVEN * reach)
}

/// The least difference between two unequal samples: the converter's step where the signal is long and lively.
pub(super) fn converter_step(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let gaps = sorted.windows(2).filter_map(|pair| if let [a, b] = pair { Some(b - a) } else { None });
    gaps.filter(|&gap| gap > 0.0).fold(f64::INFINITY, f64::min)
}

/// The step at `top` of values printed with a few digits, which is greater there than near zero; zero for binary ones.
fn printed_step(values: &[f64], top: f64) -> f64 {
    let stride = (values.len() / 1000).max(1);
    let printed = values.iter().step_by(stride).map(|value| {
        let text = format!("{:e}", value.abs());
        text.split('e').next().map_or(0, |mantissa| mantissa.bytes().filter(u8::is_ascii_digit).count())
    });
    // A number of single precision has nine digits at most: whatever has fewer was printed.
    match printed.max() {
        // Zero has no decade.
        Some(digits @ 1..9) if top != 0.0 => 10f64.powi(top.abs().log10().floor() as i32 + 1 - digits as i32),
        _ => 0.0,
    }
}

/// Part of their height by which hits of one hand differ at least.
const HITS_DIFFER: f64 = 0.02;

/// Hits whose extreme is exactly that of others, by index: hits differ in strength, so the range was at its end.
///
/// Three hits, two with four samples on the extreme, or two of a converter so fine that their tops would hardly meet
/// ([`PAIR_DROP`]) are taken for clipped: with 12 bits, five free hits that differ by a fifth do the first once in some
/// ten thousand tests. Channels whose tops are alike sample by sample count once: one hit read twice, or a computed blow.
pub(super) fn shared_extremes(hits: &[Hit]) -> Vec<(usize, HitFault)> {
    let mut found = Vec::new();
    for (channel, values) in [(Channel::Force, force as fn(&Hit) -> &[f64]), (Channel::Acceleration, acceleration)] {
        let tops: Vec<f64> = hits.iter().map(|hit| farthest(values(hit))).collect();
        let mut alike: HashMap<u64, Vec<&[f64]>> = HashMap::new();
        for (hit, &top) in hits.iter().zip(&tops) {
            alike.entry(key(top)).or_default().push(values(hit));
        }
        let shared = alike.into_iter().filter(|(_, channels)| channels.len() > 1);
        let shared: HashMap<u64, SharedTop> =
            shared.map(|(top, channels)| (top, SharedTop::of(&channels, f64::from_bits(top)))).collect();
        for (index, (hit, &value)) in hits.iter().zip(&tops).enumerate() {
            let values = values(hit);
            if shared.get(&key(value)).is_some_and(|shared| shared.is_clipped(value - sampled_median(values))) {
                let first = values.iter().position(|&sample| sample == value).map_or(0, |at| at + 1);
                found.push((index, HitFault::Overload { channel, first, samples: count(values, value), value }));
            }
        }
    }
    found
}

/// The bits of a number, of both zeros the same.
fn key(number: f64) -> u64 {
    (number + 0.0).to_bits()
}

/// An extreme that channels of several hits have.
struct SharedTop {
    /// Channels that differ about it.
    channels: usize,
    /// Their samples on it.
    samples: usize,
    /// The coarsest converter's step among them; zero where there are not two.
    step: f64,
}

impl SharedTop {
    fn of(channels: &[&[f64]], top: f64) -> Self {
        // Each with what stands about its top, found once: there may be thousands of hits.
        let mut sharing: Vec<(&[f64], &[f64])> = Vec::new();
        for values in channels {
            let about = about(values, top);
            if !sharing.iter().any(|(other, _)| *other == about) {
                sharing.push((about, values));
            }
        }
        let step = |values: &[f64]| converter_step(values).max(printed_step(values, top));
        let step = if let [(_, one), (_, other)] = sharing[..] { step(one).max(step(other)) } else { 0.0 };
        let samples = sharing.iter().map(|(_, values)| count(values, top)).sum();
        Self { channels: sharing.len(), samples, step }
    }

    /// Whether a channel that reaches so far from its middle is clipped there.
    fn is_clipped(&self, reach: f64) -> bool {
        let fine = || HITS_DIFFER * reach.abs() > PAIR_DROP * self.step;
        self.channels >= 3 || (self.channels == 2 && (self.samples >= 4 || fine()))
    }
}

/// Samples at `top`.
fn count(values: &[f64], top: f64) -> usize {
    values.iter().filter(|&&sample| sample == top).count()
}

/// The samples about the first one at `top`.
fn about(values: &[f64], top: f64) -> &[f64] {
    let at = values.iter().position(|&value| value == top).unwrap_or(0);
    values.get(at.saturating_sub(2)..values.len().min(at + 3)).unwrap_or_default()
}

fn force(hit: &Hit) -> &[f64] {
    &hit.force
}

fn acceleration(hit: &Hit) -> &[f64] {
    &hit.acceleration
}

/// The extreme that lies farther from the channel's middle.
fn farthest(values: &[f64]) -> f64 {
    let [least, greatest] = extremes(values);
    let middle = sampled_median(values);
    if middle - least > greatest - middle { least } else { greatest }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    #[test]
    fn zero_is_printed_in_no_steps() {
        assert_eq!(printed_step(&[-2.5, 0.0], 0.0), 0.0);
        assert_eq!(printed_step(&[-2.5, 0.0], -2.5), 0.1);
    }

    #[test]
    fn thousands_of_hits_cut_off_at_one_value_take_no_long_time() {
        let hit = |n: usize| {
            let force: Vec<f64> =
                (0..1000).map(|at| if at == 500 { 1.0 } else { ((at * n) as f64).sin() / 2.0 }).collect();
            Hit { acceleration: force.clone(), force }
        };
        let hits: Vec<Hit> = (1..=2000).map(hit).collect();
        let begun = Instant::now();
        assert_eq!(shared_extremes(&hits).len(), 4000);
        // Milliseconds; each hit held against all pairs of others would take hours.
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
}
