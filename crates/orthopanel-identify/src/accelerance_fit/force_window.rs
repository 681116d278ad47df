//! How a force window ties the force's noise together, and the sums over lines in which it comes into a fit.

use faer::Mat;
use num_complex::Complex64;

use super::line_block::BLOCK;
use super::line_group::LineGroup;
use super::records::PlaceRecord;
use super::tied_noise::TiedNoise;
use super::weighted_rows::WeightedRows;

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
