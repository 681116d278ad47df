//! Accelerances on $s = \sigma + j\omega$: peaks widened as far as a search needs, without leakage.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use num_complex::Complex64;
use orthopanel_data::{Hit, TimeHistory};
use orthopanel_model::Place;
use rayon::prelude::*;
use realfft::RealFftPlanner;

use super::hit_noise::HitNoise;
use super::hit_places::align;
use super::line_noise::LineNoise;
use super::reactions::blow::Blow;

/// How far the peaks are widened, and how far the lines stand apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Widening {
    /// $\sigma$ \[1/s\].
    pub decay_rate: f64,
    /// Distance of the lines \[Hz\].
    pub step: f64,
    /// Part of every line that a hypothesis may miss beside the noise: a search that is far from its minimum would else
    /// follow the strongest line of all alone.
    pub tolerance: f64,
}

/// From peaks so wide that a search cannot lock between two, to those that show all there is.
pub(super) const WIDENINGS: [Widening; 4] = [
    Widening { decay_rate: 200.0, step: 48.0, tolerance: 0.03 },
    Widening { decay_rate: 50.0, step: 16.0, tolerance: 0.003 },
    Widening { decay_rate: 15.0, step: 6.0, tolerance: 0.0 },
    Widening { decay_rate: 6.0, step: 3.0, tolerance: 0.0 },
];

/// Half-widths of that window on either side from which its channel's noise is read.
const BESIDE: usize = 25;
/// Median of a normal deviate's size over its standard deviation.
const MEDIAN_OF_NORMAL: f64 = 0.6745;

/// Accelerance of one pair of places at one widening.
#[derive(Debug, Clone)]
pub(super) struct WidenedLines {
    pub force_at: Place,
    pub response_at: Place,
    /// $s = \sigma + j\omega$ of each line.
    pub s: Vec<Complex64>,
    /// Accelerance \[(m/s²)/N\].
    pub value: Vec<Complex64>,
    /// $E|\hat H - H|^2$ of each line.
    pub variance: Vec<f64>,
    /// What of it the force's channel makes; empty where that is not told.
    pub by_force: Vec<f64>,
    /// Scatter of the hits about their mean over what noise alone makes; `None` for a single hit.
    pub scatter: Option<f64>,
    /// Each hit by itself.
    pub hits: Vec<HitLines>,
    /// See [`WidenedLines::noise`]: every evaluation asks for it.
    pub noise: OnceLock<LineNoise>,
}

impl WidenedLines {
    /// Distance of the lines \[Hz\].
    pub(super) fn step(&self) -> f64 {
        match self.s[..] {
            [first, second, ..] => (second - first).im / TAU,
            _ => f64::INFINITY,
        }
    }

    /// What noise these lines have.
    pub(super) fn noise(&self) -> &LineNoise {
        self.noise.get_or_init(|| LineNoise::of(&self.value, [&self.variance, &self.by_force], self.step()))
    }

    /// Adds to the variance of each line of each hit what is its own, and to that of the mean of the hits what this leaves there.
    pub(super) fn widen_hits(&mut self, by: &[Vec<f64>]) {
        for line in 0..self.s.len() {
            let weights: f64 = self.hits.iter().map(|hit| hit.weight[line]).sum();
            for (hit, by) in self.hits.iter_mut().zip(by) {
                let part = hit.weight[line] / weights;
                self.variance[line] += part * part * by[line];
                hit.variance[line] += by[line];
            }
        }
        self.noise.take();
        self.hits.iter_mut().for_each(|hit| drop(hit.noise.take()));
    }

    /// Adds to the variance of each line and of its hits.
    pub(super) fn widen(&mut self, by: impl Fn(&Self, usize) -> f64) {
        for line in 0..self.s.len() {
            let by = by(self, line);
            self.variance[line] += by;
            self.hits.iter_mut().for_each(|hit| hit.variance[line] += by);
        }
        self.noise.take();
        self.hits.iter_mut().for_each(|hit| drop(hit.noise.take()));
    }
}

impl HitLines {
    /// As [`WidenedLines::noise`], of lines `step` \[Hz\] apart.
    pub(super) fn noise(&self, step: f64) -> &LineNoise {
        self.noise.get_or_init(|| LineNoise::of(&self.value, [&self.variance, &self.by_force], step))
    }
}

/// One hit's own accelerance on the same lines.
#[derive(Debug, Clone, Default)]
pub(super) struct HitLines {
    pub value: Vec<Complex64>,
    /// What each line weighs in the mean of the record's hits, whatever its variance becomes later.
    pub weight: Vec<f64>,
    pub variance: Vec<f64>,
    /// What of it the force's channel makes.
    pub by_force: Vec<f64>,
    /// Transform of the force, a sum over samples \[N\].
    pub force: Vec<Complex64>,
    /// See [`HitLines::noise`].
    pub noise: OnceLock<LineNoise>,
}

/// The lines of every record at one widening, up to `band` \[Hz\].
pub(super) fn widened_lines(histories: &[TimeHistory], widening: Widening, band: f64) -> Vec<WidenedLines> {
    histories.par_iter().map(|history| of_record(history, widening, band, None).0).collect()
}

/// The same with all hits of a record brought to the place that they hit in the mean, see [`align`], and by how much each was
/// beside that \[m\]. `told` tells of a record, by its number and its hits' forces on all lines, what [`align`] wants to know.
///
/// # Errors
/// What `told` refuses.
pub(super) fn aligned_lines<E: Send>(
    histories: &[TimeHistory],
    widening: Widening,
    band: f64,
    told: impl Fn(usize, &WidenedLines) -> Result<HitModel, E> + Sync,
) -> Result<Vec<(WidenedLines, Vec<f64>)>, E> {
    let records = histories.par_iter().enumerate().map(|(index, history)| {
        let told = told(index, &every_line(history, widening, band))?;
        Ok(of_record(history, widening, band, Some(&told)))
    });
    records.collect()
}

/// What a model tells of the hits of a record, on all lines.
pub(super) struct HitModel {
    /// $\partial H/\partial x$ by the place of the force.
    pub by_place: Vec<Complex64>,
    /// What forces that are not linear take off each hit; empty where there are none.
    pub taken: Vec<Vec<Complex64>>,
}

/// The forces of all hits on every line below the band, without the motions.
fn every_line(history: &TimeHistory, widening: Widening, band: f64) -> WidenedLines {
    let (s, _) = lines_of(history, widening, band);
    let of_hit = |hit: &Hit| {
        let mut force = spectra(hit, history.rate, widening.decay_rate).force;
        force.truncate(s.len());
        HitLines { weight: vec![1.0; s.len()], variance: vec![1.0; s.len()], force, ..HitLines::default() }
    };
    WidenedLines {
        force_at: history.force_at,
        response_at: history.response_at,
        hits: history.hits.iter().map(of_hit).collect(),
        s,
        value: vec![],
        variance: vec![],
        by_force: vec![],
        scatter: None,
        noise: OnceLock::new(),
    }
}

/// Both channels' transforms of one hit.
pub(super) struct HitSpectra {
    pub force: Vec<Complex64>,
    pub motion: Vec<Complex64>,
    /// Variance of a line of the force by its channel's noise.
    pub force_noise: f64,
    /// Variance of a sample of the motion before the blow \[(m/s²)²\], where the record tells it.
    pub motion_noise: Option<f64>,
}

/// Every line of the transforms below `band`, from 0, and their distance \[Hz\].
fn lines_of(history: &TimeHistory, widening: Widening, band: f64) -> (Vec<Complex64>, f64) {
    let samples = history.hits.first().map_or(0, |hit| hit.force.len()).max(1);
    let resolution = history.rate / samples as f64;
    let end = ((band / resolution) as usize).min(samples / 2);
    ((0..end).map(|line| Complex64::new(widening.decay_rate, TAU * resolution * line as f64)).collect(), resolution)
}

fn of_record(
    history: &TimeHistory,
    widening: Widening,
    band: f64,
    told: Option<&HitModel>,
) -> (WidenedLines, Vec<f64>) {
    let mut spectra: Vec<HitSpectra> =
        history.hits.iter().map(|hit| spectra(hit, history.rate, widening.decay_rate)).collect();
    let (all, resolution) = lines_of(history, widening, band);
    let end = all.len();
    let beside = told.map_or_else(Vec::new, |told| align(&mut spectra, (&told.by_place, &told.taken)));
    let noise = HitNoise::of(&spectra, end);
    let stride = (widening.step / resolution).round().max(1.0) as usize;
    let lines: Vec<usize> = (stride.max(1)..=end).step_by(stride).collect();
    let mut record = WidenedLines {
        force_at: history.force_at,
        response_at: history.response_at,
        s: lines.iter().map(|&line| Complex64::new(widening.decay_rate, TAU * resolution * line as f64)).collect(),
        value: Vec::with_capacity(lines.len()),
        variance: Vec::with_capacity(lines.len()),
        by_force: Vec::with_capacity(lines.len()),
        scatter: noise.scatter(&spectra, &lines),
        hits: vec![HitLines::default(); spectra.len()],
        noise: OnceLock::new(),
    };
    for &line in &lines {
        let (mut cross, mut power, mut by_force) = (Complex64::ZERO, 0.0, 0.0);
        for (index, (hit, own)) in spectra.iter().zip(&mut record.hits).enumerate() {
            let (force, motion) = (hit.force[line], hit.motion[line]);
            let [variance, of_force] = noise.at(index, force, motion);
            let weight = force.norm_sqr() / variance;
            by_force += weight * of_force / variance;
            cross += weight * motion / force;
            power += weight;
            own.value.push(motion / force);
            own.weight.push(weight);
            own.variance.push(1.0 / weight);
            own.by_force.push(of_force / force.norm_sqr());
            own.force.push(force);
        }
        let value = cross / power;
        record.value.push(value);
        record.by_force.push(by_force / (power * power));
        record.variance.push(1.0 / power + widening.tolerance.powi(2) * value.norm_sqr());
    }
    (record, beside)
}

/// Transforms of one hit, each channel times $e^{-\sigma(t-t_0)}$ with $t_0$ the hit.
fn spectra(hit: &Hit, rate: f64, decay_rate: f64) -> HitSpectra {
    let samples = hit.force.len();
    let blow = Blow::of(hit, rate);
    let Blow { peak, offset, reach, .. } = blow;
    let fading = |n: usize| (-decay_rate * (n as f64 - peak as f64) / rate).exp();
    let near = |n: usize| blow.holds(n);
    let mut force: Vec<f64> =
        blow.force.iter().enumerate().map(|(n, f)| if near(n) { f * fading(n) } else { 0.0 }).collect();
    force.resize(samples, 0.0);
    let mut motion: Vec<f64> = hit.acceleration.iter().enumerate().map(|(n, a)| a * fading(n)).collect();
    // Read beside the hit: a window over the record would have faded it later.
    let beside = peak.saturating_sub(BESIDE * reach)..(peak + BESIDE * reach).min(samples);
    let quiet: Vec<f64> = beside.filter(|&n| !near(n)).map(|n| (hit.force[n] - offset).abs()).collect();
    let deviation = median(&quiet) / MEDIAN_OF_NORMAL;
    let windowed: f64 = (0..samples).filter(|&n| near(n)).map(|n| fading(n).powi(2)).sum();
    let force_noise = deviation * deviation * windowed;
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(samples);
    let (mut f, mut a) = (transform.make_output_vec(), transform.make_output_vec());
    // Lengths are the plan's own, so neither can fail; were it to, the lines would be zero and weigh nothing.
    let done = transform.process(&mut force, &mut f).and_then(|()| transform.process(&mut motion, &mut a));
    debug_assert!(done.is_ok());
    let motion_noise = hit.noise_before_blow().map(|noise| noise.acceleration * noise.acceleration);
    HitSpectra { force: f, motion: a, force_noise, motion_noise }
}

pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    if sorted.is_empty() {
        return 0.0;
    }
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One line of two hits, of which the first was four times as hard.
    fn record() -> WidenedLines {
        let place = Place { x: 0.0, y: 0.0 };
        let hit = |weight: f64| HitLines {
            value: vec![Complex64::ONE],
            weight: vec![weight],
            variance: vec![1.0 / weight],
            by_force: vec![0.0],
            force: vec![Complex64::ONE],
            noise: OnceLock::new(),
        };
        WidenedLines {
            force_at: place,
            response_at: place,
            s: vec![Complex64::I],
            value: vec![Complex64::ONE],
            variance: vec![1.0 / 20.0],
            by_force: vec![],
            scatter: None,
            hits: vec![hit(16.0), hit(4.0)],
            noise: OnceLock::new(),
        }
    }

    /// The mean of the hits has been taken: what is told of them later moves no weight in it.
    #[test]
    fn val_what_hits_err_by_comes_into_their_mean_as_they_were_weighed() {
        let mut record = record();
        record.widen_hits(&[vec![0.5], vec![0.1]]);
        assert_eq!((record.hits[0].variance[0], record.hits[1].variance[0]), (1.0 / 16.0 + 0.5, 0.25 + 0.1));
        assert!((record.variance[0] - (0.05 + 0.64 * 0.5 + 0.04 * 0.1)).abs() < 1e-15, "{}", record.variance[0]);
        record.widen(|_, _| 1.0);
        assert_eq!((record.hits[0].weight[0], record.hits[1].weight[0]), (16.0, 4.0));
    }
}
