//! Spectra of one hit, and their sums over hits.

use num_complex::Complex64;

use super::{blow::Blow, hit::Hit, noise_power::NoisePower, transforms::Transforms, window::Window};

/// Sums over hits of $|F|^2$, $|A|^2$ and $\bar F A$, line by line from 0 to half the rate.
pub(super) struct Sums {
    pub(super) force: Vec<f64>,
    pub(super) motion: Vec<f64>,
    pub(super) cross: Vec<Complex64>,
    /// $|F|^2$ of each hit.
    pub(super) powers: Vec<Vec<f64>>,
    /// Sums of $|F|^2|A|^2$ and $|F|^2\bar F A$.
    weighted: (Vec<f64>, Vec<Complex64>),
    /// $A/F$ of each hit at every line whose number `stride` divides.
    pub(super) quotients: Vec<Vec<Complex64>>,
    pub(super) stride: usize,
    /// Lines over which the window ties the force's noise together.
    pub(super) tied: f64,
    /// Noise of every hit; `None` where one does not tell it.
    pub(super) noise: Option<Vec<NoisePower>>,
}

impl Sums {
    fn add(&mut self, force: &[Complex64], motion: &[Complex64]) {
        let spectra = force.iter().zip(motion);
        let sums = self.force.iter_mut().zip(&mut self.motion).zip(&mut self.cross);
        let weighted = self.weighted.0.iter_mut().zip(&mut self.weighted.1);
        let mut powers = vec![0.0; force.len()];
        for ((((f, a), own), sums), weighted) in spectra.zip(&mut powers).zip(sums).zip(weighted) {
            let (power, of_motion, cross) = (f.norm_sqr(), a.norm_sqr(), f.conj() * a);
            *own = power;
            *sums.0.0 += power;
            *sums.0.1 += of_motion;
            *sums.1 += cross;
            *weighted.0 += power * of_motion;
            *weighted.1 += power * cross;
        }
        self.powers.push(powers);
        let sampled = force.iter().zip(motion).step_by(self.stride);
        self.quotients.push(sampled.map(|(f, a)| a / f).collect());
    }

    /// Sums of $|F|^4$, $|F|^2|A|^2$ and $|F|^2\bar F A$ at a line.
    pub(super) fn weighted(&self, line: usize) -> (f64, f64, Complex64) {
        let force4 = self.powers.iter().map(|power| power[line] * power[line]).sum();
        (force4, self.weighted.0[line], self.weighted.1[line])
    }
}

/// Lines at which hits are held against one another, at most.
const MOST_SAMPLED: usize = 2048;

/// Sums the spectra of `hits`, all of length `samples`.
pub(super) fn sums(hits: &[&Hit], samples: usize, window: Window, rate: f64) -> Sums {
    let mut transforms = Transforms::default();
    let lines = samples / 2 + 1;
    let mut sums = Sums {
        force: vec![0.0; lines],
        motion: vec![0.0; lines],
        cross: vec![Complex64::default(); lines],
        powers: Vec::with_capacity(hits.len()),
        weighted: (vec![0.0; lines], vec![Complex64::default(); lines]),
        quotients: Vec::with_capacity(hits.len()),
        stride: lines.div_ceil(MOST_SAMPLED).max(1),
        tied: window.force_half_width().map_or(1.0, |half| samples as f64 / (2.0 * half * rate)).max(1.0),
        noise: None,
    };
    let mut noise = Vec::with_capacity(hits.len());
    for hit in hits {
        // The hammer is off the piece nearly all the time, so the median is its channel's offset; the mean is not,
        // for it holds the impulse.
        let blow = hit.blow();
        let rest = rest_before(hit, &blow);
        let mut force: Vec<f64> = hit.force.iter().map(|value| value - blow.offset).collect();
        let mut motion: Vec<f64> = hit.acceleration.iter().map(|value| value - rest).collect();
        window.apply(&mut force, &mut motion, &blow, rate);
        sums.add(&transforms.lines(force), &transforms.lines(motion));
        noise.push(hit.noise_before(&blow));
    }
    if let [first, ..] = hits {
        sums.noise = NoisePower::of(&noise, windowed(first, window, rate));
    }
    sums
}

/// Sums of the squared windows over force and acceleration, by which white noise comes into a line.
fn windowed(hit: &Hit, window: Window, rate: f64) -> [f64; 2] {
    if window == Window::None {
        return [hit.force.len() as f64; 2];
    }
    let mut channels = [vec![1.0; hit.force.len()], vec![1.0; hit.force.len()]];
    let [force, acceleration] = &mut channels;
    window.apply(force, acceleration, &hit.blow(), rate);
    channels.map(|weights| weights.iter().map(|weight| weight * weight).sum())
}

/// Samples before the hit from which an offset can be told.
const LEAST_REST: usize = 8;

/// Offset of the acceleration's channel: its mean before the hit, where that stands out of its own noise; else zero.
///
/// The mean over the whole record would hold the piece's own motion, which a window then smears over the lowest lines;
/// the mean of a few noisy samples would add an offset where there was none.
fn rest_before(hit: &Hit, blow: &Blow) -> f64 {
    let first = |force: &f64| (force - blow.offset).abs() > 0.01 * blow.height.abs();
    let begins = hit.force.iter().position(first).unwrap_or(0);
    let before = hit.acceleration.get(..begins).unwrap_or_default();
    if before.len() < LEAST_REST {
        return 0.0;
    }
    let count = before.len() as f64;
    let mean = before.iter().sum::<f64>() / count;
    let variance = before.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    if mean.abs() > 5.0 * (variance / count).sqrt() { mean } else { 0.0 }
}
