//! Spectra of one hit, and their sums over hits.

use num_complex::Complex64;
use realfft::RealFftPlanner;

use super::{
    extremes::{peak, sampled_median},
    time_history::Hit,
    window::Window,
};

/// Sums over hits of $|F|^2$, $|A|^2$ and $\bar F A$, line by line from 0 to half the rate.
pub(super) struct Sums {
    pub(super) force: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) cross: Vec<Complex64>,
    /// The same three weighted with $|F|^2$ again: the hits' own scatter about their common quotient.
    weighted: Weighted,
}

struct Weighted {
    force: Vec<f64>,
    motion: Vec<f64>,
    cross: Vec<Complex64>,
}

impl Sums {
    /// Variance of $H_1$ at a line from the scatter of the hits, each with a noise of its own size:
    /// $$\frac{\sum|F_i|^2|A_i-H_1F_i|^2}{(\sum|F_i|^2)^2}\Big/\Big(1-\frac{\sum|F_i|^4}{(\sum|F_i|^2)^2}\Big)$$
    ///
    /// The numerator holds whether a hard hit is noisier than a soft one or not (White, Econometrica 48, 1980); the
    /// denominator makes it free of bias where all hits are equally noisy.
    pub(super) fn scatter(&self, line: usize) -> f64 {
        let (force, quotient) = (self.force[line], self.cross[line] / self.force[line]);
        let Weighted { force: force4, motion, cross } = &self.weighted;
        let misfit = motion[line] - 2.0 * (quotient.conj() * cross[line]).re + quotient.norm_sqr() * force4[line];
        let one_hit_share = force4[line] / (force * force);
        (misfit / (force * force) / (1.0 - one_hit_share)).max(0.0)
    }
}

/// Sums the spectra of `hits`, all of length `samples`.
pub(super) fn sums<'a>(hits: impl Iterator<Item = &'a Hit>, samples: usize, window: Window, rate: f64) -> Sums {
    let mut planner = RealFftPlanner::<f64>::new();
    let transform = planner.plan_fft_forward(samples);
    let (mut force_spectrum, mut motion_spectrum) = (transform.make_output_vec(), transform.make_output_vec());
    let mut scratch = transform.make_scratch_vec();
    let lines = force_spectrum.len();
    let mut sums = Sums {
        force: vec![0.0; lines],
        motion: vec![0.0; lines],
        cross: vec![Complex64::default(); lines],
        weighted: Weighted {
            force: vec![0.0; lines],
            motion: vec![0.0; lines],
            cross: vec![Complex64::default(); lines],
        },
    };
    for hit in hits {
        // The hammer is off the piece nearly all the time, so the median is its channel's offset; the mean is not,
        // for it holds the impulse.
        let offset = sampled_median(&hit.force);
        let (peak, height) = peak(&hit.force, offset);
        let rest = rest_before(hit, offset, height);
        let mut force: Vec<f64> = hit.force.iter().map(|value| value - offset).collect();
        let mut motion: Vec<f64> = hit.acceleration.iter().map(|value| value - rest).collect();
        window.apply(&mut force, &mut motion, peak, rate);
        let transformed = transform
            .process_with_scratch(&mut force, &mut force_spectrum, &mut scratch)
            .and_then(|()| transform.process_with_scratch(&mut motion, &mut motion_spectrum, &mut scratch));
        // It fails for other lengths than planned only; the caller has checked that all hits are of one length.
        debug_assert!(transformed.is_ok());
        for (line, (f, a)) in force_spectrum.iter().zip(&motion_spectrum).enumerate() {
            let (power, cross) = (f.norm_sqr(), f.conj() * a);
            sums.force[line] += power;
            sums.motion[line] += a.norm_sqr();
            sums.cross[line] += cross;
            sums.weighted.force[line] += power * power;
            sums.weighted.motion[line] += power * a.norm_sqr();
            sums.weighted.cross[line] += power * cross;
        }
    }
    sums
}

/// Samples before the hit from which an offset can be told.
const LEAST_REST: usize = 8;

/// Offset of the acceleration's channel: its mean before the hit, where that stands out of its own noise; else zero.
///
/// The mean over the whole record would hold the piece's own motion, which a window then smears over the lowest lines;
/// the mean of a few noisy samples would add an offset where there was none.
fn rest_before(hit: &Hit, offset: f64, height: f64) -> f64 {
    let begins = hit.force.iter().position(|force| (force - offset).abs() > 0.01 * height.abs()).unwrap_or(0);
    let before = hit.acceleration.get(..begins).unwrap_or_default();
    if before.len() < LEAST_REST {
        return 0.0;
    }
    let count = before.len() as f64;
    let mean = before.iter().sum::<f64>() / count;
    let variance = before.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    if mean.abs() > 5.0 * (variance / count).sqrt() { mean } else { 0.0 }
}
