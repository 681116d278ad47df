//! Hits of one pair of places as lines: H1 over the hits, with what each record's end cuts off.

use std::f64::consts::{LN_2, TAU};

use num_complex::Complex64;
use orthopanel_data::{Hit, TimeHistory, Transforms};

use super::lines::{RecordLines, TruncatedHit, Truncations};
use super::medians::median;

/// Half the width of the window over the force \[s\], and the part of it that its edges take: the hammer has left the panel, the noise of its channel
/// stays out.
const FORCE_WINDOW: f64 = 10e-3;
const WINDOW_EDGE: f64 = 0.2;
/// Highest frequency of the band, over the sampling rate: analysers' filters are flat up to there.
pub(super) const FLAT: f64 = 1.0 / 2.56;
/// Samples on either side of a blow that a filter before the converter rings, and that the window holds too: it passes [`FLAT`] of
/// the sampling rate and nothing above its half, and what falls off over a band rings some seven times as long as its reciprocal.
const RINGS: f64 = 7.0 / (0.5 - FLAT);

/// One hit's transforms on the lines of the band, times the sampling step.
pub(crate) struct HitSpectra {
    pub force: Vec<Complex64>,
    pub motion: Vec<Complex64>,
    /// Noise of either channel on a line, $E|N|^2$.
    force_noise: f64,
    motion_noise: f64,
    truncated: TruncatedHit,
    /// The force \[N\] from the record's start to the end of the blow, and its strongest sample.
    pub blow: Vec<f64>,
    pub peak: usize,
}

/// The hits of one pair of places, each by itself.
pub(crate) struct HitsOfRecord {
    /// $s$ of each line, and its number in the transform.
    pub s: Vec<Complex64>,
    pub lines: std::ops::Range<usize>,
    pub hits: Vec<HitSpectra>,
    /// The accelerance as the variances of a line take it, without the noise of the force.
    first: Vec<Complex64>,
    /// H1 over the hits.
    mean: Vec<Complex64>,
    /// $G$ of each line.
    power: Vec<f64>,
}

impl HitsOfRecord {
    /// On the lines of their transform between two frequencies \[Hz\], under a window $e^{-\sigma t}$ from the blow on.
    pub(crate) fn new(history: &TimeHistory, band: [f64; 2], sigma: f64) -> Self {
        let samples = history.hits.first().map_or(0, |hit| hit.force.len());
        let resolution = history.rate / samples.max(1) as f64;
        let line_at = |frequency: f64| (frequency / resolution).ceil().max(1.0) as usize;
        let lines = line_at(band[0])..line_at(band[1]).min(samples / 2);
        let hits: Vec<HitSpectra> =
            history.hits.iter().map(|hit| HitSpectra::of(hit, history.rate, lines.clone(), sigma)).collect();
        let s = lines.clone().map(|line| Complex64::new(sigma, TAU * resolution * line as f64)).collect();
        let first: Vec<Complex64> = (0..lines.len()).map(|line| mean(&hits, line, |hit| hit.motion_noise).0).collect();
        let of_line = |(line, first): (usize, &Complex64)| mean(&hits, line, |hit| hit.variance(*first));
        let (mean, power) = first.iter().enumerate().map(of_line).unzip();
        Self { s, lines, hits, first, mean, power }
    }

    /// Share of a hit's motion in the mean of a line, $\bar F/(vG)$.
    pub(crate) fn share(&self, hit: &HitSpectra, line: usize) -> Complex64 {
        hit.force[line].conj() / (hit.variance(self.first[line]) * self.power[line])
    }

    /// What a hit's motion on a line leaves beside the mean and something added, squared, over its noise.
    pub(crate) fn left(&self, hit: &HitSpectra, line: usize, added: Complex64) -> f64 {
        let left = hit.motion[line] - self.mean[line] * hit.force[line] - added;
        left.norm_sqr() / hit.variance(self.first[line])
    }
}

impl RecordLines {
    /// From hits, on the lines of their transform between two frequencies \[Hz\].
    ///
    /// With the transforms $F_h$, $A_h$ of the hits, their noise $N_F$, $N_A$ and $v_h = N_A + |H|^2N_F$ the mean is
    /// $$\hat H = \frac1G\sum_h\frac{\bar F_hA_h}{v_h},\qquad G = \sum_h\frac{|F_h|^2}{v_h},\qquad E|\hat H-H|^2 = 1/G.$$
    /// The response is not windowed: what the record's end cuts off stands in [`RecordLines::pole`].
    pub(super) fn of_hits(history: &TimeHistory, band: [f64; 2]) -> Self {
        let of = HitsOfRecord::new(history, band, 0.0);
        let step = history.rate.recip();
        let lines = 0..of.s.len();
        let share = |hit: &HitSpectra| lines.clone().map(|line| of.share(hit, line)).collect();
        let shares: Vec<Vec<Complex64>> = of.hits.iter().map(share).collect();
        let told = |line: usize| of.hits.iter().map(|hit| hit.force[line].norm_sqr() / hit.force_noise).sum::<f64>();
        let force_noise = lines.clone().map(|line| told(line).recip()).collect();
        let hits = of.hits.into_iter().zip(shares).map(|(hit, share)| TruncatedHit { share, ..hit.truncated });
        let truncations = Truncations {
            step,
            // $e^{sT} = 1$ on the transform's own lines.
            back: of.s.iter().map(|s| (-s * step).exp()).collect(),
            hits: hits.collect(),
        };
        Self {
            force_at: history.force_at,
            response_at: history.response_at,
            weight: of.power.iter().map(|power| (2.0 * power).sqrt()).collect(),
            per_datum: 1.0,
            s: of.s,
            value: of.mean,
            truncations: Some(truncations),
            force_noise,
        }
    }
}

/// $\hat H$ and $G$ of a line with these variances of the motion.
fn mean(hits: &[HitSpectra], line: usize, variance: impl Fn(&HitSpectra) -> f64) -> (Complex64, f64) {
    let (mut cross, mut power) = (Complex64::ZERO, f64::MIN_POSITIVE);
    for hit in hits {
        let weight = variance(hit).recip();
        cross += hit.force[line].conj() * hit.motion[line] * weight;
        power += hit.force[line].norm_sqr() * weight;
    }
    (cross / power, power)
}

impl HitSpectra {
    /// Of a line's motion where the accelerance is about this.
    pub(crate) fn variance(&self, accelerance: Complex64) -> f64 {
        self.motion_noise + accelerance.norm_sqr() * self.force_noise
    }

    fn of(hit: &Hit, rate: f64, lines: std::ops::Range<usize>, sigma: f64) -> Self {
        let (samples, step) = (hit.force.len(), rate.recip());
        let offset = median(hit.force.iter().copied());
        let away = |n: &usize| (hit.force[*n] - offset).abs();
        let peak = (0..samples).max_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0);
        let half = FORCE_WINDOW.max(RINGS * step);
        let window = |n: usize| {
            let inside = (1.0 - n.abs_diff(peak) as f64 * step / half) / WINDOW_EDGE;
            0.5 - 0.5 * (std::f64::consts::PI * inside.clamp(0.0, 1.0)).cos()
        };
        let windows: Vec<f64> = (0..samples).map(window).collect();
        let decay = |n: usize| (sigma * (peak as f64 - n as f64) * step).exp();
        let force: Vec<f64> = hit.force.iter().zip(&windows).map(|(f, w)| (f - offset) * w).collect();
        let blow = || (0..samples).filter(|&n| windows[n] > 0.0);
        let beside = (0..samples).filter(|&n| windows[n] == 0.0).map(|n| hit.force[n] - offset);
        let motion = transform(hit.acceleration.clone(), lines.clone(), step);
        // Counted from the blow the spectrum is smooth beside its peaks, and fourth differences of it are noise: 1 + 16 + 36 + 16 + 1 times its
        // variance, exponentially distributed.
        let turn = |line: usize| Complex64::from_polar(1.0, TAU * ((line * peak) % samples) as f64 / samples as f64);
        let turned: Vec<Complex64> = motion.iter().zip(lines.clone()).map(|(a, line)| a * turn(line)).collect();
        let bends = turned.windows(5).map(|w| (w[0] + w[4] - 4.0 * (w[1] + w[3]) + 6.0 * w[2]).norm_sqr());
        let motion_noise = (median(bends) / (70.0 * LN_2)).max(f64::MIN_POSITIVE);
        // The median of |noise| is 0.6745 standard deviations.
        let deviation = median(beside.map(f64::abs)) / 0.674_49;
        let windowed: f64 = windows.iter().map(|w| w * w).sum();
        let truncated = TruncatedHit {
            impulse: blow().map(|n| force[n] * step).collect(),
            left: blow().next_back().map_or(0.0, |last| (samples - last) as f64 * step),
            share: vec![],
        };
        let force_noise = (deviation * step).powi(2) * windowed;
        // Under a window that decays, what comes before the blow would be noise enlarged.
        let (motion, motion_noise) = if sigma > 0.0 {
            let first = blow().next().unwrap_or(0);
            let seen = |(n, a): (usize, &f64)| if n < first { 0.0 } else { a * decay(n) };
            let motion = transform(hit.acceleration.iter().enumerate().map(seen).collect(), lines.clone(), step);
            (motion, motion_noise / (2.0 * sigma * step * samples as f64))
        } else {
            (motion, motion_noise)
        };
        let end = blow().next_back().map_or(0, |last| last + 1);
        Self {
            blow: force[..end].to_vec(),
            force: transform(force.iter().enumerate().map(|(n, f)| f * decay(n)).collect(), lines, step),
            peak,
            motion,
            force_noise: force_noise.max(f64::MIN_POSITIVE),
            motion_noise,
            truncated,
        }
    }
}

/// Some lines of a transform times the sampling step.
pub(crate) fn transform(samples: Vec<f64>, lines: std::ops::Range<usize>, step: f64) -> Vec<Complex64> {
    let spectrum = Transforms::default().lines(samples);
    spectrum.get(lines).map_or_else(Vec::new, |lines| lines.iter().map(|line| line * step).collect())
}
