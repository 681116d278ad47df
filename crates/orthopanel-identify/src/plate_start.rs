//! The constants of a plate from its measured modes, from sizes and mass alone.

use faer::prelude::Solve;
use faer::{Mat, Side};
use orthopanel_data::ImpactTest;
use orthopanel_model::{Boundary, MindlinPlate, ModelError, PLATE_CONSTANTS, Piece, Place, Structure, ritz_modes};
use rayon::prelude::*;

use crate::interruption::heed;
use crate::matching::Partner;
use crate::measured::MeasuredModes;
use crate::model_error::frequency_prior;

/// Ratios $E_y/E_x$, and $G_{xy}$ and $G_{zx}$ over the larger of the two, at which plates begin: from spruce along and across its grain to aluminium
/// faces, from balsa to steel honeycomb.
const ALONG: [f64; 9] = [0.05, 0.1, 0.25, 0.5, 0.8, 1.2, 2.5, 6.0, 15.0];
const SHEAR: [f64; 5] = [0.03, 0.07, 0.15, 0.3, 0.45];
const CORE: [f64; 3] = [0.02, 0.06, 0.3];
/// $G_{yz}/G_{zx}$ there, and Poisson's ratio of equal moduli.
const ACROSS: f64 = 0.6;
const POISSON: f64 = 0.3;
/// Modes and poles that are held against each other for the scale of all moduli.
const LOWEST_MODES: usize = 4;
const LOWEST_POLES: usize = 3;
/// Poles that rank the starts, how far their frequencies may lie from the modes', and starts that are followed.
const RANKED: usize = 14;
const FAR: f64 = 0.06;
const FOLLOWED: usize = 4;
/// What a start is followed with: how far modes may lie from their poles, the lowest poles so many, and by how much frequencies are missed.
const STAGES: [(f64, usize, f64); 6] =
    [(0.06, 10, 0.03), (0.05, 16, 0.02), (0.04, 24, 0.01), (0.025, 99, 0.005), (0.015, 99, 0.003), (0.015, 99, 0.003)];
const STEPS: usize = 2;
/// What a pole of median size costs that stays alone, and the least part of that of a weak one.
const ALONE: f64 = 14.0;
const WEAKEST: f64 = 0.3;
/// What a mode costs that no pole shows, if it is stronger than this part of the poles.
const LOST: f64 = 5.0;
const STRONG: f64 = 0.35;
/// Standard deviations of the logarithm of a modulus about its start, and of Poisson's ratio.
const MODULI: f64 = 0.7;
const RATIO: f64 = 0.15;
/// The longest step of a coordinate.
const LONGEST: f64 = 0.3;
/// Number of Poisson's ratio among the constants, and its bounds.
const NU: usize = 2;
const NU_RANGE: [f64; 2] = [0.01, 0.6];
/// Part of $\sqrt{E_x/E_y}$ below which Poisson's ratio has to stay: the law is definite below the whole.
const DEFINITE: f64 = 0.95;
/// Where some moduli are held, the farthest that the others go at once, in logarithms, and the least that a mode goes with them.
const MOST_MOVED: f64 = 1.0;
const LEAST_BY_FREE: f64 = 0.02;

/// Constants in the order of [`orthopanel_model::PLATE_CONSTANTS`].
pub(crate) type Constants = [f64; 6];

/// A plate's mode: $\omega$, $W_r$ of each record, and $\partial\ln\omega$ by the logarithm of each modulus and by Poisson's ratio.
struct PlateMode {
    seen: (f64, Vec<f64>),
    by: Constants,
}

/// The constants that a test holds.
pub(crate) fn held(test: &ImpactTest) -> [Option<f64>; 6] {
    PLATE_CONSTANTS.each_ref().map(|constant| test.constants.get(constant.name).copied())
}

fn is_definite(values: &Constants) -> bool {
    values[NU] < (values[0] / values[1]).sqrt()
}

/// What is known of a plate before its constants are.
pub(crate) struct PlateStart<'a> {
    measured: &'a MeasuredModes,
    piece: Piece,
    boundary: Boundary,
    held: [Option<f64>; 6],
    pairs: Vec<(Place, Place)>,
    /// Rms over the records of $|W_r|$ of each pole, and the median of these.
    sizes: Vec<f64>,
    typical: f64,
}

impl<'a> PlateStart<'a> {
    pub(crate) fn new(
        measured: &'a MeasuredModes,
        (piece, boundary): (Piece, Boundary),
        held: [Option<f64>; 6],
    ) -> Self {
        let pairs = measured.records.iter().map(|record| (record.force_at, record.response_at)).collect();
        let records = 0..measured.records.len();
        let size = |pole: usize| rms(&records.clone().map(|record| measured.product(record, pole)).collect::<Vec<_>>());
        // Of a list no pole is stronger than another.
        let is_list = measured.records.is_empty();
        let sizes: Vec<f64> = (0..measured.poles.len()).map(|pole| if is_list { 1.0 } else { size(pole) }).collect();
        let mut sorted = sizes.clone();
        sorted.sort_by(f64::total_cmp);
        let typical = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
        Self { measured, piece, boundary, held, pairs, sizes, typical }
    }

    /// The constants that put the modes where the poles are, with what they cost a pole, the best first.
    ///
    /// # Errors
    /// What the plate refuses.
    pub(crate) fn constants(&self) -> Result<Vec<(f64, Constants)>, ModelError> {
        let starts = self.ranked()?;
        heed();
        let followed = starts.into_par_iter().map(|start| self.followed(start));
        let mut found = followed.collect::<Result<Vec<_>, _>>()?;
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(found)
    }

    /// Numbers of the constants that are not held.
    fn free(&self) -> Vec<usize> {
        (0..6).filter(|&i| self.held[i].is_none()).collect()
    }

    fn with_held(&self, values: Constants) -> Constants {
        std::array::from_fn(|i| self.held[i].unwrap_or(values[i]))
    }

    /// The flexible modes, rising.
    fn modes(&self, values: &Constants, count: usize) -> Result<Vec<PlateMode>, ModelError> {
        let plate = match MindlinPlate::with_basis_for(&self.piece, self.boundary, values, count) {
            Err(ModelError::BasisTooSmall { available, .. }) if available > 0 => {
                MindlinPlate::with_basis_for(&self.piece, self.boundary, values, available)?
            }
            plate => plate?,
        };
        let modes = ritz_modes(&plate, values, count.min(plate.resolved_modes()))?;
        let by_constants = plate.coefficient_derivatives(values)?;
        let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
        let mode = |mode: &orthopanel_model::RitzMode| {
            let by_coefficient = mode.coefficient_sensitivity(&plate);
            let by = |constant: usize| -> f64 {
                let sum: f64 = by_coefficient.iter().enumerate().map(|(i, by)| by * by_constants[(i, constant)]).sum();
                sum / (2.0 * mode.angular_frequency.powi(2)) * if constant == NU { 1.0 } else { values[constant] }
            };
            let product = |&(force, response): &(Place, Place)| {
                mode.deflection(&plate, force) * mode.deflection(&plate, response)
            };
            let named = self.measured.named.places().iter().map(|place| mode.deflection(&plate, *place));
            let seen = (mode.angular_frequency, self.pairs.iter().map(product).chain(named).collect());
            PlateMode { seen, by: std::array::from_fn(by) }
        };
        Ok(flexible.map(mode).collect())
    }

    /// What a pole costs that stays alone.
    fn alone(&self, pole: usize) -> f64 {
        ALONE * (self.sizes[pole] / self.typical).clamp(WEAKEST, 1.0)
    }

    /// Cost a pole of the lowest poles, where these may lie `apart` from the modes; strong modes without a pole cost as well.
    fn cost(&self, lowest: &MeasuredModes, modes: &[(f64, Vec<f64>)], apart: f64) -> f64 {
        let (partners, cost) = lowest.assigned(modes, |_| apart, |pole| self.alone(pole));
        if lowest.poles.is_empty() {
            return f64::INFINITY;
        }
        (cost + self.lost(lowest, modes, &partners)) / lowest.poles.len() as f64
    }

    /// What strong modes between the first of the lowest poles and the last cost that no pole is.
    fn lost(&self, lowest: &MeasuredModes, modes: &[(f64, Vec<f64>)], partners: &[Partner]) -> f64 {
        // A list that names its modes may leave others out.
        if !self.measured.named.places().is_empty() {
            return 0.0;
        }
        let Some((first, last)) = lowest.poles.first().zip(lowest.poles.last()) else { return 0.0 };
        let band = 1.03 * first.angular_frequency..0.97 * last.angular_frequency;
        let taken = |mode: usize| partners.iter().flatten().any(|(partner, _)| *partner == mode);
        let lost = modes.iter().enumerate().filter(|(number, (omega, shape))| {
            let is_strong = shape.is_empty() || rms(shape) > STRONG * self.typical;
            band.contains(omega) && !taken(*number) && is_strong
        });
        LOST * lost.count() as f64
    }

    /// What poles without a mode cost, and strong modes without a pole.
    fn unpaired(&self, seen: &[(f64, Vec<f64>)], partners: &[Partner]) -> f64 {
        let alone = (0..partners.len()).filter(|pole| partners[*pole].is_none()).map(|pole| self.alone(pole));
        alone.sum::<f64>() + self.lost(self.measured, seen, partners)
    }

    /// Logarithm of the marginal likelihood of the poles about these constants, where poles and modes may lie so far `apart`.
    ///
    /// # Errors
    /// What the plate refuses.
    pub(crate) fn log_evidence(&self, values: &Constants, apart: f64) -> Result<f64, ModelError> {
        let modes = self.modes(values, self.count(self.measured))?;
        let seen: Vec<(f64, Vec<f64>)> = modes.iter().map(|mode| mode.seen.clone()).collect();
        let (partners, _) = self.measured.assigned(&seen, |_| apart, |pole| self.alone(pole));
        let unpaired = self.unpaired(&seen, &partners);
        let partners: Vec<Option<usize>> = partners.into_iter().map(|partner| partner.map(|(mode, _)| mode)).collect();
        let priors: f64 = self.free().iter().map(|&constant| PlateFit::prior(constant).ln()).sum();
        Ok(-self.missed(&modes, &partners).least_cost() - 0.5 * unpaired - priors)
    }

    /// Which modes the poles are at these constants, and how likely that is.
    ///
    /// # Errors
    /// What the plate refuses.
    pub(crate) fn reading(&self, fit: &PlateFit) -> Result<PolesRead, ModelError> {
        let modes = self.modes(&fit.values, self.count(self.measured))?;
        let seen: Vec<(f64, Vec<f64>)> = modes.iter().map(|mode| mode.seen.clone()).collect();
        let apart = fit.apart();
        let (partners, _) = self.measured.assigned(&seen, |_| apart, |pole| self.alone(pole));
        let cost = 2.0 * fit.cost + self.unpaired(&seen, &partners);
        let partners: Vec<Option<usize>> = partners.into_iter().map(|partner| partner.map(|(mode, _)| mode)).collect();
        let own_cost = self.missed(&modes, &partners).least_cost();
        let mut others = Vec::new();
        for (pole, own) in partners.iter().enumerate().filter_map(|(pole, own)| Some((pole, (*own)?))) {
            let away = |mode: usize| (self.measured.poles[pole].angular_frequency / modes[mode].seen.0).ln().abs();
            for other in (0..modes.len()).filter(|other| *other != own && away(*other) < FARTHEST) {
                // A mode that is another pole's changes places with it.
                let mut exchanged = partners.clone();
                if let Some(taken) = partners.iter().position(|partner| *partner == Some(other)) {
                    exchanged[taken] = Some(own);
                }
                exchanged[pole] = Some(other);
                others.push((pole, other, 2.0 * (self.missed(&modes, &exchanged).least_cost() - own_cost)));
            }
        }
        Ok(PolesRead { modes: partners, cost, others })
    }

    /// The best starts of a net of ratios, each scaled so that one of its lowest modes lies where one of the lowest poles is.
    fn ranked(&self) -> Result<Vec<Constants>, ModelError> {
        let lowest = self.measured.lowest(RANKED);
        let net = ALONG.iter().flat_map(|a| SHEAR.iter().flat_map(move |b| CORE.iter().map(move |c| [*a, *b, *c])));
        let of_ratios = |[along, shear, core]: [f64; 3]| -> Result<Vec<(f64, Constants)>, ModelError> {
            let nu = POISSON * (0.9 / along.sqrt()).min(1.0);
            let larger = 1e10 * along.max(1.0);
            let values = self.as_held([1e10, along * 1e10, nu, shear * larger, ACROSS * core * larger, core * larger]);
            if !is_definite(&values) {
                return Ok(vec![]);
            }
            let modes = self.modes(&values, RANKED + RANKED / 2)?;
            let mut found = Vec::new();
            for mode in modes.iter().take(LOWEST_MODES) {
                for pole in lowest.poles.iter().take(LOWEST_POLES) {
                    // A factor on all moduli that are free; to first order where others are held.
                    let by_free = |mode: &PlateMode| self.free_moduli().map(|i| mode.by[i]).sum::<f64>();
                    let wanted = (pole.angular_frequency / mode.seen.0).ln() / by_free(mode).max(LEAST_BY_FREE);
                    let log_factor =
                        if self.holds_a_modulus() { wanted.clamp(-MOST_MOVED, MOST_MOVED) } else { wanted };
                    let moved: Vec<(f64, Vec<f64>)> = modes
                        .iter()
                        .map(|mode| ((log_factor * by_free(mode)).exp() * mode.seen.0, mode.seen.1.clone()))
                        .collect();
                    let mut scaled = values;
                    self.free_moduli().for_each(|i| scaled[i] *= log_factor.exp());
                    found.push((self.cost(&lowest, &moved, FAR), scaled));
                }
            }
            Ok(found)
        };
        let found: Vec<_> = net.collect::<Vec<_>>().into_par_iter().map(of_ratios).collect::<Result<_, _>>()?;
        let mut found: Vec<(f64, Constants)> = found.into_iter().flatten().collect();
        found.retain(|(_, values)| is_definite(values));
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Of the core frequencies say least.
        let [mut telling, core] = [[0, 1, 3].as_slice(), &[NU, 4, 5]]
            .map(|of| of.iter().copied().filter(|&i| self.held[i].is_none()).collect::<Vec<usize>>());
        if telling.is_empty() {
            telling = core;
        }
        let mut best: Vec<Constants> = Vec::new();
        for (_, values) in found {
            let is_new = |other: &Constants| telling.iter().any(|&i| (other[i] / values[i]).ln().abs() > 0.15);
            if best.iter().all(is_new) {
                best.push(values);
            }
            if best.len() == FOLLOWED {
                break;
            }
        }
        Ok(best)
    }

    fn holds_a_modulus(&self) -> bool {
        (0..6).any(|i| i != NU && self.held[i].is_some())
    }

    fn free_moduli(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&i| i != NU && self.held[i].is_none())
    }

    /// Ratios of constants at the scale of the moduli that are held, and these.
    fn as_held(&self, values: Constants) -> Constants {
        let log_ratios: Vec<f64> =
            (0..6).filter(|&i| i != NU).filter_map(|i| Some((self.held[i]? / values[i]).ln())).collect();
        let factor = (log_ratios.iter().sum::<f64>() / log_ratios.len().max(1) as f64).exp();
        self.with_held(std::array::from_fn(|i| if i == NU { values[i] } else { factor * values[i] }))
    }

    /// A start led to the frequencies of more and more poles.
    fn followed(&self, start: Constants) -> Result<(f64, Constants), ModelError> {
        let mut values = start;
        for (apart, count, missed) in STAGES {
            let lowest = self.measured.lowest(count);
            for _ in 0..STEPS {
                values = self.step(&lowest, &start, &values, (apart, missed))?;
            }
        }
        let (apart, ..) = STAGES[STAGES.len() - 1];
        let modes: Vec<_> = self.modes(&values, self.count(self.measured))?.into_iter().map(|mode| mode.seen).collect();
        Ok((self.cost(self.measured, &modes, apart), values))
    }

    fn count(&self, lowest: &MeasuredModes) -> usize {
        lowest.poles.len() + lowest.poles.len() / 2 + 10
    }

    /// A step of Gauss and Newton on the logarithms of the frequencies, with what is thought of the constants about the start.
    fn step(
        &self,
        lowest: &MeasuredModes,
        start: &Constants,
        values: &Constants,
        (apart, missed): (f64, f64),
    ) -> Result<Constants, ModelError> {
        let modes = self.modes(values, self.count(lowest))?;
        let seen: Vec<(f64, Vec<f64>)> = modes.iter().map(|mode| mode.seen.clone()).collect();
        let (partners, _) = lowest.assigned(&seen, |_| apart, |pole| self.alone(pole));
        let free = self.free();
        let coordinate = |values: &Constants, i: usize| if i == NU { values[i] } else { values[i].ln() };
        let mut curvature = Mat::<f64>::zeros(free.len(), free.len());
        let mut slope = Mat::<f64>::zeros(free.len(), 1);
        for (pole, partner) in lowest.poles.iter().zip(&partners) {
            let Some((mode, _)) = partner else { continue };
            let left = (pole.angular_frequency / modes[*mode].seen.0).ln();
            for (row, &i) in free.iter().enumerate() {
                let by = modes[*mode].by[i] / (missed * missed);
                slope[(row, 0)] += by * left;
                free.iter().enumerate().for_each(|(column, &j)| curvature[(row, column)] += by * modes[*mode].by[j]);
            }
        }
        for (row, &i) in free.iter().enumerate() {
            let std = if i == NU { RATIO } else { MODULI };
            curvature[(row, row)] += std.powi(-2);
            slope[(row, 0)] += (coordinate(start, i) - coordinate(values, i)) * std.powi(-2);
        }
        let Ok(factor) = curvature.llt(Side::Lower) else { return Ok(*values) };
        let step = factor.solve(&slope);
        let mut next = *values;
        for (row, &i) in free.iter().enumerate() {
            let moved = coordinate(values, i) + step[(row, 0)].clamp(-LONGEST, LONGEST);
            next[i] = if i == NU { moved.clamp(NU_RANGE[0], NU_RANGE[1]) } else { moved.exp() };
        }
        if self.held[NU].is_none() {
            next[NU] = next[NU].min(DEFINITE * (next[0] / next[1]).sqrt());
        }
        Ok(if is_definite(&next) { next } else { *values })
    }
}

/// Which modes poles are.
pub(crate) struct PolesRead {
    /// Of each pole the number of its mode among the flexible ones, from 0.
    pub modes: Vec<Option<usize>>,
    /// Twice the negative logarithm of the likelihood, with what stays alone on either side.
    pub cost: f64,
    /// What it costs more that a pole is another mode: the pole, the mode, and the cost.
    pub others: Vec<(usize, usize, f64)>,
}

/// Constants with what the frequencies of the poles say of them, and of the error of the model.
pub(crate) struct PlateFit {
    pub values: Constants,
    /// Numbers of the constants that are not held.
    pub free: Vec<usize>,
    /// Of the free ones: of the logarithm of each modulus, and of Poisson's ratio.
    pub covariance: Mat<f64>,
    /// Standard deviation of the logarithm of a frequency.
    pub missed: f64,
    /// Negative logarithm of the marginal likelihood of the frequencies that have a mode.
    pub cost: f64,
}

impl PlateFit {
    /// How far a pole and its mode may lie apart.
    pub(crate) fn apart(&self) -> f64 {
        (TIMES * self.missed).max(NEAREST)
    }

    /// Standard deviation of a free constant's coordinate beforehand.
    pub(crate) fn prior(constant: usize) -> f64 {
        if Self::is_logarithmic(constant) { MODULI } else { RATIO }
    }

    /// Whether the coordinate of a constant is its logarithm.
    pub(crate) fn is_logarithmic(constant: usize) -> bool {
        constant != NU
    }

    /// Where a constant rests that the data do not show.
    pub(crate) fn usual(constant: usize, values: &Constants) -> f64 {
        if constant == NU { POISSON * (values[0] / values[1]).sqrt().min(1.0) } else { values[constant] }
    }

    /// Of the free constants the place of that of whose deviation beforehand the data leave most, if more than this part, or which may be zero
    /// for all they say.
    pub(crate) fn most_open(&self, part: f64) -> Option<usize> {
        let left = |&place: &usize| {
            let (constant, deviation) = (self.free[place], self.covariance[(place, place)].sqrt());
            let unit = if Self::is_logarithmic(constant) { 1.0 } else { self.values[constant] };
            (deviation / Self::prior(constant)).max(if deviation > unit { 1.0 } else { 0.0 })
        };
        let most = (0..self.free.len()).max_by(|a, b| left(a).total_cmp(&left(b)));
        most.filter(|place| left(place) > part)
    }
}

/// The frequencies of one plate less those of the poles: with the derivatives, and the variance by noise.
struct Missed {
    rows: Vec<(f64, f64, Vec<f64>)>,
    precision: Vec<f64>,
}

impl Missed {
    /// $J^TC^{-1}J + P$ with $C = \tau^2 + \sigma_m^2$.
    fn curvature(&self, size: f64) -> Mat<f64> {
        let count = self.precision.len();
        let sum = |i: usize, j: usize| -> f64 {
            let of_row = |(_, noise, by): &(f64, f64, Vec<f64>)| by[i] * by[j] / (size * size + noise);
            self.rows.iter().map(of_row).sum()
        };
        Mat::from_fn(count, count, |i, j| sum(i, j) + if i == j { self.precision[i] } else { 0.0 })
    }

    /// The least of [`Self::cost`] over all sizes, each where a step of the constants makes good what it can to first order.
    fn least_cost(&self) -> f64 {
        let count = self.precision.len();
        let of_size = |size: f64| {
            let Ok(factor) = self.curvature(size).llt(Side::Lower) else { return f64::INFINITY };
            let slope = |i: usize| self.rows.iter().map(|(left, noise, by)| by[i] * left / (size * size + noise)).sum();
            let step = factor.solve(&Mat::from_fn(count, 1, |i, _| slope(i)));
            let made_good = |by: &[f64]| (0..count).map(|i| by[i] * step[(i, 0)]).sum::<f64>();
            let rows = self.rows.iter().map(|(left, noise, by)| (left - made_good(by), *noise, by.clone())).collect();
            let moved = Self { rows, precision: self.precision.clone() };
            let prior: f64 = (0..count).map(|i| self.precision[i] * step[(i, 0)].powi(2)).sum();
            moved.cost(size) + 0.5 * prior
        };
        sizes().map(of_size).fold(f64::INFINITY, f64::min)
    }

    /// Negative logarithm of the marginal likelihood of a size of model error, with its prior.
    fn cost(&self, size: f64) -> f64 {
        let variance = |noise: f64| size * size + noise;
        let of_row = |(left, noise, _): &(f64, f64, Vec<f64>)| variance(*noise).ln() + left * left / variance(*noise);
        let of_rows: f64 = self.rows.iter().map(of_row).sum();
        let determinant = self
            .curvature(size)
            .llt(Side::Lower)
            .map_or(f64::INFINITY, |factor| (0..self.precision.len()).map(|i| 2.0 * factor.L()[(i, i)].ln()).sum());
        let (median, factor) = frequency_prior();
        0.5 * (of_rows + determinant + ((size / median).ln() / factor.ln()).powi(2))
    }
}

/// Sizes of model error that are looked at, evenly in the logarithm.
const SIZES: [f64; 2] = [1e-6, 5e-2];
const SIZES_COUNT: usize = 120;
/// A pole and its mode lie no further apart than so many times the model error, and may lie this far at least.
const TIMES: f64 = 2.0;
const NEAREST: f64 = 2e-3;
/// and no mode further than this is another that a pole may be.
const FARTHEST: f64 = 0.1;
const ROUNDS: usize = 8;

/// The sizes that are looked at.
fn sizes() -> impl Iterator<Item = f64> {
    let step = (SIZES[1] / SIZES[0]).ln() / (SIZES_COUNT - 1) as f64;
    (0..SIZES_COUNT).map(move |k| SIZES[0] * (step * k as f64).exp())
}

impl PlateStart<'_> {
    /// What these modes leave of the poles whose partners they are.
    fn missed(&self, modes: &[PlateMode], partners: &[Option<usize>]) -> Missed {
        let free = self.free();
        let row = |(pole, partner): (usize, &Option<usize>)| {
            let mode = &modes[(*partner)?];
            let left = (self.measured.poles[pole].angular_frequency / mode.seen.0).ln();
            let noise = self.measured.covariance[(pole, pole)] + BASIS * BASIS;
            Some((left, noise, free.iter().map(|&i| mode.by[i]).collect()))
        };
        let precision = free.iter().map(|&i| PlateFit::prior(i).powi(-2)).collect();
        Missed { rows: partners.iter().enumerate().filter_map(row).collect(), precision }
    }

    /// The most probable constants near a start by the frequencies of all poles, with the size of the model error integrated over.
    ///
    /// # Errors
    /// What the plate refuses.
    pub(crate) fn fit(&self, start: Constants) -> Result<PlateFit, ModelError> {
        let free = self.free();
        let (mut values, mut size) = (start, STAGES[STAGES.len() - 1].2);
        for round in 0..=ROUNDS {
            heed();
            let modes = self.modes(&values, self.count(self.measured))?;
            let seen: Vec<(f64, Vec<f64>)> = modes.iter().map(|mode| mode.seen.clone()).collect();
            let apart = (TIMES * size).max(NEAREST);
            let (partners, _) = self.measured.assigned(&seen, |_| apart, |pole| self.alone(pole));
            let partners: Vec<Option<usize>> =
                partners.into_iter().map(|partner| partner.map(|(mode, _)| mode)).collect();
            let missed = self.missed(&modes, &partners);
            let sizes: Vec<(f64, f64)> = sizes().map(|size| (size, missed.cost(size))).collect();
            let Some(&(best, least)) = sizes.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            size = best;
            if round == ROUNDS {
                let mut covariance = Mat::<f64>::zeros(free.len(), free.len());
                let mut whole = 0.0;
                for (size, cost) in sizes.iter().filter(|(_, cost)| cost - least < 20.0) {
                    let weight = (least - cost).exp();
                    let Ok(factor) = missed.curvature(*size).llt(Side::Lower) else { continue };
                    covariance += factor.solve(Mat::<f64>::identity(free.len(), free.len())) * faer::Scale(weight);
                    whole += weight;
                }
                covariance *= faer::Scale(1.0 / whole.max(f64::MIN_POSITIVE));
                return Ok(PlateFit { values, free, covariance, missed: size, cost: least });
            }
            values = self.step(self.measured, &start, &values, (apart, size))?;
        }
        let covariance = Mat::zeros(free.len(), free.len());
        Ok(PlateFit { values, covariance, free, missed: size, cost: f64::INFINITY })
    }
}

/// Relative error of a frequency by the basis.
const BASIS: f64 = 2e-5;

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
