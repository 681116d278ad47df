//! What a hit's lines scatter by: the floors of both channels, and a part that goes with the motion.

use num_complex::Complex64;

use super::model_error::TRUSTED;
use super::widened_lines::{HitSpectra, median};

/// Variance of a line of a hit's motion about its force times the accelerance,
/// $N_a + |A/F|^2N_f + c^2|A|^2$: noise of either channel, and hits that are not quite alike (a millimetre beside the place,
/// a hand that gives). The channels' noise is each hit's own: noise in per cent of a record goes with its strength.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HitNoise {
    channels: Vec<ChannelNoise>,
    relative: f64,
}

/// Variances of a line by one hit's channels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ChannelNoise {
    motion: f64,
    force: f64,
}

/// Part of the lines, weakest or strongest, from which either number is read.
const TAIL: f64 = 0.3;
/// A single hit does not tell how hits differ: a thousandth of the motion is assumed.
const SINGLE_HIT: f64 = 1e-6;

impl HitNoise {
    /// From the lines below `end` of all hits of one record; of a single hit from the quietest stretch of lines above.
    pub(super) fn of(hits: &[HitSpectra], end: usize) -> Self {
        let channels = |floor: f64| {
            let quiet = relative_floors(hits);
            let both = hits.iter().zip(quiet);
            both.map(|(hit, quiet)| ChannelNoise { motion: floor * quiet, force: hit.force_noise }).collect()
        };
        if hits.len() < 2 {
            return Self { channels: channels(floor_above(hits, end)), relative: SINGLE_HIT };
        }
        let freedom = 2.0 * (hits.len() as f64 - 1.0);
        // A chi-square's median over its mean (Wilson and Hilferty).
        let of_mean = (1.0 - 2.0 / (9.0 * freedom)).powi(3);
        let unit = Self { channels: channels(1.0), relative: 1.0 };
        let mut lines: Vec<Scatter> = (1..end).map(|line| unit.scatter_at(hits, line)).collect();
        lines.sort_by(|a, b| a.strength.total_cmp(&b.strength));
        let tail = (TAIL * lines.len() as f64) as usize;
        let beyond_force = |line: &Scatter| (line.left / of_mean - line.force).max(0.0);
        let weak: Vec<f64> = lines.iter().take(tail.max(1)).map(|line| beyond_force(line) / line.floor).collect();
        let floor = median(&weak).max(f64::MIN_POSITIVE);
        let strong = lines.iter().rev().take(tail);
        let strong: Vec<f64> = strong.map(|line| (beyond_force(line) - floor * line.floor) / line.motion).collect();
        Self { channels: channels(floor), relative: median(&strong).max(TRUSTED * TRUSTED) }
    }

    /// Variance of a line of the motion of one hit, and what of it the force's channel makes.
    pub(super) fn at(&self, hit: usize, force: Complex64, motion: Complex64) -> [f64; 2] {
        let ChannelNoise { motion: floor, force: of_force } = self.channels[hit];
        let power = motion.norm_sqr();
        let by_force = power * of_force / force.norm_sqr().max(f64::MIN_POSITIVE);
        [floor + by_force + power * self.relative, by_force]
    }

    /// Mean square of the hits' scatter over this variance, on some lines; `None` for a single hit.
    pub(super) fn scatter(&self, hits: &[HitSpectra], lines: &[usize]) -> Option<f64> {
        if hits.len() < 2 {
            return None;
        }
        let ratio = |&line: &usize| {
            let Scatter { left, floor, force, motion, .. } = self.scatter_at(hits, line);
            left / (floor + force + motion)
        };
        Some(lines.iter().map(ratio).sum::<f64>() / lines.len().max(1) as f64)
    }

    /// The scatter of the hits at a line, beside what each kind of noise makes of it. With a hit's share
    /// $h = |F|^2/\sum|F|^2$ of their common accelerance, a variance $s$ leaves $\sum s(1-h)$ of itself about that.
    fn scatter_at(&self, hits: &[HitSpectra], line: usize) -> Scatter {
        let (mut cross, mut power, mut motion) = (Complex64::ZERO, f64::MIN_POSITIVE, 0.0);
        for hit in hits {
            let (f, a) = (hit.force[line], hit.motion[line]);
            cross += f.conj() * a;
            power += f.norm_sqr();
            motion += a.norm_sqr();
        }
        let freedom = hits.len() as f64 - 1.0;
        let mut scatter = Scatter {
            strength: motion,
            left: (motion - cross.norm_sqr() / power).max(0.0) / freedom,
            floor: 0.0,
            force: 0.0,
            motion: 0.0,
        };
        for (hit, noise) in hits.iter().zip(&self.channels) {
            let left = (1.0 - hit.force[line].norm_sqr() / power) / freedom;
            scatter.floor += noise.motion * left;
            scatter.force += motion / power * noise.force * left;
            scatter.motion += self.relative * hit.motion[line].norm_sqr() * left;
        }
        scatter
    }
}

/// Hits at one line.
struct Scatter {
    /// $\sum|A|^2$.
    strength: f64,
    /// Scatter about their common accelerance.
    left: f64,
    /// What the motion's channel makes of that, the force's, and hits not quite alike.
    floor: f64,
    force: f64,
    motion: f64,
}

/// Noise of each hit's motion over their mean, as read before the blows; alike where one does not tell it.
fn relative_floors(hits: &[HitSpectra]) -> Vec<f64> {
    let told: Option<Vec<f64>> = hits.iter().map(|hit| hit.motion_noise.filter(|noise| *noise > 0.0)).collect();
    let told = told.unwrap_or_else(|| vec![1.0; hits.len()]);
    let mean = told.iter().sum::<f64>() / told.len().max(1) as f64;
    told.into_iter().map(|noise| noise / mean).collect()
}

/// Stretches between the band and half the rate; the quietest one holds no motion.
const STRETCHES: usize = 8;

fn floor_above(hits: &[HitSpectra], end: usize) -> f64 {
    let Some(hit) = hits.first() else { return f64::MIN_POSITIVE };
    let above: Vec<f64> = hit.motion.iter().skip(end).map(Complex64::norm_sqr).collect();
    let stretches = above.chunks((above.len() / STRETCHES).max(1)).filter(|stretch| stretch.len() > 8);
    // |noise|² is exponentially distributed: its median is ln 2 of its mean.
    let quietest = stretches.map(|stretch| median(stretch) / std::f64::consts::LN_2).fold(f64::INFINITY, f64::min);
    if quietest.is_finite() { quietest.max(f64::MIN_POSITIVE) } else { 1e-6 * median(&above).max(f64::MIN_POSITIVE) }
}
