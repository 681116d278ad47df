//! How far hypotheses are from the measured modes, in units of noise and of the model error of the chosen one.

use std::ops::Range;

use faer::Mat;

use crate::comparison::Comparison;
use crate::outcome::FittedError;
use crate::posterior::{Following, Judged, Point, Posterior, Problem};
use crate::search::Inquiry;
use crate::stacked::Block;
use crate::whitening::Whitening;

use super::left_out::{LeftOut, Linear};

/// Steps that a hypothesis is given to come as near as it can, and the gain from which one more is worth while.
const STEPS: usize = 12;
const GAIN: f64 = 0.05;

/// The covariance of the chosen hypothesis, with which all are judged, and what is left out together.
pub(super) struct Yardstick {
    by: Whitening,
    /// $W$ with $C^{-1} = W^TW$.
    inverse_factor: Mat<f64>,
    groups: Vec<Vec<usize>>,
}

impl Yardstick {
    /// `None` where the model has no meaning there.
    pub(super) fn of(problem: &Problem, posterior: &Posterior) -> Option<Self> {
        let errors = problem.errors(&posterior.point.at);
        let by = problem.whitening(&errors, &posterior.log_sizes)?;
        let size = posterior.point.at.values.len();
        let mut inverse_factor = Mat::identity(size, size);
        by.whiten(&mut inverse_factor);
        let stacked = problem.stacked;
        let of_block = |(range, block): (Range<usize>, &Block)| {
            let groups = groups(block.comparison());
            groups.into_iter().map(move |group| group.into_iter().map(|place| range.start + place).collect())
        };
        let groups = stacked.ranges().zip(&stacked.blocks).flat_map(of_block).collect();
        Some(Self { by, inverse_factor, groups })
    }

    /// The error of a hypothesis as near as it comes under this covariance, which need not be its own.
    pub(super) fn nearest(&self, problem: &Problem, judged: &Judged) -> Option<FittedError> {
        let (point, _) =
            problem.follow(judged.posterior.point.clone(), &self.by, Following::to_the_end(STEPS, GAIN))?;
        self.error(problem, &point)
    }

    /// The error at a point: rms over all values, and what is foretold of each group by the others, to first order.
    pub(super) fn error(&self, problem: &Problem, point: &Point) -> Option<FittedError> {
        let fitted = self.fitted(problem, point);
        let left_out = self.linear(problem, point)?.left_out(&self.groups)?;
        let mean_square = |(left_out, group): (LeftOut, &Vec<usize>)| left_out.square / group.len().max(1) as f64;
        let sum: f64 = left_out.into_iter().zip(&self.groups).map(mean_square).sum();
        Some(FittedError { fitted, held_out: (sum / self.groups.len().max(1) as f64).sqrt() })
    }

    /// Rms of what is missed of all values.
    pub(super) fn fitted(&self, problem: &Problem, point: &Point) -> f64 {
        let missed = self.by.whitened(&problem.missed(&point.at));
        (missed.iter().map(|value| value * value).sum::<f64>() / missed.len().max(1) as f64).sqrt()
    }

    /// What is missed of the first datum of each group beside its prediction from the others, and its variance.
    pub(super) fn left_out(&self, problem: &Problem, point: &Point) -> Option<Vec<(f64, f64)>> {
        let left_out = self.linear(problem, point)?.left_out(&self.groups)?;
        Some(left_out.into_iter().map(|of| (of.missed[(0, 0)], of.covariance[(0, 0)])).collect())
    }

    fn linear(&self, problem: &Problem, point: &Point) -> Option<Linear<'_>> {
        let z = &point.z;
        let missed = self.by.whitened(&problem.missed(&point.at));
        let mut derivatives = problem.derivatives(point, 0..point.z.len())?;
        self.by.whiten(&mut derivatives);
        // What was measured less what is thought of it before any datum.
        let moved = |(row, missed): (usize, &f64)| {
            missed + (0..z.len()).map(|column| derivatives[(row, column)] * z[column]).sum::<f64>()
        };
        let values = missed.iter().enumerate().map(moved).collect();
        let precision = problem.hypothesis.precision();
        Some(Linear { inverse_factor: &self.inverse_factor, values, derivatives, precision })
    }
}

/// The values of each record; of a single one those of each mode.
fn groups(comparison: &Comparison) -> Vec<Vec<usize>> {
    let records = comparison.measured.records.len();
    if records > 1 {
        return (0..records).map(|record| comparison.block_of(record).collect()).collect();
    }
    let residues = |pole: usize| (0..records).map(move |record| comparison.residue_place(record, pole));
    let of_mode = |pole: usize| [pole].into_iter().chain(residues(pole).flat_map(|at| [at, at + 1])).collect();
    (0..comparison.measured.poles.len()).map(of_mode).collect()
}

/// Rms of what the lists tell of their noise, relative to each frequency.
pub(super) fn noise(inquiry: &Inquiry) -> f64 {
    let blocks = inquiry.stacked.blocks.iter().map(|block| block.comparison().measured);
    let variances: Vec<f64> =
        blocks.flat_map(|of| (0..of.poles.len()).map(|pole| of.covariance[(pole, pole)])).collect();
    (variances.iter().sum::<f64>() / variances.len().max(1) as f64).sqrt()
}
