//! How a force window ties the force's noise together, and what that does to the deviations of a fit.

use std::f64::consts::TAU;

use faer::Mat;
use num_complex::Complex64;
use orthopanel_data::ForceNoise;
use orthopanel_model::ModelError;
use rayon::prelude::*;

use super::line_block::BLOCK;
use super::problem::{AcceleranceProblem, WeightedRows, model_lines};
use super::records::PlaceRecord;
use crate::least_squares::Quadratic;

/// The noise of the force under a window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TiedNoise {
    /// Half the window's width \[s\].
    half_width: f64,
    /// The part of each line's variance that comes from it.
    pub variance: Vec<f64>,
}

impl TiedNoise {
    /// At these of the lines.
    pub(super) fn of(noise: &ForceNoise, lines: &[usize]) -> Self {
        let variance = lines.iter().map(|&line| noise.variance.get(line).copied().unwrap_or_default()).collect();
        Self { half_width: noise.half_width, variance }
    }

    /// Times at which noise under the window enters, from its start \[s\]: four a period of the highest line, since what
    /// they are summed for is a square.
    fn times(&self, band: f64) -> Vec<f64> {
        let count = (8.0 * self.half_width * band).ceil().max(1.0);
        (0..=count as usize).map(|time| (2.0 * time as f64 / count - 1.0) * self.half_width).collect()
    }
}

impl AcceleranceProblem {
    /// The covariance of the parameters at a minimum; `None` where it is singular.
    ///
    /// With $A = J^TWJ$ and noise of covariance $C$ it is $A^{-1}J^TWCWJA^{-1}$, which for independent lines is $A^{-1}$. The
    /// noise of the force under a window of half width $h$ is $H_k\epsilon_k$ with
    /// $\epsilon_k \propto \sum_{|t|\le h}\nu(t)e^{-j\omega_kt}$, hence it adds
    /// $$\frac1M\sum_{m=1}^M g(t_m)g(t_m)^T,\qquad g(t) = \sum_k w_k\,\mathrm{Re}\,\Big(\overline{\partial H_k}\;
    /// \frac{H_k}{|H_k|}\sqrt{v_k}\,e^{-j\omega_kt}\Big)$$
    /// in place of the same variance $v_k$ of independent lines.
    pub(super) fn covariance(&self, parameters: &[f64], at: &Quadratic) -> Result<Option<Mat<f64>>, ModelError> {
        let Some(inverse) = at.covariance() else { return Ok(None) };
        let mut added = Quadratic::zero(self.size());
        let mut any = false;
        for (index, piece) in self.pieces.iter().enumerate() {
            if piece.records.iter().all(|record| record.tied.is_none()) {
                continue;
            }
            any = true;
            let derivatives = self.derivatives(index, parameters)?;
            let parts: Vec<Mat<f64>> = piece
                .records
                .par_iter()
                .zip(&derivatives.models)
                .filter_map(|(record, model)| {
                    let lines = model_lines(record, model);
                    let rows = WeightedRows::of(record, model, &derivatives.chain);
                    Some(tied_less_independent(record, record.tied.as_ref()?, &lines, rows))
                })
                .collect();
            parts.iter().for_each(|part| added.add_products(part, &derivatives.columns));
        }
        added.mirror();
        Ok(Some(if any { &inverse + &inverse * &added.normal * &inverse } else { inverse }))
    }
}

/// $J^TWCWJ$ of the tied noise, less what the same variance of independent lines makes; a last row and column for the residual.
fn tied_less_independent(
    record: &PlaceRecord,
    noise: &TiedNoise,
    model: &[Complex64],
    mut rows: WeightedRows,
) -> Mat<f64> {
    let times = noise.times(record.band_end());
    let size = rows.size();
    let (mut impulses, mut independent) = (Mat::<f64>::zeros(times.len(), size), Mat::<f64>::zeros(size, size));
    let step = times.get(1).zip(times.first()).map_or(0.0, |(second, first)| second - first);
    for from in (0..record.value.len()).step_by(BLOCK) {
        let weights = record.weights(from);
        let own = rows.block(from);
        let mut enters = Mat::<f64>::zeros(times.len(), 2 * BLOCK);
        let mut scaled = own.clone();
        let lines = record.frequency.iter().zip(&record.variance).zip(&noise.variance).zip(model);
        for (at, (((frequency, all), tied), value)) in lines.skip(from).take(BLOCK).enumerate() {
            let share = (tied / all).min(1.0).sqrt();
            for column in 0..size {
                scaled[(at, column)] *= share;
                scaled[(BLOCK + at, column)] *= share;
            }
            let strength = weights[at] * tied.sqrt() / value.norm().max(f64::MIN_POSITIVE);
            let turn = |time: f64| Complex64::from_polar(1.0, -TAU * frequency * time);
            let (mut now, onwards) = (value * strength * turn(-noise.half_width), turn(step));
            for time in 0..times.len() {
                (enters[(time, at)], enters[(time, BLOCK + at)]) = (now.re, now.im);
                now *= onwards;
            }
        }
        impulses += &enters * own;
        independent += scaled.transpose() * &scaled;
    }
    impulses.transpose() * &impulses * faer::Scale(1.0 / times.len() as f64) - independent
}
