//! Noise of a hit's two channels, read where neither the hammer nor the piece moves: before the blow.

use super::{blow::Blow, extremes::median, hit::Hit};

/// Standard deviations of the noise of a hit's channels, as if it were white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelNoise {
    /// \[N\]
    pub force: f64,
    /// \[m/s²\]
    pub acceleration: f64,
}

/// Samples that are read at most, ...
const MOST: usize = 1024;

/// ... and at least: they tell a standard deviation to a fifth.
const LEAST: usize = 30;

/// Second differences beyond this many standard deviations are no noise: a blow's foot, a filter that rings ahead.
const FAR: f64 = 4.0;

impl Hit {
    /// The noise of either channel before the blow; `None` where fewer than some sixty samples stand there.
    ///
    /// Read from second differences, which neither an offset nor a hum nor what rings on from the hit before reaches.
    pub fn noise_before_blow(&self) -> Option<ChannelNoise> {
        self.noise_before(&self.blow())
    }

    /// As [`Hit::noise_before_blow`], where the blow is known.
    pub(super) fn noise_before(&self, blow: &Blow) -> Option<ChannelNoise> {
        let quiet = blow.quiet?;
        let quiet = quiet.saturating_sub(MOST)..quiet;
        let deviation = |channel: &[f64]| deviation(channel.get(quiet.clone()).unwrap_or_default());
        Some(ChannelNoise { force: deviation(&self.force)?, acceleration: deviation(&self.acceleration)? })
    }
}

fn deviation(quiet: &[f64]) -> Option<f64> {
    let bends: Vec<f64> =
        quiet.windows(3).filter_map(|w| if let [a, b, c] = w { Some((a - 2.0 * b + c).abs()) } else { None }).collect();
    // The median of |noise| is 0.6745 standard deviations; what lies far beyond is no noise.
    let most = FAR * median(bends.clone()) / 0.674_49;
    let (sum, count) = bends
        .iter()
        .filter(|&&bend| bend <= most)
        .fold((0.0, 0), |(sum, count): (f64, usize), bend| (sum + bend * bend, count + 1));
    // 1 + 4 + 1 times the variance makes that of a second difference.
    (bends.len() >= LEAST).then(|| (sum / count as f64 / 6.0).sqrt()).filter(|deviation| deviation.is_finite())
}
