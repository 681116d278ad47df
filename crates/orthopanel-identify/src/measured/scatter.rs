//! By how much lines differ from anything that poles make of them, beyond the noise that their record shows.
//!
//! A panel that warms up, a force that is not linear, a sensor that slips: what a line misses by then grows with its size. Its variance
//! is taken as
//! $$\sigma_k^2 + \kappa^2|H_k|^2,$$
//! with one $\kappa$ a test, which is zero where noise explains what the strongest resonances leave.

use std::f64::consts::LN_2;

use num_complex::Complex64;
use rayon::prelude::*;

use super::joint_fit::Found;
use super::lines::RecordLines;
use super::medians::{NEIGHBOURS, about, median};
use super::modal_fit::ModalFit;

/// What a line misses, in units of its noise, and its size in the same units; both squared.
struct Line {
    missed: f64,
    size: f64,
}

/// Misfit per datum up to which noise is said to explain it.
const BY_NOISE: f64 = 2.0;

/// The weights of all records by their noise alone, and the scatter beyond it.
pub(super) struct Scatter {
    noise: Vec<Vec<f64>>,
    kappa2: f64,
}

impl Scatter {
    /// The most that resonances leave, by which the records are weighed from then on: a search that begins so finds what stands out of every
    /// real panel's scatter before any line is trusted to its noise.
    pub(super) fn most(records: &mut [RecordLines]) -> Self {
        let noise = records.iter().map(|record| record.weight.clone()).collect();
        let scatter = Self { noise, kappa2: MOST * MOST };
        scatter.weigh(records);
        scatter
    }

    /// Whether what a fit leaves wants another scatter, with which the records are weighed from then on.
    pub(super) fn follows(&mut self, records: &mut [RecordLines], found: &Found) -> bool {
        let fit = ModalFit::new(records, &found.poles);
        let left = fit.residuals(&found.poles, &found.fitted);
        let kappa2 = scatter(&telling(records, &self.noise, &left));
        let changes = kappa2.max(self.kappa2) > SETTLED * kappa2.min(self.kappa2);
        self.kappa2 = kappa2;
        self.weigh(records);
        changes
    }

    /// Weighs each line by what its neighbours are missed by, where that is more than their weights say: a file that does not tell its noise has little
    /// where the panel moves and much where the hammer has no force left.
    pub(super) fn settles(records: &mut [RecordLines], found: &Found) {
        let left = ModalFit::new(records, &found.poles).residuals(&found.poles, &found.fitted);
        records.par_iter_mut().zip(&left).for_each(|(record, left)| {
            for (line, weight) in record.weight.iter_mut().enumerate() {
                let near = left[about(line, NEIGHBOURS, left.len())].iter().map(|left| 0.5 * left.norm_sqr());
                *weight /= (record.per_datum * mean_square(near)).max(1.0).sqrt();
            }
        });
    }

    /// Of the lines that are left of the records.
    pub(super) fn cut(&mut self, records: &[RecordLines]) {
        self.noise.iter_mut().zip(records).for_each(|(noise, record)| noise.truncate(record.s.len()));
    }

    fn weigh(&self, records: &mut [RecordLines]) {
        for (record, noise) in records.iter_mut().zip(&self.noise) {
            for ((weight, noise), value) in record.weight.iter_mut().zip(noise).zip(&record.value) {
                *weight = noise / (1.0 + self.kappa2 * size(*value, *noise)).sqrt();
            }
        }
    }
}

/// What resonances of real panels leave: where more is left, poles are missing or the panel is not linear, which [`MeasuredModes::chi_square`](super::MeasuredModes::chi_square)
/// says.
const MOST: f64 = 0.03;
/// A variance that changes by less is settled.
const SETTLED: f64 = 1.2;

/// $|H|^2/\sigma^2$, where $g$ is the reciprocal deviation of either part.
fn size(value: Complex64, weight: f64) -> f64 {
    0.5 * (weight * value).norm_sqr()
}

/// The lines whose noise is below the most that resonances leave, which alone can show it, with residuals in units of the noise alone.
fn telling(records: &[RecordLines], noise: &[Vec<f64>], left: &[Vec<Complex64>]) -> Vec<Line> {
    let of_record = |((record, noise), left): ((&RecordLines, &Vec<f64>), &Vec<Complex64>)| {
        let line = |k: usize| Line {
            missed: 0.5 * record.per_datum * (left[k] * (noise[k] / record.weight[k])).norm_sqr(),
            size: record.per_datum * size(record.value[k], noise[k]),
        };
        (0..noise.len()).map(line).filter(|line| MOST * MOST * line.size > 1.0).collect::<Vec<_>>()
    };
    records.iter().zip(noise).zip(left).flat_map(of_record).collect()
}

/// $\kappa^2$ at which the median line misses by as much as it should; modes that are not found yet, a few lines each, do not raise it.
fn scatter(lines: &[Line]) -> f64 {
    let of = |kappa2: f64| mean_square(lines.iter().map(|line| line.missed / (1.0 + kappa2 * line.size)));
    if of(0.0) < BY_NOISE {
        return 0.0;
    }
    let [mut low, mut high] = [1e-12, MOST * MOST];
    for _ in 0..40 {
        let middle = (low * high).sqrt();
        *if of(middle) > 1.0 { &mut low } else { &mut high } = middle;
    }
    high
}

/// The mean of squares of a complex Gaussian by their median, which is $\ln 2$ of it.
fn mean_square(squares: impl Iterator<Item = f64>) -> f64 {
    median(squares) / LN_2
}
