//! The likelihood of the records: residuals over the noise, and their derivatives.

use faer::Mat;
use num_complex::Complex64;
use orthopanel_model::{ModelError, Piece, Place};
use rayon::prelude::*;

use super::line_block::{BLOCK, LineBlock};

use super::misfit::noise_of_misfit;
use super::records::PlaceRecord;
use super::synthesis::{DampingLaw, PairModel};
use super::weighted_rows::{RUN, run_products};
use crate::free_constants::{FreeConstants, RestingFreed};
use crate::least_squares::{Minimum, Quadratic};
use crate::structures::ModeSynthesis;

/// A misfit per datum above this is the model's, not the noise's, and line by line damping is not to be trusted.
pub(super) const FAR_FROM_NOISE: f64 = 25.0;

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
    /// Modes summed one by one: those within the structure's reach.
    pub summed: usize,
    synthesis: Box<dyn ModeSynthesis>,
    /// What takes its place near the parameters of [`AcceleranceProblem::move_near`], if anything.
    nearby: Option<Box<dyn ModeSynthesis>>,
    places: Vec<Place>,
    pairs: Vec<(usize, usize)>,
}

impl PieceProblem {
    /// `frequencies` are those of the starting model's modes that are summed.
    pub(super) fn new(
        piece: usize,
        sizes: Piece,
        synthesis: Box<dyn ModeSynthesis>,
        records: Vec<PlaceRecord>,
        frequencies: &[f64],
    ) -> Self {
        let band = records.iter().map(PlaceRecord::band_end).fold(0.0, f64::max);
        let below = |limit: f64| frequencies.iter().filter(|&&frequency| frequency < limit).count();
        let mut places: Vec<Place> = Vec::new();
        let mut number = |place: Place| {
            places.iter().position(|known| *known == place).unwrap_or_else(|| {
                places.push(place);
                places.len() - 1
            })
        };
        let pairs = records.iter().map(|record| (number(record.force_at), number(record.response_at))).collect();
        Self {
            piece,
            sizes,
            in_band: below(band),
            free_zetas: below(1.3 * band),
            summed: frequencies.len().max(1),
            synthesis,
            nearby: None,
            records,
            places,
            pairs,
        }
    }

    /// The model of every record at these constants and logarithms of the free damping ratios.
    fn pair_models(&self, values: &[f64], log_zetas: &[f64], law: DampingLaw) -> Result<Vec<PairModel>, ModelError> {
        let synthesis = self.nearby.as_deref().unwrap_or(self.synthesis.as_ref());
        let modes = synthesis.modes(values, self.summed, &self.places)?;
        let zetas = self.zetas(log_zetas);
        let between = |(pair, record): (&(usize, usize), &PlaceRecord)| {
            let flexibility = synthesis.flexibility(&modes, &self.places, *pair, values);
            let lines = (record.decay_rate, record.band_end());
            PairModel::new(&modes, *pair, flexibility, law, (&zetas, self.free_zetas), lines)
        };
        Ok(self.pairs.iter().zip(&self.records).map(between).collect())
    }

    /// The model of one record as if it had been taken between other places.
    pub(super) fn models_between(
        &self,
        record: &PlaceRecord,
        pairs: &[(Place, Place)],
        (values, log_zetas): (&[f64], &[f64]),
        law: DampingLaw,
    ) -> Result<Vec<PairModel>, ModelError> {
        let places: Vec<Place> = pairs.iter().flat_map(|&(force, response)| [force, response]).collect();
        let modes = self.synthesis.modes(values, self.summed, &places)?;
        let zetas = self.zetas(log_zetas);
        let between = |index: usize| {
            let pair = (2 * index, 2 * index + 1);
            let flexibility = self.synthesis.flexibility(&modes, &places, pair, values);
            PairModel::new(
                &modes,
                pair,
                flexibility,
                law,
                (&zetas, self.free_zetas),
                (record.decay_rate, record.band_end()),
            )
        };
        Ok((0..pairs.len()).map(between).collect())
    }

    /// All damping ratios of the sum: the free ones, then the last of those inside the band.
    pub(super) fn zetas(&self, log_zetas: &[f64]) -> Vec<f64> {
        let beyond = log_zetas.get(self.in_band.saturating_sub(1)).or(log_zetas.last()).copied().unwrap_or(-6.0);
        (0..self.summed).map(|mode| log_zetas.get(mode).copied().unwrap_or(beyond).exp()).collect()
    }
}

/// All pieces of a test; they share the constants that are not a piece's own.
pub(super) struct AcceleranceProblem {
    pub constants: FreeConstants,
    pub law: DampingLaw,
    pub pieces: Vec<PieceProblem>,
    /// Where the damping of a mode that the records do not show is kept, as a logarithm.
    pub usual_log_zeta: f64,
    /// Constants that poles alone do not show, kept near what is usual.
    pub usual: Vec<Usual>,
}

/// A parameter that is kept near what is usual for panels, and yields to any record that shows it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Usual {
    pub parameter: usize,
    pub centre: f64,
    pub std: f64,
}

/// Standard deviation of a mode's $\ln\zeta$ before the records speak: a factor of seven. It keeps a mode that no record
/// shows where its neighbours are, and yields to any record that shows it.
pub(super) const PRIOR_LOG_ZETA_STD: f64 = 2.0;

impl AcceleranceProblem {
    pub(super) fn new(
        constants: FreeConstants,
        law: DampingLaw,
        pieces: Vec<PieceProblem>,
        usual_log_zeta: f64,
    ) -> Self {
        Self { constants, law, pieces, usual_log_zeta, usual: Vec::new() }
    }

    /// Frees the constants that rest, each near its usual value; the parameters of all.
    pub(super) fn free_resting(&mut self, parameters: &[f64]) -> Vec<f64> {
        let seen = self.constants.count();
        let RestingFreed { constants, parameters: mut at, usual_stds } =
            self.constants.with_resting_freed(&parameters[..seen]);
        let usual = |(index, std)| Usual { parameter: seen + index, centre: at[seen + index], std };
        self.usual = usual_stds.into_iter().enumerate().map(usual).collect();
        self.constants = constants;
        at.extend(&parameters[seen..]);
        at
    }

    /// From here on models are those of what sums quickly near these parameters, where there is such a thing; says whether there
    /// is. Values and slopes there are those of the whole, further off they differ by the square of the distance.
    pub(super) fn move_near(&mut self, parameters: &[f64]) -> Result<bool, ModelError> {
        for index in 0..self.pieces.len() {
            let values = self.values(parameters, index);
            let piece = &mut self.pieces[index];
            piece.nearby = piece.synthesis.near(&values, piece.summed, &piece.places)?;
        }
        Ok(self.pieces.iter().any(|piece| piece.nearby.is_some()))
    }

    /// Number of parameters.
    pub(super) fn size(&self) -> usize {
        self.constants.count() + self.pieces.iter().map(|piece| piece.free_zetas).sum::<usize>()
    }

    /// The records of all pieces.
    pub(super) fn records(&self) -> impl Iterator<Item = &PlaceRecord> {
        self.pieces.iter().flat_map(|piece| &piece.records)
    }

    /// Number of independent real data: two a line, less what windows tie together.
    pub(super) fn data(&self) -> f64 {
        self.records().flat_map(|record| &record.worth).map(|worth| 2.0 * worth).sum()
    }

    /// Misfit per datum that is left beside the parameters, of a sum of squares.
    pub(super) fn chi_square(&self, cost: f64) -> f64 {
        cost / (self.data() - self.size() as f64).max(1.0)
    }

    /// The sum of squares of no model at all.
    pub(super) fn cost_of_nothing(&self) -> f64 {
        self.records()
            .flat_map(|record| record.value.iter().zip(&record.variance).zip(&record.worth))
            .map(|((value, variance), worth)| 2.0 * worth * value.norm_sqr() / variance)
            .sum()
    }

    /// Whether every record tells its own noise.
    pub(super) fn noise_is_known(&self) -> bool {
        self.records().all(|record| record.variance_known)
    }

    /// Whether there is a record whose noise no scatter of hits tells.
    pub(super) fn noise_is_to_learn(&self) -> bool {
        self.records().any(|record| !record.scatter_told)
    }

    /// Takes the noise of such records from the misfit at these parameters.
    pub(super) fn learn_noise(&mut self, parameters: &[f64]) -> Result<(), ModelError> {
        let mut lines = self.lines(parameters)?.into_iter();
        let records = self.pieces.iter_mut().flat_map(|piece| &mut piece.records);
        for (record, model) in records.zip(lines.by_ref()).filter(|(record, _)| !record.scatter_told) {
            record.variance = noise_of_misfit(record, &model);
            // What a force window ties together runs as smoothly as what a model lacks.
            if let Some(noise) = &mut record.tied {
                noise.independent.clone_from(&record.variance);
                record.variance.iter_mut().zip(&noise.variance).for_each(|(all, tied)| *all += tied);
            }
            record.variance_known = true;
        }
        Ok(())
    }

    /// Takes the strength of lines, where it counts in their variance, from the model at these parameters; whether any does.
    pub(super) fn weigh_by_model(&mut self, parameters: &[f64]) -> Result<bool, ModelError> {
        if self.records().all(|record| record.by_strength.is_none()) {
            return Ok(false);
        }
        let mut lines = self.lines(parameters)?.into_iter();
        let records = self.pieces.iter_mut().flat_map(|piece| &mut piece.records);
        records.zip(lines.by_ref()).for_each(|(record, model)| record.weigh_by(&model));
        Ok(true)
    }

    /// Where the damping of a piece begins in the parameters.
    pub(super) fn zeta_offset(&self, piece: usize) -> usize {
        self.constants.count() + self.pieces[..piece].iter().map(|piece| piece.free_zetas).sum::<usize>()
    }

    /// The constants of piece number `piece` of this problem.
    pub(super) fn values(&self, parameters: &[f64], piece: usize) -> Vec<f64> {
        self.constants.values(parameters, self.pieces[piece].piece)
    }

    pub(super) fn bounds(&self) -> Vec<(f64, f64)> {
        let constants = self.constants.bounds().into_iter();
        constants.chain(std::iter::repeat(log_zeta_bounds())).take(self.size()).collect()
    }

    /// The model's lines of every record, piece by piece.
    pub(super) fn lines(&self, parameters: &[f64]) -> Result<Vec<Vec<Complex64>>, ModelError> {
        let mut all = Vec::new();
        for (index, piece) in self.pieces.iter().enumerate() {
            let models = self.pair_models(index, parameters)?;
            all.extend(piece.records.iter().zip(&models).map(|(record, model)| model_lines(record, model)));
        }
        Ok(all)
    }

    /// The constants of a piece and its logarithms of damping ratios.
    pub(super) fn of_piece<'a>(&self, piece: usize, parameters: &'a [f64]) -> (Vec<f64>, &'a [f64]) {
        let offset = self.zeta_offset(piece);
        (self.values(parameters, piece), &parameters[offset..offset + self.pieces[piece].free_zetas])
    }

    /// What the lines of a piece's records are, and how they follow from the parameters.
    pub(super) fn derivatives(&self, index: usize, parameters: &[f64]) -> Result<Derivatives, ModelError> {
        let piece = &self.pieces[index];
        let models = self.pair_models(index, parameters)?;
        let values = self.values(parameters, index);
        let by_constants = piece.synthesis.coefficient_derivatives(&values)?;
        let of_constant = self.constants.parameters_of(piece.piece);
        let mut chain = vec![vec![0.0; by_constants.nrows()]; self.constants.count()];
        for (constant, parameter) in of_constant.iter().enumerate() {
            if let Some(shares) = parameter.and_then(|parameter| chain.get_mut(parameter)) {
                let slope = self.constants.slope(constant, values[constant]);
                shares.iter_mut().enumerate().for_each(|(i, share)| *share += by_constants[(i, constant)] * slope);
            }
        }
        let zetas = (0..piece.free_zetas).map(|mode| self.zeta_offset(index) + mode);
        Ok(Derivatives { models, chain, columns: (0..self.constants.count()).chain(zetas).collect() })
    }

    fn pair_models(&self, piece: usize, parameters: &[f64]) -> Result<Vec<PairModel>, ModelError> {
        let (values, log_zetas) = self.of_piece(piece, parameters);
        self.pieces[piece].pair_models(&values, log_zetas, self.law)
    }

    /// Half the curvature of $\sum 2|H_{cal}-H_{exp}|^2/\mathrm{var}$ and of the damping priors, with gradient and value.
    pub(super) fn linearise(&self, parameters: &[f64]) -> Result<Quadratic, ModelError> {
        self.linearise_by(parameters, |_, Derivatives { models, chain, .. }, records| {
            let run = |record: &PlaceRecord| (0..record.value.len()).step_by(RUN);
            let jobs: Vec<(&PlaceRecord, &PairModel, usize)> = records
                .iter()
                .zip(models)
                .flat_map(|(record, model)| run(record).map(move |from| (record, model, from)))
                .collect();
            jobs.into_par_iter().map(|(record, model, from)| run_products(record, model, chain, from)).collect()
        })
    }

    /// The same, where the products $[J\,r]^TW[J\,r]$ of a piece's records, or of parts of these, are made by `products`.
    pub(super) fn linearise_by(
        &self,
        parameters: &[f64],
        products: impl Fn(usize, &Derivatives, &[PlaceRecord]) -> Vec<Mat<f64>>,
    ) -> Result<Quadratic, ModelError> {
        let mut sum = Quadratic::zero(self.size());
        for (index, piece) in self.pieces.iter().enumerate() {
            let derivatives = self.derivatives(index, parameters)?;
            let parts = products(index, &derivatives, &piece.records);
            parts.iter().for_each(|part| sum.add_products(part, &derivatives.columns));
        }
        for (column, log_zeta) in parameters.iter().enumerate().skip(self.constants.count()) {
            sum.add_row((log_zeta - self.usual_log_zeta) / PRIOR_LOG_ZETA_STD, &[(column, 1.0 / PRIOR_LOG_ZETA_STD)]);
        }
        for &Usual { parameter, centre, std } in &self.usual {
            sum.add_row((parameters[parameter] - centre) / std, &[(parameter, 1.0 / std)]);
        }
        sum.mirror();
        Ok(sum)
    }
}

/// The model at the lines of a record.
pub(super) fn model_lines(record: &PlaceRecord, model: &PairModel) -> Vec<Complex64> {
    let mut out = vec![LineBlock::ZERO; model.functions()];
    let mut lines = Vec::with_capacity(record.value.len());
    for from in (0..record.value.len()).step_by(BLOCK) {
        model.lines(&record.s_block(from), &mut out);
        lines.extend(out.iter().take(1).flat_map(LineBlock::values).take(record.value.len() - from));
    }
    lines
}

/// Bounds of $\ln\zeta$: eq. 25 wants a ratio below $1/\sqrt2$.
pub(super) fn log_zeta_bounds() -> (f64, f64) {
    (1e-7_f64.ln(), -0.5 * 2.0_f64.ln() - 1e-9)
}

/// The models of a piece's records, and which parameters they follow.
pub(super) struct Derivatives {
    pub models: Vec<PairModel>,
    /// $\partial c_i/\partial p_j$ of the constants' parameters, a list a parameter; several constants may follow one.
    pub chain: Vec<Vec<f64>>,
    /// The parameters: of the constants, then each $\ln\zeta$ of the piece.
    pub columns: Vec<usize>,
}

/// Whether the misfit is the model's, and not the noise's.
pub(super) fn is_far_from_noise(problem: &AcceleranceProblem, minimum: &Minimum) -> bool {
    problem.noise_is_known() && problem.chi_square(minimum.at.cost) > FAR_FROM_NOISE
}
