//! A single sample that is wrong in a smooth record: lost (a zero, or its neighbour again), or the top of a crest cut off.
//!
//! Analysers record through a filter that leaves nothing at half the rate. A single wrong sample is even over all
//! frequencies, so there it stands alone: the record is seen through Blackman's window about half the rate, and
//! what one wrong sample would leave must explain nine tenths of that.

use super::{
    extremes::{Levels, median},
    hit_faults::{Channel, HitFault},
    overload::converter_step,
};

/// Half the length of the filter that shows what lies at half the sampling rate.
const REACH: usize = 16;

/// Samples on either side among which a lost one must stand out.
const AROUND: usize = 24;

/// Part of what lies at half the rate there that one wrong sample explains, ...
const EXPLAINED: f64 = 0.9;

/// ... and where nothing but its size marks it: the greatest of a response that no filter passed is sharp by nature.
const EXPLAINED_CREST: f64 = 0.97;

/// Size of the error in standard deviations of the record's second differences, which tell noise and, on the safe side,
/// what still rings, ...
const DEVIATIONS: f64 = 12.0;

/// ... and in steps of the converter.
const STEPS: f64 = 8.0;

/// Candidates that are looked at, the sharpest first.
const MOST: usize = 16;

/// The first lost sample of a channel that can be told.
///
/// Only samples that are exactly zero, or exactly the one before on a flank, are looked at; free ones hardly are.
///
/// Not to be found: a lost sample that lies within twelve standard deviations of where it belongs, as in a record's quiet
/// tail, where it does no harm; one on a crest; one that takes the time with it, so that all after it come a step early.
pub(super) fn dropped_sample(channel: Channel, values: &[f64]) -> Option<HitFault> {
    // Of a fine converter hardly any sample is; one pass without branches says so.
    let any = values.iter().zip(values.iter().skip(1)).fold(false, |any, (a, b)| any | (a == b) | (*b == 0.0));
    if !any {
        return None;
    }
    let mut candidates: Vec<(usize, f64)> = values
        .windows(4)
        .enumerate()
        .filter_map(|(n, window)| match *window {
            [_, b, c, d] if c == 0.0 && b != 0.0 && d != 0.0 => Some((n + 2, (b + d).abs())),
            [a, b, c, d] if c == b && (b - a) * (d - c) > 0.0 => Some((n + 2, (d - c).abs())),
            _ => None,
        })
        .collect();
    let least = DEVIATIONS * bending(values);
    candidates.retain(|&(_, bend)| bend > 0.5 * least);
    candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
    candidates.truncate(MOST);
    let filter = filter();
    let told = candidates.into_iter().filter_map(|(n, _)| Some((n, error_at(values, n, least, EXPLAINED, &filter)?)));
    let told: Vec<(usize, f64)> = told.collect();
    let steps = if told.is_empty() { 0.0 } else { STEPS * converter_step(values) };
    let first = told.into_iter().filter(|(_, error)| error.abs() > steps).min_by_key(|&(n, _)| n);
    first.map(|(n, error)| HitFault::DroppedSample {
        channel,
        sample: n + 1,
        value: values[n],
        expected: values[n] - error,
    })
}

/// The greatest sample of a response where it lies well below what its neighbours point to: one sample alone at the end
/// of the range.
///
/// Of a response only: a blow recorded without a filter has as sharp a top by nature.
pub(super) fn cut_crest(acceleration: &[f64], levels: Levels) -> Option<HitFault> {
    let noise = DEVIATIONS * bending(acceleration);
    let filter = filter();
    levels.far().find_map(|value| {
        let n = acceleration.iter().position(|&sample| sample == value)?;
        let error = error_at(acceleration, n, noise, EXPLAINED_CREST, &filter)?;
        let is_cut = error * (value - levels.middle) < 0.0 && error.abs() > STEPS * converter_step(acceleration);
        is_cut.then_some(HitFault::CutCrest { sample: n + 1, value, expected: value - error })
    })
}

/// By how much a sample is too great, where a part `explained` of what stands at half the rate about it is its own, and more than `least`.
fn error_at(values: &[f64], n: usize, least: f64, explained: f64, filter: &[f64]) -> Option<f64> {
    let seen = Seen::at(values, n, filter).filter(|seen| seen.explained > explained && seen.error.abs() > least)?;
    let beside = [n.checked_sub(1)?, n + 1].into_iter().filter_map(|n| Seen::at(values, n, filter));
    beside.into_iter().all(|beside| beside.explained <= seen.explained).then_some(seen.error)
}

/// Standard deviation of white noise whose second differences are as great as the record's.
fn bending(values: &[f64]) -> f64 {
    let stride = (values.len() / 1000).max(1);
    let bends = values.windows(3).step_by(stride).filter_map(|window| match window {
        [a, b, c] => Some((a - 2.0 * b + c).abs()),
        _ => None,
    });
    median(bends.collect()) / (0.674_49 * 6f64.sqrt())
}

/// Blackman's window about half the rate.
fn filter() -> Vec<f64> {
    let weight = |n: usize| {
        let angle = std::f64::consts::PI * (n as f64 - REACH as f64) / (REACH + 1) as f64;
        let window = 0.42 + 0.5 * angle.cos() + 0.08 * (2.0 * angle).cos();
        if n.is_multiple_of(2) { window } else { -window }
    };
    (0..=2 * REACH).map(weight).collect()
}

/// What one wrong sample would explain.
struct Seen {
    /// Part of what is left about half the rate \[1\].
    explained: f64,
    /// By how much the sample is too great.
    error: f64,
}

impl Seen {
    /// `None` too near to an end of the record.
    fn at(values: &[f64], n: usize, filter: &[f64]) -> Option<Self> {
        let around = values.get(n.checked_sub(AROUND + REACH)?..=n + AROUND + REACH)?;
        let left: Vec<f64> =
            around.windows(filter.len()).map(|part| part.iter().zip(filter).map(|(x, w)| x * w).sum()).collect();
        let energy: f64 = left.iter().map(|value| value * value).sum();
        let own: f64 = filter.iter().map(|weight| weight * weight).sum();
        let product: f64 = left.iter().skip(AROUND - REACH).zip(filter).map(|(left, weight)| left * weight).sum();
        let explained = if energy > 0.0 { product * product / own / energy } else { 0.0 };
        Some(Self { explained, error: product / own })
    }
}
