//! What can be wrong with one hit.

use std::fmt;

use super::{
    extremes::{Levels, median, peak_among},
    overload::overload,
    time_history::Hit,
    wrong_sample::{cut_crest, dropped_sample},
};

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
        /// Samples at the extreme, in a row or scattered.
        samples: usize,
        /// The extreme \[N or m/s²\].
        value: f64,
    },
    /// The one greatest sample of the response cut off.
    CutCrest {
        /// What stands there \[m/s²\].
        value: f64,
        /// What its neighbours point to \[m/s²\].
        expected: f64,
    },
    /// A sample that was lost, and a zero or its neighbour written in its place.
    DroppedSample {
        /// The channel.
        channel: Channel,
        /// The sample, from 1.
        sample: usize,
        /// What stands there \[N or m/s²\].
        value: f64,
        /// What would fit among its neighbours \[N or m/s²\].
        expected: f64,
    },
    /// The hammer touched again.
    DoubleHit {
        /// Time of the second touch from the first \[s\].
        after: f64,
        /// Its peak over the first one's \[1\].
        ratio: f64,
    },
    /// A blow too short for the sampling rate: the force is an anti-alias filter's ringing, not its own shape.
    RateTooLow {
        /// Samples that the pulse lasts.
        samples: usize,
        /// The sampling rate \[Hz\].
        rate: f64,
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
                write!(f, "{name} cut off: {samples} samples at exactly {value:.4} {unit} (overload)")
            }
            Self::CutCrest { value, expected } => write!(
                f,
                "acceleration cut off: its greatest sample is {value:.4} m/s2 where {expected:.4} would fit (overload)"
            ),
            Self::DroppedSample { channel, sample, value, expected } => {
                let (name, unit) = name(channel);
                write!(
                    f,
                    "sample {sample} of the {name} was lost: {value:.4} {unit} stands where {expected:.4} would fit"
                )
            }
            Self::DoubleHit { after, ratio } => {
                write!(f, "double hit: {:.1} % of the force again after {:.1} ms", 100.0 * ratio, 1e3 * after)
            }
            Self::RateTooLow { samples, rate } => write!(
                f,
                "the force lasts {samples} samples and rings on: the sampling rate of {rate:.1} Hz is too low for this \
                 blow, or the record was decimated: record faster, or hit with a softer tip"
            ),
            Self::WeakForce { signal_to_noise } => {
                write!(f, "force only {signal_to_noise:.1} times its noise, {LEAST_SIGNAL_TO_NOISE} needed")
            }
            Self::NotDecayed { ratio } => {
                write!(f, "response not decayed, {:.2} % left at the end", 100.0 * ratio)
            }
        }
    }
}

/// Force that counts as a touch, over the peak: less does not change the spectrum by more than this.
const TOUCH: f64 = 0.05;

/// Next to the pulse, within three times its length, up to this the anti-alias filter rings.
const FILTER_RINGING: f64 = 0.2;

/// Samples that a pulse lasts at most where the sampling rate decides its shape: a band-limited pulse is no shorter.
const SHORTEST_PULSE: usize = 4;

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
    ///
    /// Not to be found in one hit: a single sample of the force cut off at a ceiling, one of the response that was not
    /// recorded through an anti-alias filter, and a channel that goes gently into its ceiling. Hits whose greatest samples
    /// are exactly alike tell the first two: [`TimeHistory::accelerance`](crate::TimeHistory::accelerance)
    /// looks for them. Nor a lost sample that fits its neighbours, one on a crest, or one whose time was lost too.
    pub fn faults(&self, rate: f64) -> Vec<HitFault> {
        let channels = [(Channel::Force, &self.force), (Channel::Acceleration, &self.acceleration)];
        let silent =
            channels.iter().filter(|(_, values)| values.windows(2).all(|pair| matches!(pair, [a, b] if a == b)));
        let silent: Vec<_> = silent.map(|&(channel, _)| HitFault::Silent(channel)).collect();
        if !silent.is_empty() {
            return silent;
        }
        let [force, motion] = [&self.force, &self.acceleration].map(|channel| Levels::of(channel));
        let both = channels.iter().zip([force, motion]);
        let mut faults: Vec<_> =
            both.filter_map(|((channel, values), levels)| overload(*channel, values, levels)).collect();
        // What is cut off has many corners: a lost sample is told of whole channels only.
        if faults.is_empty() {
            faults.extend(cut_crest(&self.acceleration, motion));
        }
        if faults.is_empty() {
            faults.extend(channels.iter().filter_map(|(channel, values)| dropped_sample(*channel, values)));
        }
        faults.extend(force_fault(&self.force, force, rate));
        faults.extend(not_decayed(&self.acceleration));
        faults
    }
}

fn force_fault(force: &[f64], Levels { extremes, middle: offset }: Levels, rate: f64) -> Option<HitFault> {
    let (peak, height) = peak_among(force, offset, extremes);
    let sign = height.signum();
    let push = |value: f64| sign * (value - offset);
    let threshold = TOUCH * height.abs();
    // Runs of samples that push: [from, to).
    let mut runs: Vec<(usize, usize, f64)> = Vec::new();
    for (n, &value) in force.iter().enumerate() {
        let value = push(value);
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
    let second = runs.iter().filter(|run| run.0 != from).find(|&&(other_from, other_to, top)| {
        let gap = if other_from >= to { other_from - to } else { from.saturating_sub(other_to) };
        gap > near || top > FILTER_RINGING * height.abs()
    });
    let &(other, _, top) = second?;
    // A hammer only pushes, a filter swings both ways. Between the pulse and what looks like a second touch of a pulse
    // this short, a pull tells the filter's ringing.
    let (start, end) = (from.min(other), to.max(other));
    let pulls = force.get(start..end).unwrap_or_default().iter().any(|&value| push(value) < -threshold);
    Some(match to - from {
        samples if samples <= SHORTEST_PULSE && pulls => HitFault::RateTooLow { samples, rate },
        _ => HitFault::DoubleHit { after: (other as f64 - from as f64) / rate, ratio: top / height.abs() },
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
