//! What can be wrong with one hit.

use std::fmt;

use orthopanel_model::Readable;

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
        /// The first sample at the extreme, from 1.
        first: usize,
        /// Samples at the extreme, in a row or scattered.
        samples: usize,
        /// The extreme \[N or m/s²\].
        value: f64,
    },
    /// The one greatest sample of the response cut off.
    CutCrest {
        /// The sample, from 1.
        sample: usize,
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
    /// The samples of an earlier hit, to the last digit: a file or record that stands twice.
    Copy {
        /// The earlier hit, from 1.
        of: usize,
    },
    /// An accelerance beside that of the other hits over the whole band.
    Astray {
        /// Its magnitude over theirs \[1\].
        gain: f64,
    },
    /// An accelerance unlike that of the other hits.
    Elsewhere {
        /// How far it is from theirs in the median line, over the greater of both \[1\].
        apart: f64,
        /// How far these differ \[1\].
        within: f64,
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
            Self::Overload { channel, first, samples, value } => {
                let (name, unit) = name(channel);
                let many = if samples == 1 { "" } else { "s" };
                write!(
                    f,
                    "{name} cut off from sample {first} on: {samples} sample{many} at exactly {:.4} {unit} (overload): \
                     {GREATER_RANGE}",
                    Readable(value)
                )
            }
            Self::CutCrest { sample, value, expected } => write!(
                f,
                "acceleration cut off at sample {sample}: its greatest is {:.4} m/s2 where {:.4} would fit \
                 (overload): {GREATER_RANGE}",
                Readable(value),
                Readable(expected)
            ),
            Self::DroppedSample { channel, sample, value, expected } => {
                let (name, unit) = name(channel);
                write!(
                    f,
                    "sample {sample} of the {name} was lost: {:.4} {unit} stands where {:.4} would fit",
                    Readable(value),
                    Readable(expected)
                )
            }
            Self::DoubleHit { after, ratio } => {
                let when = if after < 0.0 { "touched before, by" } else { "again after" };
                write!(
                    f,
                    "double hit: {:.1} % of the force {when} {:.1} ms",
                    Readable(100.0 * ratio),
                    Readable(1e3 * after.abs())
                )
            }
            Self::RateTooLow { samples, rate } => write!(
                f,
                "the force lasts {samples} samples and rings on: the sampling rate of {rate:.1} Hz is too low for this \
                 blow, or the record was decimated: record faster, or hit with a softer tip"
            ),
            Self::WeakForce { signal_to_noise } => {
                write!(f, "force only {:.1} times its noise, {LEAST_SIGNAL_TO_NOISE} needed", Readable(signal_to_noise))
            }
            Self::Copy { of } => write!(f, "sample by sample hit {of} again: a copy, which would count twice"),
            Self::Astray { gain } => write!(
                f,
                "its accelerance is {:.1} % {} that of the other hits over the whole band, which agree: a sample cut off at \
                 the crest, or another gain",
                Readable(100.0 * (gain - 1.0).abs()),
                if gain > 1.0 { "above" } else { "below" }
            ),
            Self::Elsewhere { apart, within } if apart > TURNED_ROUND => write!(
                f,
                "its accelerance is that of the other hits with the other sign, which agree within {:.0} %: sensor or hammer \
                 turned round",
                Readable((100.0 * within).ceil())
            ),
            Self::Elsewhere { apart, within } => write!(
                f,
                "its accelerance differs by {:.0} % in the median line from that of the other hits, which agree within \
                 {:.0} %: another place, or a spoilt record",
                Readable(100.0 * apart),
                Readable((100.0 * within).ceil())
            ),
            Self::NotDecayed { ratio } => {
                write!(f, "response not decayed, {:.2} % left at the end", Readable(100.0 * ratio))
            }
        }
    }
}

/// What helps where a channel is cut off.
const GREATER_RANGE: &str = "set a greater range, or hit more softly";

/// Difference of two lines over the greater of both beyond which they hardly differ but in sign: that makes two.
const TURNED_ROUND: f64 = 1.9;

/// Peak over noise below which the force spectrum is no better than a few per cent.
pub(super) const LEAST_SIGNAL_TO_NOISE: f64 = 20.0;
