//! A channel cut off at the end of its range: flat tops, and crests that meet at the very same value.

use super::{
    extremes::{extremes, sampled_median},
    hit_faults::{Channel, HitFault},
    time_history::Hit,
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
pub(super) fn overload(channel: Channel, values: &[f64]) -> Option<HitFault> {
    let [least, greatest] = extremes(values);
    let middle = sampled_median(values);
    let reach = (greatest - middle).max(middle - least);
    // A quiet side rests on its last bit; a clipped one stands far from the middle.
    let far = [greatest, least].into_iter().filter(|extreme| (extreme - middle).abs() > 0.5 * reach);
    far.filter_map(|extreme| Touches::of(values, extreme)).find_map(|touches| {
        let samples = touches.clipped(channel, values, reach)?;
        Some(HitFault::Overload { channel, samples, value: touches.extreme })
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
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for (n, _) in values.iter().enumerate().filter(|(_, value)| **value == extreme) {
            match runs.last_mut() {
                Some((start, length)) if *start + *length == n => *length += 1,
                _ => runs.push((n, 1)),
            }
        }
        let touches = Self { extreme, runs };
        (touches.samples() > 1).then_some(touches)
    }

    fn samples(&self) -> usize {
        self.runs.iter().map(|(_, length)| length).sum()
    }

    /// Samples on the extreme where they cannot be there by chance.
    fn clipped(&self, channel: Channel, values: &[f64], reach: f64) -> Option<usize> {
        let step = converter_step(values);
        let flat = self.runs.iter().any(|&(start, length)| {
            let beside = [start.checked_sub(1), Some(start + length)].map(|n| n.and_then(|n| values.get(n)));
            let drop = beside.into_iter().flatten().fold(0.0, |drop: f64, next| drop.max((self.extreme - next).abs()));
            (length >= FLAT_RUN && drop > FLAT_DROP * step)
                || (length >= CLIPPED_RUN && drop > CLIPPED_DROP * step)
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

/// The least difference between two unequal samples: the converter's step where the signal is long and lively.
fn converter_step(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let gaps = sorted.windows(2).filter_map(|pair| if let [a, b] = pair { Some(b - a) } else { None });
    gaps.filter(|&gap| gap > 0.0).fold(f64::INFINITY, f64::min)
}

/// Hits whose extreme is exactly that of others, by index: hits differ in strength, so the range was at its end.
///
/// Three hits, or two with four samples on the extreme, are taken for clipped: with 12 bits, five free hits that differ
/// by a fifth do the former once in some ten thousand tests. Channels alike in every sample count once: one hit read
/// twice, or a computed blow.
pub(super) fn shared_extremes(hits: &[Hit]) -> Vec<(usize, HitFault)> {
    let mut found = Vec::new();
    for (channel, values) in [(Channel::Force, force as fn(&Hit) -> &[f64]), (Channel::Acceleration, acceleration)] {
        let tops: Vec<f64> = hits.iter().map(|hit| farthest(values(hit))).collect();
        for (index, (hit, &value)) in hits.iter().zip(&tops).enumerate() {
            let on_it = |samples: &[f64]| samples.iter().filter(|&&sample| sample == value).count();
            let mut sharing: Vec<&[f64]> = Vec::new();
            for (other, _) in hits.iter().zip(&tops).filter(|&(_, &top)| top == value) {
                if !sharing.contains(&values(other)) {
                    sharing.push(values(other));
                }
            }
            let samples: usize = sharing.iter().map(|samples| on_it(samples)).sum();
            if sharing.len() >= 3 || (sharing.len() == 2 && samples >= 4) {
                found.push((index, HitFault::Overload { channel, samples: on_it(values(hit)), value }));
            }
        }
    }
    found
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
