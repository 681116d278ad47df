//! The fit weighed by the whole covariance of the records, where a force window ties their lines together.

use faer::linalg::solvers::Llt;
use faer::prelude::Solve;
use faer::{Mat, Side};
use num_complex::Complex64;
use orthopanel_model::ModelError;
use rayon::prelude::*;

use super::force_window::Impulses;
use super::line_block::BLOCK;
use super::problem::{AcceleranceProblem, model_lines};
use super::records::PlaceRecord;
use super::synthesis::PairModel;
use super::tied_noise::TiedNoise;
use super::weighted_rows::{RUN, WeightedRows, run_products};
use crate::least_squares::{Minimum, Quadratic};

/// A minimum with what is known of its parameters.
pub(super) struct Weighed {
    pub minimum: Minimum,
    /// Of the parameters, for the noise that the records tell; `None` where it is singular.
    pub covariance: Option<Mat<f64>>,
    /// Misfit per datum.
    pub chi_square: f64,
}

/// Misfit per datum, over the whole covariance, up to which the records are taken to hold nothing but model and noise. What a model
/// lacks shows there first, for the lines about a resonance count for far more.
const MODEL_AND_NOISE: f64 = 1.5;
/// Steps at most, and the sum of squares that is not worth another: a third of a standard deviation.
const STEPS: usize = 3;
const LITTLE: f64 = 0.1;
/// What may be left to gain after them: one standard deviation. Valleys of modes beyond the band are long and bent.
const NEAR: f64 = 1.0;

impl AcceleranceProblem {
    /// From the minimum for independent lines to that for the noise as it is, where that pays.
    ///
    /// Of tied noise $C = D + \sum_mu_mu_m^T$ (as [`Impulses`], in residuals over the independent noise $D=1$)
    /// $$C^{-1} = 1 - U(1+U^TU)^{-1}U^T,$$
    /// so that a common factor on all lines of a resonance costs nothing, and damping is read off its width.
    pub(super) fn weigh_whole(&self, minimum: Minimum) -> Result<Weighed, ModelError> {
        // An exponential window ties lines too: of that no more is known than what each is worth to a fit of independent ones.
        let windowed = self.records().any(|record| record.decay_rate > 0.0);
        if self.is_tied()
            && !windowed
            && let Some(whole) = self.whole_minimum(&minimum.parameters)?
        {
            return Ok(whole);
        }
        let covariance = self.covariance(&minimum.parameters, &minimum.at)?;
        Ok(Weighed { covariance, chi_square: self.chi_square(minimum.at.cost), minimum })
    }

    fn is_tied(&self) -> bool {
        self.records().any(|record| record.tied.is_some())
    }

    /// By steps of Gauss and Newton; `None` where they go nowhere, or the misfit that they leave is not the noise's.
    fn whole_minimum(&self, from: &[f64]) -> Result<Option<Weighed>, ModelError> {
        let apart: Vec<Option<PlaceRecord>> = self.records().map(PlaceRecord::independent).collect();
        let lines = self.lines(from)?;
        let Some(whole) = Whole::of(self, &apart, &lines) else { return Ok(None) };
        let mut parameters = from.to_vec();
        let mut at = whole.linearise(&parameters)?;
        for steps in (0..=STEPS).rev() {
            let Some(covariance) = at.covariance() else { return Ok(None) };
            let size = self.size();
            let step: Vec<f64> =
                (0..size).map(|i| (0..size).map(|j| covariance[(i, j)] * at.gradient[j]).sum()).collect();
            let promise: f64 = step.iter().zip(&at.gradient).map(|(step, gradient)| step * gradient).sum();
            if promise < if steps > 0 { LITTLE } else { NEAR } {
                let chi_square = self.chi_square(at.cost);
                let weighed = Weighed { minimum: Minimum { parameters, at }, covariance: Some(covariance), chi_square };
                return Ok((chi_square < MODEL_AND_NOISE).then_some(weighed));
            }
            let ends = parameters.iter().zip(&step).zip(self.bounds());
            parameters = ends.map(|((at, step), (low, high))| (at - step).clamp(low, high)).collect();
            at = whole.linearise(&parameters)?;
        }
        Ok(None)
    }

    /// The covariance of the parameters at a minimum of lines weighed as independent; `None` where it is singular.
    ///
    /// With $A = J^TWJ$ and noise of covariance $C$ it is $A^{-1}J^TWCWJA^{-1}$, which for independent lines is $A^{-1}$. Tied
    /// noise adds $\sum_mJ^Tu_mu_m^TJ$ in place of the same variance of independent lines.
    fn covariance(&self, parameters: &[f64], at: &Quadratic) -> Result<Option<Mat<f64>>, ModelError> {
        let Some(inverse) = at.covariance() else { return Ok(None) };
        if !self.is_tied() {
            return Ok(Some(inverse));
        }
        let mut added = Quadratic::zero(self.size());
        for (index, piece) in self.pieces.iter().enumerate() {
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
        Ok(Some(&inverse + &inverse * &added.normal * &inverse))
    }
}

/// The whole covariance of all records, as it is at some parameters.
struct Whole<'a> {
    problem: &'a AcceleranceProblem,
    /// Of each record the impulses of its tied noise, if there is any, and the factors of $1 + U^TU$.
    tied: Vec<Option<(Impulses<'a>, Llt<f64>)>>,
}

impl<'a> Whole<'a> {
    /// Of records over their independent noise, with `lines` of a model; `None` where numbers are not finite.
    fn of(problem: &'a AcceleranceProblem, apart: &'a [Option<PlaceRecord>], lines: &[Vec<Complex64>]) -> Option<Self> {
        let of_record = |((record, apart), lines): ((&PlaceRecord, &'a Option<PlaceRecord>), &Vec<Complex64>)| {
            let (Some(noise), Some(apart)) = (&record.tied, apart) else { return Some(None) };
            let impulses = Impulses::of(apart, noise, lines);
            let mut among = impulses.among();
            (0..among.nrows()).for_each(|m| among[(m, m)] += 1.0);
            Some(Some((impulses, among.llt(Side::Lower).ok()?)))
        };
        let tied = problem.records().zip(apart).zip(lines).map(of_record).collect::<Option<_>>()?;
        Some(Self { problem, tied })
    }

    /// As [`AcceleranceProblem::linearise`].
    fn linearise(&self, parameters: &[f64]) -> Result<Quadratic, ModelError> {
        let first = |piece: usize| self.problem.pieces[..piece].iter().map(|piece| piece.records.len()).sum::<usize>();
        self.problem.linearise_by(parameters, |piece, derivatives, records| {
            let tied = self.tied.get(first(piece)..).unwrap_or_default();
            let records = records.par_iter().zip(tied).zip(&derivatives.models);
            records.map(|((record, tied), model)| products(record, tied.as_ref(), model, &derivatives.chain)).collect()
        })
    }
}

/// $[J\,r]^TC^{-1}[J\,r]$ of a record.
fn products(
    record: &PlaceRecord,
    tied: Option<&(Impulses, Llt<f64>)>,
    model: &PairModel,
    chain: &[Vec<f64>],
) -> Mat<f64> {
    let rows = WeightedRows::of(tied.map_or(record, |(impulses, _)| impulses.record), model, chain);
    let mut products = Mat::<f64>::zeros(rows.size(), rows.size());
    match tied {
        Some((impulses, among)) => {
            let tied = impulses.of_rows(rows, |block, _| products += block.transpose() * block);
            products - tied.transpose() * among.solve(&tied)
        }
        None => {
            let runs = (0..record.value.len()).step_by(RUN);
            runs.fold(products, |sum, from| sum + run_products(record, model, chain, from))
        }
    }
}

/// $J^TWCWJ$ of the tied noise, less what the same variance of independent lines makes; a last row and column for the residual.
fn tied_less_independent(record: &PlaceRecord, noise: &TiedNoise, model: &[Complex64], rows: WeightedRows) -> Mat<f64> {
    let mut independent = Mat::<f64>::zeros(rows.size(), rows.size());
    let tied = Impulses::of(record, noise, model).of_rows(rows, |block, from| {
        let mut scaled = block.clone();
        let shares = record.variance.iter().zip(&noise.variance).skip(from).take(BLOCK);
        for (at, share) in shares.map(|(all, tied)| (tied / all).min(1.0).sqrt()).enumerate() {
            for column in 0..scaled.ncols() {
                scaled[(at, column)] *= share;
                scaled[(BLOCK + at, column)] *= share;
            }
        }
        independent += scaled.transpose() * &scaled;
    });
    tied.transpose() * &tied - independent
}
