//! What can be wrong with one hit.

use std::fmt;

use super::time_history::Hit;

/// A channel of a hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// The hammer.
    Force,
    /// The accelerometer.
    Acceleration,
}

/// A fault found in a hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HitFault {
    /// A channel that shows nothing.
    Silent(Channel),
    /// A channel cut off at its greatest value.
    Overload {
        /// The channel.
        channel: Channel,
        /// Samples in a row at the extreme.
        samples: usize,
        /// The extreme \[N or m/s²\].
        value: f64,
    },
    /// The hammer touched again.
    DoubleHit {
        /// Time of the second touch from the first \[s\].
        after: f64,
        /// Its peak over the first one's \[1\].
        ratio: f64,
    },
    /// A force that hardly stands out of its channel's noise.
    WeakForce {
        /// Peak over the noise's standard deviation \[1\].
        signal_to_noise: f64,
    },
    /// A response that still rings at the record's end.
    NotDecayed {
        /// Rms of the last twentieth over the greatest rms of a twentieth \[1\].
        ratio: f64,
    },
}

impl HitFault {
    /// True where the hit cannot be used. A response that has not decayed leaks, which a window mends; all else is lost.
    pub fn is_fatal(self) -> bool {
        !matches!(self, Self::NotDecayed { .. })
    }
}

impl fmt::Display for HitFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |channel| match channel {
            Channel::Force => ("force", "N"),
            Channel::Acceleration => ("acceleration", "m/s2"),
        };
        match *self {
            Self::Silent(channel) => write!(f, "no signal in the {}", name(channel).0),
            Self::Overload { channel, samples, value } => {
                let (name, unit) = name(channel);
                write!(f, "{name} cut off: {samples} samples in a row at {value:.4} {unit} (overload)")
            }
            Self::DoubleHit { after, ratio } => {
                write!(f, "double hit: {:.1} % of the force again after {:.1} ms", 100.0 * ratio, 1e3 * after)
            }
            Self::WeakForce { signal_to_noise } => {
                write!(f, "force only {signal_to_noise:.1} times its noise, {LEAST_SIGNAL_TO_NOISE} needed")
            }
            Self::NotDecayed { ratio } => {
                let remedy = "record longer, or use the force and exponential window";
                write!(f, "response not decayed, {:.2} % left at the end: {remedy}", 100.0 * ratio)
            }
        }
    }
}

/// Samples in a row at the very same extreme, next to a drop: a smooth peak has two at most.
const CLIPPED_RUN: usize = 3;

/// The drop beside it, over the signal's reach: a peak flat by few bits falls by a bit, a clipped one at once.
const CLIPPED_DROP: f64 = 0.01;

/// Samples in a row at the extreme that are clipped, drop or not.
const FLAT_RUN: usize = 8;

/// Force that counts as a touch, over the peak: less does not change the spectrum by more than this.
const TOUCH: f64 = 0.05;

/// Samples exactly on the extreme, in runs of any length, from which it may be the end of the range.
const SCATTERED_TOUCHES: usize = 8;

/// Next to the pulse, within three times its length, up to this the anti-alias filter rings.
const FILTER_RINGING: f64 = 0.2;

/// Peak over noise below which the force spectrum is no better than a few per cent.
const LEAST_SIGNAL_TO_NOISE: f64 = 20.0;

/// Rms left at the end, over the greatest, that leakage makes visible between the peaks.
const DECAYED: f64 = 1e-3;

/// Rms left at the end that is ringing for certain, noise or not.
const RINGING: f64 = 0.1;

/// Rms of four twentieths over that of the four before, below which it still falls; noise stays as it is.
const FALLING: f64 = 0.9;

impl Hit {
    /// What is wrong with the hit; `rate` is the sampling rate \[Hz\].
    pub fn faults(&self, rate: f64) -> Vec<HitFault> {
        let channels = [(Channel::Force, &self.force), (Channel::Acceleration, &self.acceleration)];
        let silent =
            channels.iter().filter(|(_, values)| values.windows(2).all(|pair| matches!(pair, [a, b] if a == b)));
        let silent: Vec<_> = silent.map(|&(channel, _)| HitFault::Silent(channel)).collect();
        if !silent.is_empty() {
            return silent;
        }
        let mut faults: Vec<_> = channels.iter().filter_map(|(channel, values)| overload(*channel, values)).collect();
        faults.extend(force_fault(&self.force, rate));
        faults.extend(not_decayed(&self.acceleration));
        faults
    }
}

fn overload(channel: Channel, values: &[f64]) -> Option<HitFault> {
    let middle = sampled_median(values);
    let extremes = [values.iter().copied().fold(f64::MIN, f64::max), values.iter().copied().fold(f64::MAX, f64::min)];
    let reach = extremes.iter().fold(0.0, |reach: f64, extreme| reach.max((extreme - middle).abs()));
    // A quiet side rests on its last bit; a clipped one stands far from the middle.
    extremes.into_iter().filter(|extreme| (extreme - middle).abs() > 0.5 * reach).find_map(|value| {
        let mut samples = 0;
        let mut start = 0;
        for run in values.chunk_by(|a, b| a == b) {
            let end = start + run.len();
            if run.first() == Some(&value) && run.len() > samples {
                let beside = [start.checked_sub(1), Some(end)].map(|n| n.and_then(|n| values.get(n)));
                let drop = beside.into_iter().flatten().fold(0.0, |drop: f64, next| drop.max((value - next).abs()));
                if run.len() >= FLAT_RUN || (run.len() >= CLIPPED_RUN && drop > CLIPPED_DROP * reach) {
                    samples = run.len();
                }
            }
            start = end;
        }
        // A fast oscillation touches its range for a sample or two at a time, but again and again, and seldom comes
        // close to it without touching: a free extreme is met once, and its neighbourhood often.
        let touches = values.iter().filter(|&&other| other == value).count();
        let close = values.iter().filter(|&&other| other != value && (other - value).abs() < TOUCH * reach).count();
        if touches >= SCATTERED_TOUCHES && touches > 2 * close {
            samples = samples.max(touches);
        }
        (samples > 0).then_some(HitFault::Overload { channel, samples, value })
    })
}

fn force_fault(force: &[f64], rate: f64) -> Option<HitFault> {
    let offset = sampled_median(force);
    let (peak, height) = peak(force, offset);
    let sign = height.signum();
    let push: Vec<f64> = force.iter().map(|value| sign * (value - offset)).collect();
    let threshold = TOUCH * height.abs();
    // Runs of samples that push: [from, to).
    let mut runs: Vec<(usize, usize, f64)> = Vec::new();
    for (n, &value) in push.iter().enumerate() {
        if value <= threshold {
            continue;
        }
        match runs.last_mut() {
            Some((_, to, top)) if *to == n => (*to, *top) = (n + 1, top.max(value)),
            _ => runs.push((n, n + 1, value)),
        }
    }
    let &(from, to, _) = runs.iter().find(|(from, to, _)| (*from..*to).contains(&peak))?;
    let near = 3 * (to - from);
    let quiet: Vec<f64> = push
        .iter()
        .enumerate()
        .filter(|(n, _)| n + near < from || *n >= to + near)
        .map(|(_, value)| value.abs())
        .collect();
    // The median of |noise| is 0.6745 standard deviations; second touches hardly move it.
    let noise = sampled_median(&quiet) / 0.674_49;
    let signal_to_noise = height.abs() / noise;
    if noise > 0.0 && signal_to_noise < LEAST_SIGNAL_TO_NOISE {
        return Some(HitFault::WeakForce { signal_to_noise });
    }
    let second = runs.iter().filter(|run| run.0 != from).find(|&&(other_from, other_to, top)| {
        let gap = if other_from >= to { other_from - to } else { from.saturating_sub(other_to) };
        gap > near || top > FILTER_RINGING * height.abs()
    });
    second.map(|&(other, _, top)| HitFault::DoubleHit {
        after: (other as f64 - from as f64) / rate,
        ratio: top / height.abs(),
    })
}

fn not_decayed(acceleration: &[f64]) -> Option<HitFault> {
    let mean = acceleration.iter().sum::<f64>() / acceleration.len() as f64;
    let part = (acceleration.len() / 20).max(1);
    let rms: Vec<f64> = acceleration
        .chunks_exact(part)
        .map(|chunk| (chunk.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / part as f64).sqrt())
        .collect();
    let greatest = rms.iter().copied().fold(0.0, f64::max);
    let ratio = rms.last().copied().unwrap_or(0.0) / greatest;
    let mut last_eight = rms.rchunks(4).map(|part| part.iter().sum::<f64>());
    let falls = last_eight.next().zip(last_eight.next()).is_some_and(|(last, before)| last < FALLING * before);
    (ratio > RINGING || (ratio > DECAYED && falls)).then_some(HitFault::NotDecayed { ratio })
}

/// The sample farthest from the offset, and its height over it.
pub(super) fn peak(values: &[f64], offset: f64) -> (usize, f64) {
    let heights = values.iter().map(|value| value - offset).enumerate();
    heights.fold(
        (0, 0.0),
        |best, (n, height): (usize, f64)| if height.abs() > f64::abs(best.1) { (n, height) } else { best },
    )
}

/// The median of at most some thousand values spread over all, which is good to 4 % of a standard deviation: sorting a
/// long record would take longer than its transform.
pub(super) fn sampled_median(values: &[f64]) -> f64 {
    let stride = (values.len() / 1000).max(1);
    median(&values.iter().step_by(stride).copied().collect::<Vec<_>>())
}

/// The middle value; 0 of an empty list.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    if sorted.is_empty() { 0.0 } else { *sorted.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
