//! What a hit's lines scatter by: the floors of both channels, and a part that goes with the motion.

use num_complex::Complex64;

use super::widened_lines::{HitSpectra, median};

/// Variance of a line of the motion's transform about the force's times the accelerance,
/// $N_a + |A/F|^2N_f + c^2|A|^2$: noise of either channel, and hits that are not quite alike (a millimetre beside the place,
/// a hand that gives).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HitNoise {
    floor: f64,
    force: f64,
    relative: f64,
}

/// Part of the lines, weakest or strongest, from which either number is read.
const TAIL: f64 = 0.3;
/// A single hit does not tell how hits differ: a thousandth of the motion is assumed.
const SINGLE_HIT: f64 = 1e-6;

impl HitNoise {
    /// From the lines below `end` of all hits of one record; of a single hit from the quietest stretch of lines above.
    pub(super) fn of(hits: &[HitSpectra], end: usize) -> Self {
        let force = hits.iter().map(|hit| hit.force_noise).sum::<f64>() / hits.len().max(1) as f64;
        if hits.len() < 2 {
            return Self { floor: floor_above(hits, end), force, relative: SINGLE_HIT };
        }
        let freedom = 2.0 * (hits.len() as f64 - 1.0);
        // A chi-square's median over its mean (Wilson and Hilferty).
        let of_mean = (1.0 - 2.0 / (9.0 * freedom)).powi(3);
        let mut lines: Vec<(f64, f64)> = (1..end)
            .map(|line| {
                let Scatter { motion, gain, left } = scatter_at(hits, line);
                (motion, (left / of_mean - gain * force).max(0.0))
            })
            .collect();
        lines.sort_by(|a, b| a.0.total_cmp(&b.0));
        let tail = (TAIL * lines.len() as f64) as usize;
        let weak: Vec<f64> = lines.iter().take(tail.max(1)).map(|(_, scatter)| *scatter).collect();
        let floor = median(&weak).max(f64::MIN_POSITIVE);
        let strong: Vec<f64> = lines.iter().rev().take(tail).map(|(power, left)| (left - floor) / power).collect();
        Self { floor, force, relative: median(&strong).max(0.0) }
    }

    /// Variance of a line of the motion.
    pub(super) fn at(&self, force: Complex64, motion: Complex64) -> f64 {
        let power = motion.norm_sqr();
        self.floor + power * (self.force / force.norm_sqr().max(f64::MIN_POSITIVE) + self.relative)
    }

    /// Mean square of the hits' scatter over this variance, on some lines; `None` for a single hit.
    pub(super) fn scatter(&self, hits: &[HitSpectra], lines: &[usize]) -> Option<f64> {
        if hits.len() < 2 {
            return None;
        }
        let ratio = |&line: &usize| {
            let Scatter { motion, gain, left } = scatter_at(hits, line);
            left / (self.floor + gain * self.force + self.relative * motion)
        };
        Some(lines.iter().map(ratio).sum::<f64>() / lines.len().max(1) as f64)
    }
}

/// Hits at one line.
struct Scatter {
    /// Mean $|A|^2$.
    motion: f64,
    /// $|A|^2/|F|^2$.
    gain: f64,
    /// Variance of one hit about their common accelerance.
    left: f64,
}

fn scatter_at(hits: &[HitSpectra], line: usize) -> Scatter {
    let (mut cross, mut force, mut motion) = (Complex64::ZERO, f64::MIN_POSITIVE, 0.0);
    for hit in hits {
        let (f, a) = (hit.force[line], hit.motion[line]);
        cross += f.conj() * a;
        force += f.norm_sqr();
        motion += a.norm_sqr();
    }
    let left = (motion - cross.norm_sqr() / force).max(0.0) / (hits.len() as f64 - 1.0);
    Scatter { motion: motion / hits.len() as f64, gain: motion / force, left }
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
