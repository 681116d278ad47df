//! The most probable parameters of a hypothesis, their covariance, and its evidence.

use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::Solve;
use faer::{Mat, Par, Side};
use orthopanel_model::ModelError;

use crate::hypothesis::Hypothesis;
use crate::model_error::{ErrorColumns, KINDS, Waves, deviations, medians};
use crate::predicted::{Prediction, Predictor};

/// Step of a difference, in coordinates.
const STEP: f64 = 1e-4;
/// Longest step of a coordinate, and of the logarithm of a size of model error.
const LONGEST: f64 = 0.7;
const LONGEST_SIZE: f64 = 1.0;
/// Bounds of a size of model error.
const SIZES: [f64; 2] = [1e-6, 0.5];

/// $C = LL^T$, and $\ln\det C$.
pub(crate) struct Whitening {
    factor: Llt<f64>,
    pub log_determinant: f64,
}

impl Whitening {
    pub(crate) fn new(covariance: &Mat<f64>) -> Option<Self> {
        let factor = covariance.llt(Side::Lower).ok()?;
        let lower = factor.L();
        let log_determinant = (0..covariance.nrows()).map(|i| 2.0 * lower[(i, i)].ln()).sum();
        Some(Self { factor, log_determinant })
    }

    /// $L^{-1}$ times these columns.
    pub(crate) fn whiten(&self, columns: &mut Mat<f64>) {
        solve_lower_triangular_in_place(self.factor.L(), columns.as_mut(), Par::Seq);
    }

    pub(crate) fn whitened(&self, values: &[f64]) -> Vec<f64> {
        let mut column = Mat::from_fn(values.len(), 1, |i, _| values[i]);
        self.whiten(&mut column);
        column.col_as_slice(0).to_vec()
    }
}

/// A hypothesis held against the measured modes.
pub(crate) struct Problem<'a> {
    pub predictor: &'a Predictor<'a>,
    pub hypothesis: &'a Hypothesis,
    /// What unevenness does, of [`crate::model_error::waves`].
    pub waves: &'a Waves,
}

/// A point in the coordinates of a hypothesis, with its misfit $r^TC^{-1}r + z^TPz$.
#[derive(Clone)]
pub(crate) struct Point {
    pub z: Vec<f64>,
    pub misfit: f64,
}

/// The posterior about its mode.
#[derive(Clone)]
pub(crate) struct Posterior {
    pub z: Vec<f64>,
    /// Of the coordinates.
    pub covariance: Mat<f64>,
    /// $\ln\tau_k$.
    pub log_sizes: [f64; KINDS],
    pub log_evidence: f64,
}

/// A hypothesis with its posterior.
#[derive(Clone)]
pub(crate) struct Judged {
    pub hypothesis: Hypothesis,
    pub posterior: Posterior,
    /// Logarithm of the evidence times the prior of the hypothesis: each effect lacks by itself, one of the catalogue in a test, in each of
    /// its ways alike.
    pub log_odds: f64,
}

impl Judged {
    /// Names of the undeclared effects.
    pub(crate) fn names(&self) -> Vec<&'static str> {
        self.hypothesis.undeclared().map(|part| part.effect.id()).collect()
    }
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

impl Problem<'_> {
    fn at(&self, z: &[f64]) -> Result<Prediction, ModelError> {
        self.predictor.at(&self.hypothesis.constants(z), &self.hypothesis.effects(z)?, false)
    }

    /// With the derivatives by places that model errors want.
    pub(crate) fn with_slopes(&self, z: &[f64]) -> Result<Prediction, ModelError> {
        self.predictor.at(&self.hypothesis.constants(z), &self.hypothesis.effects(z)?, true)
    }

    /// What is measured less what is predicted.
    pub(crate) fn missed(&self, at: &Prediction) -> Vec<f64> {
        self.predictor
            .comparison
            .values
            .iter()
            .zip(&at.values)
            .map(|(measured, predicted)| measured - predicted)
            .collect()
    }

    pub(crate) fn errors(&self, at: &Prediction) -> ErrorColumns {
        ErrorColumns::about(self.predictor.comparison, at, self.waves)
    }

    pub(crate) fn whitening(&self, errors: &ErrorColumns, log_sizes: &[f64; KINDS]) -> Option<Whitening> {
        Whitening::new(&errors.covariance(&self.predictor.comparison.noise, log_sizes))
    }

    /// With remainders that tell little: no more than their size.
    pub(crate) fn whitening_of_modes(&self, errors: &ErrorColumns, log_sizes: &[f64; KINDS]) -> Option<Whitening> {
        let comparison = self.predictor.comparison;
        let mut covariance = errors.covariance(&comparison.noise, log_sizes);
        for record in 0..comparison.measured.records.len() {
            for place in comparison.remainder_place(record, 0)..comparison.block_of(record).end {
                covariance[(place, place)] += comparison.values[place].powi(2).max(1.0);
            }
        }
        Whitening::new(&covariance)
    }

    fn prior(&self, z: &[f64]) -> f64 {
        z.iter().zip(self.hypothesis.precision()).map(|(z, precision)| precision * z * z).sum()
    }

    /// The misfit at a point; `None` where the model has no meaning.
    pub(crate) fn point(&self, z: Vec<f64>, by: &Whitening) -> Option<Point> {
        let at = self.at(&z).ok()?;
        let misfit = square(&by.whitened(&self.missed(&at))) + self.prior(&z);
        misfit.is_finite().then_some(Point { z, misfit })
    }

    /// $L^{-1}\partial f/\partial z$ by differences that stay inside the bounds.
    pub(crate) fn derivatives(&self, z: &[f64], at: &Prediction, by: &Whitening) -> Option<Mat<f64>> {
        let farthest = self.hypothesis.farthest();
        let mut columns = Mat::zeros(at.values.len(), z.len());
        let by_places = self.by_places(z, at);
        for (number, farthest) in farthest.iter().enumerate() {
            if let Some(column) = by_places.get(number).and_then(Option::as_ref) {
                column.iter().enumerate().for_each(|(row, value)| columns[(row, number)] = *value);
                continue;
            }
            let step = if z[number] + STEP < *farthest { STEP } else { -STEP };
            let mut moved = z.to_vec();
            moved[number] += step;
            let moved = self.at(&moved).ok()?;
            for (row, (moved, at)) in moved.values.iter().zip(&at.values).enumerate() {
                columns[(row, number)] = (moved - at) / step;
            }
        }
        by.whiten(&mut columns);
        Some(columns)
    }

    /// Derivatives by the coordinates that move places alone, which need no modes of their own.
    fn by_places(&self, z: &[f64], at: &Prediction) -> Vec<Option<Vec<f64>>> {
        let mut columns: Vec<Option<Vec<f64>>> = vec![None; self.hypothesis.free_constants()];
        let measured = self.predictor.comparison.measured;
        for (part, z) in self.hypothesis.parts.iter().zip(self.hypothesis.of_parts(z)) {
            for (number, slope) in part.slopes(z).iter().enumerate() {
                let mut column = vec![0.0; at.values.len()];
                let mut places_alone = true;
                for record in 0..measured.records.len() {
                    let shifts = part.shifts(self.predictor, record, number);
                    places_alone &= shifts.is_some();
                    for of_response in shifts.into_iter().flatten() {
                        let by = if of_response { &at.by_response } else { &at.by_force };
                        let block = self.predictor.comparison.block_of(record);
                        block.for_each(|row| column[row] += slope * by[row]);
                    }
                }
                columns.push((places_alone && !measured.records.is_empty()).then_some(column));
            }
        }
        columns
    }

    /// Down from a point (Levenberg and Marquardt), with the curvature $J^TJ + P$ where it ends.
    pub(crate) fn follow(
        &self,
        from: Point,
        by: &Whitening,
        most: usize,
        least_gain: f64,
    ) -> Option<(Point, Mat<f64>)> {
        let precision = self.hypothesis.precision();
        let size = from.z.len();
        let (mut point, mut damping) = (from, 1e-3);
        let mut curvature = Mat::identity(size, size);
        for round in 0..=most {
            let at = self.with_slopes(&point.z).ok()?;
            let derivatives = self.derivatives(&point.z, &at, by)?;
            curvature = derivatives.transpose() * &derivatives;
            (0..size).for_each(|i| curvature[(i, i)] += precision[i]);
            if round == most || size == 0 {
                break;
            }
            let missed = by.whitened(&self.missed(&at));
            let descent = Mat::from_fn(size, 1, |i, _| {
                derivatives.col_as_slice(i).iter().zip(&missed).map(|(a, b)| a * b).sum::<f64>()
                    - precision[i] * point.z[i]
            });
            let mut lower = None;
            while damping < 1e6 {
                let damped = Mat::from_fn(size, size, |i, j| {
                    curvature[(i, j)] + if i == j { damping * (curvature[(i, i)] + 1e-6) } else { 0.0 }
                });
                let step = damped.llt(Side::Lower).ok()?.solve(&descent);
                let mut z: Vec<f64> = (0..size).map(|i| point.z[i] + step[(i, 0)].clamp(-LONGEST, LONGEST)).collect();
                self.hypothesis.clamp(&mut z);
                lower = self.point(z, by).filter(|next| next.misfit < point.misfit);
                if lower.is_some() {
                    break;
                }
                damping = (8.0 * damping).max(1e-4);
            }
            let Some(next) = lower else { break };
            let gain = point.misfit - next.misfit;
            (point, damping) = (next, (damping / 8.0).max(1e-7));
            if gain < least_gain {
                break;
            }
        }
        Some((point, curvature))
    }

    /// The most probable sizes of model error at a point, by Fisher's scores; with their curvature and
    /// $\tfrac12(\ln\det C + r^TC^{-1}r) + \tfrac12\sum((\ln\tau_k-\mu_k)/s_k)^2$.
    pub(crate) fn sizes(
        &self,
        at: &Prediction,
        errors: &ErrorColumns,
        mut log_sizes: [f64; KINDS],
        most: usize,
    ) -> Option<([f64; KINDS], Mat<f64>, f64)> {
        let missed = self.missed(at);
        let (medians, deviations) = (medians(), deviations());
        let cost = |log_sizes: &[f64; KINDS]| {
            let by = self.whitening(errors, log_sizes)?;
            let prior: f64 = (0..KINDS).map(|k| ((log_sizes[k] - medians[k]) / deviations[k]).powi(2)).sum();
            let value = 0.5 * (by.log_determinant + square(&by.whitened(&missed)) + prior);
            value.is_finite().then_some((value, by))
        };
        let (mut value, mut by) = cost(&log_sizes)?;
        let count = errors.columns.ncols();
        let mut curvature;
        let mut round = 0;
        loop {
            let mut columns = Mat::from_fn(missed.len(), count + 1, |i, j| match errors.kinds.get(j) {
                Some(&kind) => errors.columns[(i, j)] * log_sizes[kind].exp(),
                None => missed[i],
            });
            by.whiten(&mut columns);
            let products = columns.transpose() * &columns;
            let mut slope = Mat::<f64>::zeros(KINDS, 1);
            curvature = Mat::<f64>::zeros(KINDS, KINDS);
            for j in 0..count {
                slope[(errors.kinds[j], 0)] += products[(j, j)] - products[(j, count)].powi(2);
                for i in 0..count {
                    curvature[(errors.kinds[i], errors.kinds[j])] += 2.0 * products[(i, j)].powi(2);
                }
            }
            for k in 0..KINDS {
                let precision = deviations[k].powi(-2);
                slope[(k, 0)] += (log_sizes[k] - medians[k]) * precision;
                curvature[(k, k)] += precision;
            }
            round += 1;
            if round > most {
                break;
            }
            let step = curvature.llt(Side::Lower).ok()?.solve(&slope);
            let mut share = 1.0;
            let next = loop {
                let mut next = log_sizes;
                for k in 0..KINDS {
                    let moved = log_sizes[k] - share * step[(k, 0)].clamp(-LONGEST_SIZE, LONGEST_SIZE);
                    next[k] = moved.clamp(SIZES[0].ln(), SIZES[1].ln());
                }
                match cost(&next) {
                    Some((lower, by)) if lower < value => break Some((next, lower, by)),
                    _ if share < 0.05 => break None,
                    _ => share *= 0.4,
                }
            };
            let Some((next, lower, next_by)) = next else { break };
            let gain = value - lower;
            (log_sizes, value, by) = (next, lower, next_by);
            if gain < 0.02 {
                break;
            }
        }
        Some((log_sizes, curvature, value))
    }

    /// Parameters and sizes of model error in turn, then the marginal likelihood by Laplace's approximation over both.
    pub(crate) fn posterior(&self, from: Vec<f64>, mut log_sizes: [f64; KINDS], rounds: usize) -> Option<Posterior> {
        let mut z = from;
        let mut errors = self.errors(&self.with_slopes(&z).ok()?);
        let mut last = f64::INFINITY;
        for round in 0..rounds {
            let by = self.whitening(&errors, &log_sizes)?;
            let point = self.point(z, &by)?;
            // A few steps before the sizes are what they are to be.
            let (point, _) = self.follow(point, &by, if round == 0 { 3 } else { 8 }, 0.05)?;
            z = point.z;
            let at = self.with_slopes(&z).ok()?;
            errors = self.errors(&at);
            let (next, _, cost) = self.sizes(&at, &errors, log_sizes, 6)?;
            log_sizes = next;
            let value = cost - self.hypothesis.log_prior(&z);
            if (last - value).abs() < 0.05 {
                break;
            }
            last = value;
        }
        let by = self.whitening(&errors, &log_sizes)?;
        let (point, curvature) = self.follow(self.point(z, &by)?, &by, 3, 0.01)?;
        let at = self.at(&point.z).ok()?;
        let (_, of_sizes, _) = self.sizes(&at, &errors, log_sizes, 0)?;
        let missed = by.whitened(&self.missed(&at));
        let chi_square = square(&missed);
        let count = point.z.len() as f64;
        let half_log = |matrix: &Mat<f64>| Some(0.5 * Whitening::new(matrix)?.log_determinant);
        let data = missed.len() as f64;
        let turn = std::f64::consts::TAU.ln();
        let (medians, deviations) = (medians(), deviations());
        let prior_of_sizes: f64 =
            (0..KINDS).map(|k| -0.5 * ((log_sizes[k] - medians[k]) / deviations[k]).powi(2) - deviations[k].ln()).sum();
        let log_evidence = -0.5 * (chi_square + by.log_determinant + data * turn)
            + self.hypothesis.log_prior(&point.z)
            + 0.5 * count * turn
            - half_log(&curvature)?
            + prior_of_sizes
            - half_log(&of_sizes)?;
        let covariance = curvature.llt(Side::Lower).ok()?.solve(Mat::<f64>::identity(point.z.len(), point.z.len()));
        Some(Posterior { z: point.z, covariance, log_sizes, log_evidence })
    }
}
