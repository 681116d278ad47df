//! The likelihood of the records: residuals over the noise, and their derivatives.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use num_complex::Complex64;
use orthopanel_model::{
    BEAM_CONSTANTS, Boundary, Constant, ModelError, Piece, Place, StaticFlexibility, Structure, TimoshenkoBeam,
    sensitive_modes,
};
use rayon::prelude::*;

use super::line_block::{BLOCK, LineBlock};
use super::records::PlaceRecord;
use super::synthesis::{DampingLaw, PairModel};
use crate::least_squares::Quadratic;

/// Records of one piece and what carries its model.
pub(super) struct PieceProblem {
    /// Index of the piece in the test.
    pub piece: usize,
    pub sizes: Piece,
    pub records: Vec<PlaceRecord>,
    /// Modes inside the band of the records.
    pub in_band: usize,
    /// Modes whose damping is free: those below 1.3 times the band, whose flanks reach into it.
    pub free_zetas: usize,
    /// Modes summed one by one: those below 2.5 times the band.
    pub summed: usize,
    beam: TimoshenkoBeam,
    pub flexibility: StaticFlexibility,
    places: Vec<Place>,
    pairs: Vec<(usize, usize)>,
}

impl PieceProblem {
    /// `frequencies` are those of the starting model, enough to pass 2.5 times the band.
    pub(super) fn new(
        piece: usize,
        sizes: Piece,
        boundary: Boundary,
        records: Vec<PlaceRecord>,
        frequencies: &[f64],
    ) -> Result<Self, ModelError> {
        let band = records.iter().map(PlaceRecord::band_end).fold(0.0, f64::max);
        let below = |limit: f64| frequencies.iter().filter(|&&frequency| frequency < limit).count();
        let summed = below(2.5 * band).max(1);
        let mut places: Vec<Place> = Vec::new();
        let mut number = |place: Place| {
            places.iter().position(|known| *known == place).unwrap_or_else(|| {
                places.push(place);
                places.len() - 1
            })
        };
        let pairs = records.iter().map(|record| (number(record.force_at), number(record.response_at))).collect();
        Ok(Self {
            piece,
            sizes,
            in_band: below(band),
            free_zetas: below(1.3 * band),
            summed,
            // Twice as many terms as modes, and some: the sum's modes then stand to rounding.
            beam: TimoshenkoBeam::new(&sizes, boundary, 2 * summed + 24)?,
            flexibility: StaticFlexibility::new(&sizes, boundary)?,
            records,
            places,
            pairs,
        })
    }

    /// The model of every record at these constants and logarithms of the free damping ratios.
    fn pair_models(&self, values: &[f64; 2], log_zetas: &[f64], law: DampingLaw) -> Result<Vec<PairModel>, ModelError> {
        let modes = sensitive_modes(&self.beam, values, self.summed, &self.places)?;
        let zetas = self.zetas(log_zetas);
        let between = |(pair, record): (&(usize, usize), &PlaceRecord)| {
            let [first, second] = [pair.0, pair.1].map(|number| self.places[number].x);
            let flexibility = self.flexibility.between(first, second, values[0], values[1]);
            let lines = (record.decay_rate, record.band_end());
            PairModel::new(&modes, *pair, flexibility, law, (&zetas, self.free_zetas), lines)
        };
        Ok(self.pairs.iter().zip(&self.records).map(between).collect())
    }

    /// All damping ratios of the sum: the free ones, then the last of those inside the band.
    pub(super) fn zetas(&self, log_zetas: &[f64]) -> Vec<f64> {
        let beyond = log_zetas.get(self.in_band.saturating_sub(1)).or(log_zetas.last()).copied().unwrap_or(-6.0);
        (0..self.summed).map(|mode| log_zetas.get(mode).copied().unwrap_or(beyond).exp()).collect()
    }
}

/// All pieces of a test; they share the constants.
pub(super) struct AcceleranceProblem {
    pub constants: [Constant; 2],
    pub held: [Option<f64>; 2],
    pub free: Vec<usize>,
    pub law: DampingLaw,
    pub pieces: Vec<PieceProblem>,
    /// Where the damping of a mode that the records do not show is kept, as a logarithm.
    pub usual_log_zeta: f64,
}

/// Standard deviation of a mode's $\ln\zeta$ before the records speak: a factor of seven. It keeps a mode that no record
/// shows where its neighbours are, and yields to any record that shows it.
const PRIOR_LOG_ZETA_STD: f64 = 2.0;

impl AcceleranceProblem {
    pub(super) fn new(held: [Option<f64>; 2], law: DampingLaw, pieces: Vec<PieceProblem>, usual_log_zeta: f64) -> Self {
        let free = (0..2).filter(|&index| held[index].is_none()).collect();
        Self { constants: BEAM_CONSTANTS, held, free, law, pieces, usual_log_zeta }
    }

    /// Number of parameters.
    pub(super) fn size(&self) -> usize {
        self.free.len() + self.pieces.iter().map(|piece| piece.free_zetas).sum::<usize>()
    }

    /// Number of real data: two a line.
    pub(super) fn data(&self) -> usize {
        self.pieces.iter().flat_map(|piece| &piece.records).map(|record| 2 * record.value.len()).sum()
    }

    /// Whether every record tells its own noise.
    pub(super) fn noise_is_known(&self) -> bool {
        self.pieces.iter().flat_map(|piece| &piece.records).all(|record| record.variance_known)
    }

    /// Where the damping of a piece begins in the parameters.
    pub(super) fn zeta_offset(&self, piece: usize) -> usize {
        self.free.len() + self.pieces[..piece].iter().map(|piece| piece.free_zetas).sum::<usize>()
    }

    pub(super) fn values(&self, parameters: &[f64]) -> [f64; 2] {
        let mut values = self.held.map(|held| held.unwrap_or(f64::NAN));
        for (&index, log) in self.free.iter().zip(parameters) {
            values[index] = log.exp().clamp(self.constants[index].low, self.constants[index].high);
        }
        values
    }

    pub(super) fn bounds(&self) -> Vec<(f64, f64)> {
        let constants =
            self.free.iter().map(|&index| (self.constants[index].low.ln(), self.constants[index].high.ln()));
        constants.chain(std::iter::repeat(log_zeta_bounds())).take(self.size()).collect()
    }

    /// The model's lines of every record, piece by piece.
    pub(super) fn lines(&self, parameters: &[f64]) -> Result<Vec<Vec<Complex64>>, ModelError> {
        let mut all = Vec::new();
        for (index, piece) in self.pieces.iter().enumerate() {
            let models = self.pair_models(index, parameters)?;
            for (record, model) in piece.records.iter().zip(&models) {
                let mut out = vec![LineBlock::ZERO; model.functions()];
                let mut lines = Vec::with_capacity(record.value.len());
                for from in (0..record.value.len()).step_by(BLOCK) {
                    model.lines(&record.s_block(from), &mut out);
                    lines.extend(out.iter().take(1).flat_map(LineBlock::values).take(record.value.len() - from));
                }
                all.push(lines);
            }
        }
        Ok(all)
    }

    fn pair_models(&self, piece: usize, parameters: &[f64]) -> Result<Vec<PairModel>, ModelError> {
        let (own, offset) = (&self.pieces[piece], self.zeta_offset(piece));
        own.pair_models(&self.values(parameters), &parameters[offset..offset + own.free_zetas], self.law)
    }

    /// Half the curvature of $\sum 2|H_{cal}-H_{exp}|^2/\mathrm{var}$ and of the damping priors, with gradient and value.
    pub(super) fn linearise(&self, parameters: &[f64]) -> Result<Quadratic, ModelError> {
        let values = self.values(parameters);
        let mut sum = Quadratic::zero(self.size());
        for (index, piece) in self.pieces.iter().enumerate() {
            let models = self.pair_models(index, parameters)?;
            let by_constants = piece.beam.coefficient_derivatives(&values)?;
            // ∂c_i/∂ln p_j of the free constants.
            let chain: Vec<Vec<f64>> = self
                .free
                .iter()
                .map(|&j| (0..by_constants.nrows()).map(|i| by_constants[(i, j)] * values[j]).collect())
                .collect();
            let columns: Vec<usize> =
                (0..self.free.len()).chain((0..piece.free_zetas).map(|mode| self.zeta_offset(index) + mode)).collect();
            let run = |record: &PlaceRecord| (0..record.value.len()).step_by(RUN);
            let jobs: Vec<(&PlaceRecord, &PairModel, usize)> = piece
                .records
                .iter()
                .zip(&models)
                .flat_map(|(record, model)| run(record).map(move |from| (record, model, from)))
                .collect();
            let parts: Vec<Mat<f64>> =
                jobs.into_par_iter().map(|(record, model, from)| run_products(record, model, &chain, from)).collect();
            parts.iter().for_each(|part| sum.add_products(part, &columns));
        }
        for (column, log_zeta) in parameters.iter().enumerate().skip(self.free.len()) {
            sum.add_row((log_zeta - self.usual_log_zeta) / PRIOR_LOG_ZETA_STD, &[(column, 1.0 / PRIOR_LOG_ZETA_STD)]);
        }
        sum.mirror();
        Ok(sum)
    }
}

/// Bounds of $\ln\zeta$: eq. 25 wants a ratio below $1/\sqrt2$.
pub(super) fn log_zeta_bounds() -> (f64, f64) {
    (1e-7_f64.ln(), -0.5 * 2.0_f64.ln() - 1e-9)
}

/// Lines summed by one task: enough to be worth a task, few enough to share out evenly.
const RUN: usize = 32 * BLOCK;

/// $[J\,r]^T[J\,r]$ of a run of lines, with the derivatives by the free constants first, then by each $\ln\zeta$.
/// `chain` has $\partial c_i/\partial\ln p_j$, a list a free constant.
fn run_products(record: &PlaceRecord, model: &PairModel, chain: &[Vec<f64>], from: usize) -> Mat<f64> {
    let mut functions = vec![LineBlock::ZERO; model.functions()];
    let coefficients = chain.first().map_or(model.coefficients(), Vec::len);
    let zetas = model.functions() - 1 - coefficients;
    let size = chain.len() + zetas + 1;
    let (mut rows, mut products) = (Mat::zeros(2 * BLOCK, size), Mat::zeros(size, size));
    for from in (from..record.value.len().min(from + RUN)).step_by(BLOCK) {
        model.lines(&record.s_block(from), &mut functions);
        let weights = record.weights(from);
        let (structural, by_zeta) = functions.split_at_mut(1 + coefficients);
        let Some((value, by_coefficients)) = structural.split_first_mut() else { continue };
        for (column, shares) in chain.iter().enumerate() {
            let mut by = LineBlock::ZERO;
            for (by_coefficient, share) in by_coefficients.iter().zip(shares) {
                by.add_multiple(by_coefficient, *share);
            }
            by.write_weighted(&weights, rows.col_as_slice_mut(column));
        }
        for (by, column) in by_zeta.iter().zip(chain.len()..) {
            by.write_weighted(&weights, rows.col_as_slice_mut(column));
        }
        value.subtract(&record.value[from..]);
        value.write_weighted(&weights, rows.col_as_slice_mut(size - 1));
        matmul(&mut products, Accum::Add, rows.transpose(), &rows, 1.0, Par::Seq);
    }
    products
}
