//! The paper's second problem: eq. 23 under eq. 25, by downhill simplex with a penalty.

use faer::Mat;
use num_complex::Complex64;
use orthopanel_model::{BeamConstants, Boundary, ExactBeam, ModelError, StaticFlexibility};
use rayon::prelude::*;

use super::pole::Pole;
use super::problem::{AcceleranceProblem, PRIOR_LOG_ZETA_STD, PieceProblem, log_zeta_bounds};
use super::records::PlaceRecord;
use super::resonance_point::{MeasuredPoint, ResonancePoint, greatest, half_width, measured_point};
use super::start::Start;
use super::synthesis::DampingLaw;
use crate::IdentifyError;
use crate::downhill_simplex::{Penalised, downhill_simplex};
use crate::settings::PaperWeights;

/// Resonance points of one piece, a list a record.
type PiecePoints = Vec<Vec<MeasuredPoint>>;

/// Eq. 23, summed over the records,
/// $$W_f\sum_m\frac{(f_{exp}-f_{cal})^2}{f_{exp}^2} + W_G\sum_m\frac{(G(f_{exp})-G(f_{cal}))^2}{G(f_{exp})^2}$$
/// where $G$ is the magnitude at the measured and at the calculated resonance.
pub(super) struct PaperError<'a> {
    problem: &'a AcceleranceProblem,
    boundary: Boundary,
    /// The start of the damping ratios, as logarithms.
    parameters: &'a [f64],
    weights: PaperWeights,
    points: Vec<PiecePoints>,
    /// How well each parameter is known without eq. 23: a damping ratio by its pole.
    pub(super) known: Vec<f64>,
}

/// The minimum of eq. 23 from `parameters`, which are those of the likelihood, with its covariance.
///
/// The simplex moves the free constants. At each of its corners the damping ratios take the values that are best there
/// ([`PaperError::best_damping`]), so the minimum is that over all parameters of eq. 25.
pub(super) fn minimise(
    problem: &AcceleranceProblem,
    start: &Start,
    boundary: Boundary,
    parameters: &[f64],
    weights: PaperWeights,
) -> Result<(Vec<f64>, Option<Mat<f64>>), IdentifyError> {
    let pieces = problem.pieces.iter().zip(&start.poles).zip(&start.matching.modes);
    let points = pieces.map(|((piece, poles), modes)| piece_points(&piece.records, poles, modes)).collect();
    let known = known_by_poles(problem, start);
    let error = PaperError { problem, boundary, parameters, weights, points, known };
    let free = problem.constants.count();
    let mut found = parameters.to_vec();
    if free > 0 {
        let bounds: Vec<(f64, f64)> = problem.bounds().into_iter().take(free).collect();
        let penalised = Penalised { error: |logs: &[f64]| Ok(error.at(logs)?.0), bounds };
        let constants = downhill_simplex(&penalised, &parameters[..free])?;
        found[..free].copy_from_slice(&constants);
    }
    let (_, log_zetas) = error.at(&found[..free])?;
    found[free..].copy_from_slice(&log_zetas);
    let covariance = error.covariance(&found)?;
    Ok((found, covariance))
}

/// Standard deviation of each parameter by the poles alone.
fn known_by_poles(problem: &AcceleranceProblem, start: &Start) -> Vec<f64> {
    let mut known = vec![PRIOR_LOG_ZETA_STD; problem.size()];
    for (index, (poles, modes)) in start.poles.iter().zip(&start.matching.modes).enumerate() {
        let offset = problem.zeta_offset(index);
        for (pole, mode) in poles.iter().zip(modes) {
            if let Some(mode) = mode.filter(|&mode| mode < problem.pieces[index].free_zetas) {
                known[offset + mode] = pole.log_zeta_std;
            }
        }
    }
    known
}

/// A place takes part in a mode whose height it knows within this factor of the place that knows it best. Eq. 23 weighs
/// all magnitudes alike, and a place near a node, which rises little over its noise, would push the constants.
const WORST_KNOWN: f64 = 2.0;

fn piece_points(records: &[PlaceRecord], poles: &[Pole], modes: &[Option<usize>]) -> PiecePoints {
    let of_record = |record: &PlaceRecord| -> Vec<MeasuredPoint> {
        let matched = poles.iter().zip(modes).filter_map(|(pole, mode)| Some((pole, (*mode)?)));
        matched.filter_map(|(pole, mode)| measured_point(record, pole, mode)).collect()
    };
    let mut points: PiecePoints = records.par_iter().map(of_record).collect();
    let all: Vec<MeasuredPoint> = points.iter().flatten().copied().collect();
    let best = |mode: usize| {
        all.iter().filter(|point| point.mode == mode).fold(f64::INFINITY, |least, point| least.min(point.log_std))
    };
    points.iter_mut().for_each(|own| own.retain(|point| point.log_std <= WORST_KNOWN * best(point.mode)));
    points
}

/// One record's accelerance as a sum over the exact modes below 2.5 times the band and the static part of the others.
struct PlaceModel {
    rigid: f64,
    /// $\omega_m$ and $W_m(l_1)W_m(l_x)$ of each flexible mode.
    modes: Vec<(f64, f64)>,
    /// Static flexibility less that of the modes in the sum.
    rest: f64,
    decay_rate: f64,
}

impl PlaceModel {
    fn at(&self, frequency: f64, zetas: &[f64], law: DampingLaw) -> Complex64 {
        let s = Complex64::new(self.decay_rate, std::f64::consts::TAU * frequency);
        let s2 = s * s;
        let modes = self.modes.iter().zip(zetas);
        let sum: Complex64 = modes
            .map(|(&(omega, product), &zeta)| {
                // s² + ω_m² by its factors: near the resonance the sum would lose as many digits as 1/ζ has.
                let real = self.decay_rate * self.decay_rate + (omega - s.im) * (omega + s.im);
                let d = Complex64::new(real, s2.im) + law.term(omega, zeta, s);
                product * s2 / d
            })
            .sum();
        sum + self.rigid + self.rest * s2
    }

    /// Where a mode's resonance stands; `None` for a mode beyond the sum.
    fn resonance(&self, mode: usize, zetas: &[f64], law: DampingLaw) -> Option<ResonancePoint> {
        let (&(omega, _), &zeta) = self.modes.get(mode).zip(zetas.get(mode))?;
        let natural = omega / std::f64::consts::TAU;
        Some(greatest(|f| self.at(f, zetas, law), natural, half_width(omega, zeta, self.decay_rate)))
    }

    /// $\partial H/\partial\ln\zeta_m$.
    fn by_log_zeta(&self, frequency: f64, zeta: f64, mode: usize, law: DampingLaw) -> Complex64 {
        let s = Complex64::new(self.decay_rate, std::f64::consts::TAU * frequency);
        let Some(&(omega, product)) = self.modes.get(mode) else { return Complex64::ZERO };
        let loss = law.term(omega, zeta, s);
        let d = s * s + omega * omega + loss;
        -product * s * s * loss / (d * d)
    }
}

/// Gauss-Newton steps on the damping ratios: the reciprocal magnitude is nearly straight in the ratio.
const DAMPING_STEPS: usize = 20;
/// A step this small in $\ln\zeta$ ends them.
const SMALL_DAMPING_STEP: f64 = 1e-11;

impl PaperError<'_> {
    /// The error at logarithms of the free constants, with the logarithms of the best damping ratios.
    fn at(&self, logs: &[f64]) -> Result<(f64, Vec<f64>), ModelError> {
        let (mut sum, mut all) = (0.0, Vec::new());
        for (index, piece) in self.problem.pieces.iter().enumerate() {
            let values = self.problem.values(logs, index);
            let models = self.place_models(piece, BeamConstants { e_x: values[0], g_zx: values[1] })?;
            let offset = self.problem.zeta_offset(index);
            let start = &self.parameters[offset..offset + piece.free_zetas];
            let (error, log_zetas) = self.best_damping(piece, &models, &self.points[index], start);
            sum += error;
            all.extend(log_zetas);
        }
        Ok((sum, all))
    }

    /// What eq. 23 squares, before its weights: of every point the relative misfit of the frequency, then of the magnitude.
    pub(super) fn misfits(&self, parameters: &[f64]) -> Result<Vec<f64>, ModelError> {
        let mut misfits = Vec::new();
        for (index, (piece, points)) in self.problem.pieces.iter().zip(&self.points).enumerate() {
            let (values, log_zetas) = self.problem.of_piece(index, parameters);
            let models = self.place_models(piece, BeamConstants { e_x: values[0], g_zx: values[1] })?;
            let zetas = piece.zetas(log_zetas);
            for (model, points) in models.iter().zip(points) {
                for &MeasuredPoint { mode, point: measured, .. } in points {
                    let found = model.resonance(mode, &zetas, self.problem.law);
                    let missed = |found: f64, measured: f64| found / measured - 1.0;
                    misfits.extend(found.map_or([0.0; 2], |found| {
                        [missed(found.frequency, measured.frequency), missed(found.magnitude, measured.magnitude)]
                    }));
                }
            }
        }
        Ok(misfits)
    }

    /// Whether a parameter is a damping ratio.
    pub(super) fn is_damping(&self, parameter: usize) -> bool {
        parameter >= self.problem.constants.count()
    }

    /// Whether eq. 23 tells a parameter: a damping ratio by magnitudes of its mode.
    pub(super) fn moves(&self, parameter: usize) -> bool {
        let of_piece = |index: usize| parameter.checked_sub(self.problem.zeta_offset(index));
        let is_told = |(index, points): (usize, &PiecePoints)| {
            points.iter().flatten().any(|point| Some(point.mode) == of_piece(index))
        };
        !self.is_damping(parameter) || (self.weights.magnitude > 0.0 && self.points.iter().enumerate().any(is_told))
    }

    /// Of each of these misfits its weight, and its variance by the noise of the record.
    pub(super) fn weights_and_variances(&self) -> (Vec<f64>, Vec<f64>) {
        let points = self.points.iter().flatten().flatten();
        let of_point = |point: &MeasuredPoint| {
            let weights = [self.weights.frequency, self.weights.magnitude];
            [(weights[0], point.variance[0]), (weights[1], point.variance[1])]
        };
        points.flat_map(of_point).unzip()
    }

    fn place_models(&self, piece: &PieceProblem, constants: BeamConstants) -> Result<Vec<PlaceModel>, ModelError> {
        let beam = ExactBeam::new(&piece.sizes, self.boundary, constants)?;
        let flexibility = StaticFlexibility::new(&piece.sizes, self.boundary)?;
        let rigid = beam.rigid_modes();
        let flexible: Vec<_> = beam.flexible_modes().take(piece.summed).collect();
        let model = |record: &PlaceRecord| {
            let (force, response) = (record.force_at.x, record.response_at.x);
            let product = |mode: &orthopanel_model::BeamMode| mode.deflection(force) * mode.deflection(response);
            let modes: Vec<(f64, f64)> =
                flexible.iter().map(|mode| (mode.angular_frequency(), product(mode))).collect();
            let (static_part, _) = flexibility.between(force, response, constants.e_x, constants.g_zx);
            let summed: f64 = modes.iter().map(|(omega, product)| product / (omega * omega)).sum();
            let rigid = rigid.iter().map(product).sum();
            PlaceModel { rigid, modes, rest: static_part - summed, decay_rate: record.decay_rate }
        };
        Ok(piece.records.iter().map(model).collect())
    }

    /// The error of one piece with the best damping ratios, and their logarithms.
    ///
    /// A resonance's magnitude follows its own mode's ratio, all others shift it by less than that ratio's square; its
    /// frequency moves by $\zeta^2$ only. So each ratio takes Gauss-Newton steps on the magnitudes of its own mode. A
    /// ratio that no record shows stays at its start.
    fn best_damping(
        &self,
        piece: &PieceProblem,
        models: &[PlaceModel],
        points: &PiecePoints,
        start: &[f64],
    ) -> (f64, Vec<f64>) {
        let law = self.problem.law;
        let (lowest, highest) = log_zeta_bounds();
        let mut log_zetas = start.to_vec();
        let mut error = 0.0;
        for _ in 0..DAMPING_STEPS {
            let zetas = piece.zetas(&log_zetas);
            // (gradient, curvature) of each mode's magnitudes.
            let mut steps = vec![(0.0_f64, 0.0_f64); log_zetas.len()];
            error = 0.0;
            for (model, points) in models.iter().zip(points) {
                for &MeasuredPoint { mode, point: measured, .. } in points {
                    let Some(found) = model.resonance(mode, &zetas, law) else { continue };
                    let zeta = zetas[mode];
                    let value = |f: f64| model.at(f, &zetas, law);
                    let missed = found.magnitude / measured.magnitude - 1.0;
                    error += self.weights.frequency * (found.frequency / measured.frequency - 1.0).powi(2)
                        + self.weights.magnitude * missed * missed;
                    let by = model.by_log_zeta(found.frequency, zeta, mode, law);
                    let slope = (value(found.frequency).conj() * by).re / (found.magnitude * measured.magnitude);
                    if let Some((gradient, curvature)) = steps.get_mut(mode) {
                        *gradient += slope * missed;
                        *curvature += slope * slope;
                    }
                }
            }
            let mut most = 0.0_f64;
            for (log_zeta, (gradient, curvature)) in log_zetas.iter_mut().zip(steps) {
                let step = if curvature > 0.0 { (-gradient / curvature).clamp(-1.0, 1.0) } else { 0.0 };
                let next = (*log_zeta + step).clamp(lowest, highest);
                most = most.max((next - *log_zeta).abs());
                *log_zeta = next;
            }
            if most < SMALL_DAMPING_STEP {
                break;
            }
        }
        (error, log_zetas)
    }
}
