//! The most probable parameters of a hypothesis, their covariance, and its evidence.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use std::sync::Arc;

use faer::linalg::solvers::Llt;
use faer::prelude::Solve;
use faer::{Mat, Side};
use orthopanel_model::{ModelError, Shift};

use crate::hypothesis::{Hypothesis, Role};
use crate::model_error::{ErrorColumns, KINDS, deviations, least_sizes, medians};
use crate::stacked::{Predictions, Stacked};
use crate::whitening::Whitening;

/// Step of a difference, in coordinates.
const STEP: f64 = 1e-4;
/// Longest step of a coordinate, and of the logarithm of a size of model error.
const LONGEST: f64 = 0.7;
const LONGEST_SIZE: f64 = 1.0;
/// A step this long, in coordinates, may bend.
const CURVED: f64 = 0.01;
/// Least fall of the logarithm of the posterior that is followed further.
const LEAST_FALL: f64 = 0.05;
/// Least damping of a step, in parts of the curvature.
const LEAST_DAMPING: f64 = 1e-7;
/// Part of the least gain of a step that is not worth trying it.
const NO_GAIN: f64 = 0.02;
/// Largest size of model error.
const LARGEST_SIZE: f64 = 0.5;

/// A hypothesis held against the measured modes.
pub(crate) struct Problem<'a> {
    pub stacked: &'a Stacked<'a>,
    pub hypothesis: &'a Hypothesis,
}

/// A point in the coordinates of a hypothesis, with its misfit $r^TC^{-1}r + z^TPz$.
#[derive(Clone)]
pub(crate) struct Point {
    pub z: Vec<f64>,
    pub misfit: f64,
    /// The misfit and $\ln\det C$: what points that have covariances of their own are compared by.
    pub cost: f64,
    /// What is predicted there, with derivatives by places.
    pub at: Arc<Predictions>,
    /// $\partial f/\partial z$ there or not far from there; empty where it is not known.
    pub derivatives: Mat<f64>,
    /// Whether they are those at this very point.
    pub is_exact: bool,
}

/// How far a point is followed.
#[derive(Clone, Copy)]
pub(crate) struct Following {
    /// Steps at most.
    pub most: usize,
    /// A step that lowers the misfit by less is the last.
    pub least_gain: f64,
    /// Derivatives by the coordinates before this that the point brings are kept up by its steps, and those by the others found anew at each.
    pub exact_from: usize,
    /// Whether derivatives that were kept up are found anew where they lead nowhere, before that is believed.
    pub exactly: bool,
}

impl Following {
    /// To where exact derivatives lead no further.
    pub(crate) fn to_the_end(most: usize, least_gain: f64) -> Self {
        Self { most, least_gain, exact_from: usize::MAX, exactly: true }
    }
}

/// A point with the most probable sizes of model error there.
struct Weighed {
    point: Point,
    errors: ErrorColumns,
    log_sizes: [f64; KINDS],
    /// The logarithm of the posterior of both, negative.
    value: f64,
}

/// The posterior about its mode.
#[derive(Clone)]
pub(crate) struct Posterior {
    pub point: Point,
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
    /// How many numbers the data determine, $\sum_i(1 - \Sigma_{ii}/\sigma_i^2)$ with the deviations $\sigma$ of the priors: none for one that its prior alone
    /// tells, one for one that no prior is needed for. Source: D. J. C. MacKay, Neural Computation 4 (1992) 415, eq. 4.9.
    pub(crate) fn determined(&self) -> usize {
        let precision = self.hypothesis.precision();
        let own = (0..precision.len()).map(|i| 1.0 - precision[i] * self.posterior.covariance[(i, i)]);
        own.sum::<f64>().round().max(0.0) as usize
    }

    /// Names of the undeclared effects in the order of letters.
    pub(crate) fn set(&self) -> Vec<&'static str> {
        let mut names = self.names();
        names.sort_unstable();
        names
    }

    /// Names of the undeclared effects.
    pub(crate) fn names(&self) -> Vec<&'static str> {
        self.hypothesis.undeclared().map(|part| part.effect.id()).collect()
    }
}

/// What some coordinates make good of a misfit, to first order.
pub(crate) struct Projection<'a> {
    by: &'a Whitening,
    /// $L^{-1}J$.
    derivatives: Mat<f64>,
    precision: Vec<f64>,
    curvature: Llt<f64>,
}

impl<'a> Projection<'a> {
    pub(crate) fn new(derivatives: &Mat<f64>, precision: &[f64], by: &'a Whitening) -> Option<Self> {
        let mut derivatives = derivatives.clone();
        by.whiten(&mut derivatives);
        let mut curvature = derivatives.transpose() * &derivatives;
        // What changes nothing has a slope of zero.
        let ridge = |own: f64| 1e-9 * own + f64::MIN_POSITIVE.sqrt();
        (0..precision.len()).for_each(|i| curvature[(i, i)] += precision[i] + ridge(curvature[(i, i)]));
        Some(Self { by, derivatives, precision: precision.to_vec(), curvature: curvature.llt(Side::Lower).ok()? })
    }

    /// The step of the coordinates from `z` that makes most of it good, and by how much the misfit falls.
    pub(crate) fn of(&self, missed: &[f64], z: &[f64]) -> (Vec<f64>, f64) {
        let missed = self.by.whitened(missed);
        let descent = Mat::from_fn(self.precision.len(), 1, |i, _| {
            self.derivatives.col_as_slice(i).iter().zip(&missed).map(|(a, b)| a * b).sum::<f64>()
                - self.precision[i] * z[i]
        });
        let step = self.curvature.solve(&descent);
        let gain = (0..step.nrows()).map(|i| step[(i, 0)] * descent[(i, 0)]).sum();
        (step.col_as_slice(0).to_vec(), gain)
    }
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

impl Problem<'_> {
    /// What is predicted at a point, with derivatives by places.
    pub(crate) fn at(&self, z: &[f64]) -> Result<Predictions, ModelError> {
        self.stacked.at(self.hypothesis, z)
    }

    /// What is measured less what is predicted.
    pub(crate) fn missed(&self, at: &Predictions) -> Vec<f64> {
        self.stacked.missed(at)
    }

    pub(crate) fn errors(&self, at: &Predictions) -> ErrorColumns {
        self.stacked.errors(at)
    }

    pub(crate) fn whitening(&self, errors: &ErrorColumns, log_sizes: &[f64; KINDS]) -> Option<Whitening> {
        errors.whitening((self.stacked.noise(), self.stacked.split()), log_sizes, &[])
    }

    /// With remainders that tell little: no more than their size.
    pub(crate) fn whitening_of_modes(&self, errors: &ErrorColumns, log_sizes: &[f64; KINDS]) -> Option<Whitening> {
        let mut more = Vec::new();
        for (range, block) in self.stacked.ranges().zip(&self.stacked.blocks) {
            let comparison = block.comparison();
            for record in 0..comparison.measured.records.len() {
                for place in comparison.remainder_place(record, 0)..comparison.block_of(record).end {
                    more.push((range.start + place, comparison.variance_of_size(place)));
                }
            }
        }
        errors.whitening((self.stacked.noise(), self.stacked.split()), log_sizes, &more)
    }

    fn prior(&self, z: &[f64]) -> f64 {
        z.iter().zip(self.hypothesis.precision()).map(|(z, precision)| precision * z * z).sum()
    }

    /// The misfit at a point; `None` where the model has no meaning.
    pub(crate) fn point(&self, z: Vec<f64>, by: &Whitening) -> Option<Point> {
        self.judged_by(self.unjudged(z)?, by)
    }

    /// A point whose misfit is not asked for.
    pub(crate) fn unjudged(&self, z: Vec<f64>) -> Option<Point> {
        let at = Arc::new(self.at(&z).ok()?);
        Some(Point { z, misfit: 0.0, cost: 0.0, at, derivatives: Mat::new(), is_exact: false })
    }

    /// The same point with its misfit by another covariance.
    pub(crate) fn judged_by(&self, point: Point, by: &Whitening) -> Option<Point> {
        let misfit = square(&by.whitened(&self.missed(&point.at))) + self.prior(&point.z);
        misfit.is_finite().then_some(Point { misfit, cost: misfit + by.log_determinant, ..point })
    }

    /// $\partial f/\partial z$ by these coordinates, by differences that stay inside the bounds.
    pub(crate) fn derivatives(&self, point: &Point, by: Range<usize>) -> Option<Mat<f64>> {
        let farthest = self.hypothesis.farthest();
        let by_places = self.by_places(&point.z, &point.at);
        let mut columns = Mat::zeros(point.at.values.len(), by.len());
        for (column, number) in by.enumerate() {
            if let Some(of_places) = by_places.get(number).and_then(Option::as_ref) {
                columns.col_as_slice_mut(column).copy_from_slice(of_places);
                continue;
            }
            let by = |step: f64| -> Option<(f64, Predictions)> {
                let mut moved = point.z.clone();
                moved[number] += step;
                Some((step, self.at(&moved).ok()?))
            };
            let inwards = if point.z[number] + STEP < farthest[number] { STEP } else { -STEP };
            let mut moved = by(inwards)?;
            // Where a pole takes another mode for its partner, what is predicted jumps: the other side has the slope.
            if !moved.1.pairs_as(&point.at) && point.z[number] - inwards < farthest[number] {
                let size = |(_, moved): &(f64, Predictions)| -> f64 {
                    moved.values.iter().zip(&point.at.values).map(|(moved, at)| (moved - at).powi(2)).sum()
                };
                moved = by(-inwards).filter(|other| size(other) < size(&moved)).unwrap_or(moved);
            }
            let (step, moved) = moved;
            for (row, (moved, at)) in moved.values.iter().zip(&point.at.values).enumerate() {
                columns[(row, column)] = (moved - at) / step;
            }
        }
        Some(columns)
    }

    /// The derivatives once the point has moved: exact by places, else Broyden's, the least change that foretells the step.
    fn moved_derivatives(&self, from: &Point, to: &Point) -> Mat<f64> {
        let mut derivatives = from.derivatives.clone();
        let step: Vec<f64> = to.z.iter().zip(&from.z).map(|(to, from)| to - from).collect();
        let length = square(&step);
        // Over less than the step of a difference it would be rounding.
        if length > STEP * STEP {
            for row in 0..derivatives.nrows() {
                let foretold: f64 =
                    step.iter().enumerate().map(|(column, step)| derivatives[(row, column)] * step).sum();
                let missed = (to.at.values[row] - from.at.values[row] - foretold) / length;
                step.iter().enumerate().for_each(|(column, step)| derivatives[(row, column)] += missed * step);
            }
        }
        for (number, of_places) in self.by_places(&to.z, &to.at).iter().enumerate() {
            if let Some(of_places) = of_places {
                derivatives.col_as_slice_mut(number).copy_from_slice(of_places);
            }
        }
        derivatives
    }

    /// Derivatives by the coordinates that move places alone, which need no modes of their own.
    fn by_places(&self, z: &[f64], at: &Predictions) -> Vec<Option<Vec<f64>>> {
        let mut columns: Vec<Option<Vec<f64>>> = vec![None; self.hypothesis.free_constants()];
        for (part, z) in self.hypothesis.parts.iter().zip(self.hypothesis.of_parts(z)) {
            for (number, slope) in part.slopes(z).iter().enumerate() {
                let mut column = vec![0.0; at.values.len()];
                let mut places_alone = !self.stacked.first().comparison().measured.records.is_empty();
                for ((range, block), at) in self.stacked.ranges().zip(&self.stacked.blocks).zip(&at.blocks) {
                    let records = block.comparison().measured.records.len();
                    for record in 0..records {
                        let shifts = part.shifts(&block.predictor, record, number);
                        places_alone &= shifts.is_some();
                        for Shift { of_response, offset } in shifts.into_iter().flatten() {
                            let by = if of_response { &at.by_response } else { &at.by_force };
                            for (by, along) in by.iter().zip(offset).filter(|(_, along)| *along != 0.0) {
                                let own = block.comparison().block_of(record);
                                own.for_each(|row| column[range.start + row] += slope * along * by[row]);
                            }
                        }
                    }
                }
                // Feet on which nothing stands.
                places_alone |= part.role == Role::Nuisance && !at.blocks.iter().any(|block| block.on_feet);
                columns.push(places_alone.then_some(column));
            }
        }
        columns
    }

    /// Down from a point (Levenberg and Marquardt, with geodesic acceleration along curved valleys: Transtrum and Sethna,
    /// arXiv:1201.5885), with the curvature $J^TJ + P$ where it ends.
    pub(crate) fn follow(&self, from: Point, by: &Whitening, how: Following) -> Option<(Point, Mat<f64>)> {
        let Following { most, least_gain, exact_from, exactly } = how;
        let worth_a_step = NO_GAIN * least_gain;
        let precision = self.hypothesis.precision();
        let size = from.z.len();
        let mut point = self.judged_by(from, by)?;
        let known = (point.derivatives.nrows(), point.derivatives.ncols());
        if known != (point.at.values.len(), size) {
            self.find_derivatives(&mut point)?;
        }
        let (mut damping, mut round) = (1e-3, 0);
        loop {
            let mut derivatives = point.derivatives.clone();
            by.whiten(&mut derivatives);
            let mut curvature = derivatives.transpose() * &derivatives;
            (0..size).for_each(|i| curvature[(i, i)] += precision[i]);
            if round == most || size == 0 {
                return Some((point, curvature));
            }
            let along = |values: &[f64]| {
                let values = by.whitened(values);
                Mat::from_fn(size, 1, |i, _| derivatives.col_as_slice(i).iter().zip(&values).map(|(a, b)| a * b).sum())
            };
            let mut descent: Mat<f64> = along(&self.missed(&point.at));
            (0..size).for_each(|i| descent[(i, 0)] -= precision[i] * point.z[i]);
            let damped = |damping: f64| {
                let entry = |i: usize, j: usize| {
                    curvature[(i, j)] + if i == j { damping * (curvature[(i, i)] + 1e-6) } else { 0.0 }
                };
                Mat::from_fn(size, size, entry).llt(Side::Lower).ok()
            };
            let whole = damped(LEAST_DAMPING)?.solve(&descent);
            let foretold: f64 = (0..size).map(|i| whole[(i, 0)] * descent[(i, 0)]).sum();
            let mut lower = None;
            let steepest = if point.is_exact { 1e6 } else { 1.0 };
            while damping < steepest && foretold > worth_a_step {
                let solved = damped(damping)?;
                let mut step = solved.solve(&descent);
                let size_of = |step: &Mat<f64>| (0..size).map(|i| step[(i, 0)].abs()).fold(0.0, f64::max);
                if size_of(&step) > CURVED
                    && let Some(bend) = self.bend(&point, &step)
                {
                    let bend = solved.solve(along(&bend));
                    if 2.0 * size_of(&bend) < 0.75 * size_of(&step) {
                        step += bend;
                    }
                }
                let mut z: Vec<f64> = (0..size).map(|i| point.z[i] + step[(i, 0)].clamp(-LONGEST, LONGEST)).collect();
                self.hypothesis.clamp(&mut z);
                lower = self.point(z, by).filter(|next| next.misfit < point.misfit);
                if lower.is_some() {
                    break;
                }
                damping = (8.0 * damping).max(1e-4);
            }
            let gain = lower.as_ref().map_or(0.0, |next| point.misfit - next.misfit);
            if let Some(next) = lower {
                let derivatives = self.moved_derivatives(&point, &next);
                point = Point { derivatives, ..next };
                damping = (damping / 8.0).max(LEAST_DAMPING);
            }
            round += 1;
            if gain >= least_gain {
                point.is_exact = exact_from == 0;
                let exact_from = exact_from.min(size);
                let own = self.derivatives(&point, exact_from..size)?;
                (exact_from..size).for_each(|i| {
                    point.derivatives.col_as_slice_mut(i).copy_from_slice(own.col_as_slice(i - exact_from));
                });
            } else if point.is_exact || !exactly {
                round = most;
            } else {
                self.find_derivatives(&mut point)?;
                damping = 1e-3;
            }
        }
    }

    /// Half of the way from a point to another.
    fn halfway(&self, from: &Point, to: &Point) -> Option<Point> {
        let z = from.z.iter().zip(&to.z).map(|(from, to)| from + 0.5 * (to - from)).collect();
        let between = self.unjudged(z)?;
        let derivatives = self.moved_derivatives(from, &between);
        Some(Point { derivatives, ..between })
    }

    /// All derivatives at a point.
    fn find_derivatives(&self, point: &mut Point) -> Option<()> {
        point.derivatives = self.derivatives(point, 0..point.z.len())?;
        point.is_exact = true;
        Some(())
    }

    /// $-\tfrac12\,\partial^2f/\partial\delta^2$ along a step $\delta$, what is predicted less by the way's bend.
    fn bend(&self, point: &Point, step: &Mat<f64>) -> Option<Vec<f64>> {
        const PART: f64 = 0.1;
        let mut z: Vec<f64> = point.z.iter().enumerate().map(|(i, z)| z + PART * step[(i, 0)]).collect();
        let unbounded = z.clone();
        self.hypothesis.clamp(&mut z);
        if z != unbounded {
            return None;
        }
        let moved = self.at(&z).ok()?;
        let straight = &point.derivatives * step;
        let bend = |(row, (moved, at)): (usize, (&f64, &f64))| -((moved - at) / PART - straight[(row, 0)]) / PART;
        Some(moved.values.iter().zip(&point.at.values).enumerate().map(bend).collect())
    }

    /// The most probable sizes of model error at a point, by Fisher's scores; with their curvature and
    /// $\tfrac12(\ln\det C + r^TC^{-1}r) + \tfrac12\sum((\ln\tau_k-\mu_k)/s_k)^2$.
    pub(crate) fn sizes(
        &self,
        at: &Predictions,
        errors: &ErrorColumns,
        mut log_sizes: [f64; KINDS],
        most: usize,
    ) -> Option<([f64; KINDS], Mat<f64>, f64)> {
        let missed = self.missed(at);
        let (medians, deviations) = (medians(), deviations());
        let least = least_sizes(self.stacked.first().predictor.structure);
        log_sizes.iter_mut().zip(&least).for_each(|(size, least)| *size = size.max(*least));
        let cost = |log_sizes: &[f64; KINDS]| {
            let by = self.whitening(errors, log_sizes)?;
            let prior: f64 = (0..KINDS).map(|k| ((log_sizes[k] - medians[k]) / deviations[k]).powi(2)).sum();
            let value = 0.5 * (by.log_determinant + square(&by.whitened(&missed)) + prior);
            value.is_finite().then_some((value, by))
        };
        let (mut value, mut by) = cost(&log_sizes)?;
        let mut curvature;
        let mut round = 0;
        loop {
            let mut slope;
            (slope, curvature) = errors.scores((&by, self.stacked.split()), &log_sizes, &by.whitened(&missed));
            for k in 0..KINDS {
                let precision = deviations[k].powi(-2);
                slope[(k, 0)] += (log_sizes[k] - medians[k]) * precision;
                curvature[(k, k)] += precision;
            }
            round += 1;
            if round > most {
                break;
            }
            // A size that would fall below its least stays there, and the others move as if it were held.
            let mut held = curvature.clone();
            let falls = |k: &usize| log_sizes[*k] <= least[*k] && slope[(*k, 0)] > 0.0;
            for k in (0..KINDS).filter(falls).collect::<Vec<_>>() {
                slope[(k, 0)] = 0.0;
                (0..KINDS).filter(|&other| other != k).for_each(|other| {
                    held[(k, other)] = 0.0;
                    held[(other, k)] = 0.0;
                });
            }
            let step = held.llt(Side::Lower).ok()?.solve(&slope);
            let mut share = 1.0;
            let next = loop {
                let mut next = log_sizes;
                for k in 0..KINDS {
                    let moved = log_sizes[k] - share * step[(k, 0)].clamp(-LONGEST_SIZE, LONGEST_SIZE);
                    next[k] = moved.clamp(least[k], LARGEST_SIZE.ln());
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

    /// A point with the most probable sizes of model error there, found from others.
    fn weighed(&self, point: Point, log_sizes: &[f64; KINDS]) -> Option<Weighed> {
        let errors = self.errors(&point.at);
        let (log_sizes, _, cost) = self.sizes(&point.at, &errors, *log_sizes, 6)?;
        let value = cost - self.hypothesis.log_prior(&point.z);
        Some(Weighed { point, errors, log_sizes, value })
    }

    /// Parameters and sizes of model error in turn, then the marginal likelihood by Laplace's approximation over both.
    pub(crate) fn posterior(&self, from: Point, log_sizes: [f64; KINDS], rounds: usize) -> Option<Posterior> {
        let errors = self.errors(&from.at);
        let mut here = Weighed { point: from, errors, log_sizes, value: f64::INFINITY };
        // Exact derivatives are dear: only once sizes and parameters stand still are they asked whether they do.
        let mut exactly = false;
        for round in 0..rounds {
            let by = self.whitening(&here.errors, &here.log_sizes)?;
            // A few steps before the sizes are what they are to be.
            let most = if round == 0 { 4 } else { 8 };
            let how = Following { exactly, ..Following::to_the_end(most, 0.05) };
            let (next, _) = self.follow(here.point.clone(), &by, how)?;
            let is_exact = next.is_exact;
            let mut there = self.weighed(next, &here.log_sizes)?;
            // The covariance is that about a point, and goes with it, which steps do not foresee: too long a way is taken in part.
            let is_lower = |there: &Weighed| there.value < here.value - LEAST_FALL;
            let mut part = 1.0;
            while !is_lower(&there) && part > 0.25 && there.point.z != here.point.z {
                part *= 0.5;
                let between = self.halfway(&here.point, &there.point)?;
                there = self.weighed(between, &here.log_sizes)?;
            }
            let falls = is_lower(&there);
            if there.value < here.value {
                here = there;
            }
            if !falls && (exactly || is_exact) {
                break;
            }
            exactly = !falls;
        }
        let Weighed { mut point, errors, log_sizes, .. } = here;
        let by = self.whitening(&errors, &log_sizes)?;
        if !point.is_exact {
            point.derivatives = Mat::new();
        }
        let (point, mut curvature) = self.follow(point, &by, Following::to_the_end(0, 0.0))?;
        // No direction is wider than its prior: over an even one, from -1 to 1, a Gaussian of this curvature has the same integral.
        let even = self.hypothesis.precision().into_iter().enumerate().filter(|(_, precision)| *precision == 0.0);
        even.for_each(|(i, _)| curvature[(i, i)] += FRAC_PI_2);
        let at = &point.at;
        let (_, of_sizes, _) = self.sizes(at, &errors, log_sizes, 0)?;
        let missed = by.whitened(&self.missed(at));
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
        Some(Posterior { point, covariance, log_sizes, log_evidence })
    }
}
