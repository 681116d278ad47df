//! How a force window ties the force's noise together, and the sums over lines in which it comes into a fit.

use faer::Mat;
use num_complex::Complex64;
use orthopanel_data::{Accelerance, ForceNoise};

use super::line_block::BLOCK;
use super::line_group::LineGroup;
use super::records::PlaceRecord;
use super::weighted_rows::WeightedRows;

/// The noise of the force under a window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TiedNoise {
    /// Half the window's width \[s\].
    half_width: f64,
    /// The part of each line's variance that comes from it.
    pub variance: Vec<f64>,
    /// The rest of it, independent from line to line.
    pub independent: Vec<f64>,
}

/// Lines on either side over which the scatter of the hits is held against what their channels tell.
const HALF_WINDOW: usize = 200;

impl TiedNoise {
    /// At these of the lines.
    pub(super) fn of(noise: &ForceNoise, accelerance: &Accelerance, lines: &[usize]) -> Self {
        let level = match &accelerance.variance {
            Some(scatter) if accelerance.hits > 1 => level(noise, scatter),
            _ => vec![1.0; noise.independent.len()],
        };
        let at = |of: &[f64]| lines.iter().map(|&line| of.get(line).copied().unwrap_or_default()).collect::<Vec<f64>>();
        let mut independent = at(&noise.independent);
        independent.iter_mut().zip(at(&level)).for_each(|(own, level)| *own = (*own * level).max(f64::MIN_POSITIVE));
        Self { half_width: noise.half_width, variance: at(&noise.variance), independent }
    }

    /// Times at which noise under the window enters, from its middle \[s\]: between any two of them lie less than half a period of
    /// the highest line, so that no two lines, nor a line and another's mirror image at negative frequency, look alike.
    fn times(&self, band: f64) -> Vec<f64> {
        let count = (5.0 * self.half_width * band).ceil().max(1.0);
        (0..=count as usize).map(|time| (2.0 * time as f64 / count - 1.0) * self.half_width).collect()
    }
}

/// The scatter of the hits over what their channels tell of it, averaged over neighbours; lines that the force's noise makes
/// count little, since that wanders together with all its neighbours'.
fn level(noise: &ForceNoise, scatter: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0)];
    for ((tied, independent), scatter) in noise.variance.iter().zip(&noise.independent).zip(scatter) {
        let (seen, told) = sums.last().copied().unwrap_or_default();
        let all = tied + independent;
        // Relative to what is told, so that strong lines count no more than weak ones.
        let weight = (independent / all).powi(2);
        let counts = scatter.is_finite() && weight.is_finite();
        sums.push(if counts { (seen + weight * scatter / all, told + weight) } else { (seen, told) });
    }
    let count = sums.len() - 1;
    (0..count)
        .map(|line| {
            let (from, to) = (line.saturating_sub(HALF_WINDOW), (line + HALF_WINDOW + 1).min(count));
            let (seen, told) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
            if told > 0.0 { seen / told } else { 1.0 }
        })
        .collect()
}

/// The tied noise of a record as unit impulses.
///
/// The noise under a window of half width $h$ is $H_k\epsilon_k$ with $\epsilon_k \propto \sum_m\nu_me^{-j\omega_kt_m}$ and independent
/// $\nu_m$ at $M$ times $|t_m|\le h$. Into the residuals over the noise, of weights $w_k$, it comes as $\sum_m\nu_mu_m$ with $\nu_m$ of
/// variance one and $u_m = y_ke^{-j\omega_kt_m}$, $y_k = w_kH_k\sqrt{v_k/M}\,/|\hat H_k|$.
pub(super) struct Impulses<'a> {
    pub record: &'a PlaceRecord,
    half_width: f64,
    times: Vec<f64>,
    /// $y_k$.
    strengths: Vec<Complex64>,
}

impl<'a> Impulses<'a> {
    /// With $H_k$ as a model has it.
    pub(super) fn of(record: &'a PlaceRecord, noise: &TiedNoise, model: &[Complex64]) -> Self {
        let times = noise.times(record.band_end());
        let part = 1.0 / times.len() as f64;
        let weights = (0..record.value.len()).step_by(BLOCK).flat_map(|from| record.weights(from));
        let sizes = record.value.iter().map(|value| value.norm().max(f64::MIN_POSITIVE));
        let lines = weights.zip(&noise.variance).zip(sizes).zip(model);
        let strengths = lines.map(|(((weight, tied), size), model)| model * (weight * (part * tied).sqrt() / size));
        Self { record, half_width: noise.half_width, strengths: strengths.collect(), times }
    }

    /// The lines from one on, up to another at most, that make up one group.
    fn group(&self, from: usize, to: usize) -> LineGroup {
        let count = LineGroup::count(&self.record.frequency[from..to], self.half_width);
        let lines = from..from + count;
        LineGroup::of(&self.record.frequency[lines.clone()], &self.strengths[lines], self.half_width)
    }

    /// $u_m^T[J\,r]$, a row a time. Each block of rows is handed to `each` too, with its first line.
    pub(super) fn of_rows(&self, mut rows: WeightedRows, mut each: impl FnMut(&Mat<f64>, usize)) -> Mat<f64> {
        let mut sums = Mat::zeros(self.times.len(), rows.size());
        for from in (0..self.strengths.len()).step_by(BLOCK) {
            let block = rows.block(from);
            each(block, from);
            let (mut first, to) = (from, self.strengths.len().min(from + BLOCK));
            while first < to {
                let group = self.group(first, to);
                let [re, im] = [0, BLOCK].map(|part| block.subrows(part + first - from, group.size()));
                group.add_to(&self.times, (re, im), &mut sums);
                first += group.size();
            }
        }
        sums
    }

    /// $u_m^Tu_n$.
    pub(super) fn among(&self) -> Mat<f64> {
        let count = self.times.len();
        let step = self.times.get(1).zip(self.times.first()).map_or(0.0, |(second, first)| second - first);
        let (mut by_distance, mut first) = (vec![0.0; count], 0);
        while first < self.strengths.len() {
            let group = self.group(first, self.strengths.len());
            group.add_powers(step, &mut by_distance);
            first += group.size();
        }
        Mat::from_fn(count, count, |m, n| by_distance[m.abs_diff(n)])
    }
}
