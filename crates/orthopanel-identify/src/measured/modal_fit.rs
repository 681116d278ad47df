//! The joint modal fit of all records: poles in common, everything linear projected out.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::solvers::{Llt, Solve as _};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, Mat, Par, Side};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use num_complex::Complex64;
use rayon::prelude::*;

use super::line_groups::{LineGroups, REACH};
use super::lines::{PoleColumns, RecordLines, Truncations};
use crate::interruption::heed;

/// Powers of $s$ that stand for what lies below and above the band: rigid modes and modes below are even powers from $s^0$ down, modes above
/// even powers up; odd ones are their damping.
const POWERS: RangeInclusive<i32> = -4..=4;
/// and over a band of so many times its lowest frequency, where more can be told apart: what lies at four fifths of the lowest line, a high pass
/// as a mode, leaves a quarter of itself there beyond the lowest power.
const POWERS_OF_WIDE: RangeInclusive<i32> = -6..=4;
const WIDE: f64 = 30.0;

/// Evaluations at most, times the parameters.
const PATIENCE: usize = 2;

/// $\ln\omega$ and $\ln\zeta$ of each pole.
pub(super) type PoleParameters = Vec<[f64; 2]>;

/// $\lambda$ and its derivatives by $\ln\omega$ and $\ln\zeta$.
pub(super) fn lambda([log_omega, log_zeta]: [f64; 2]) -> [Complex64; 3] {
    let (omega, zeta) = (log_omega.exp(), log_zeta.exp().min(MOST_DAMPING));
    let root = (1.0 - zeta * zeta).sqrt();
    let value = omega * Complex64::new(-zeta, root);
    [value, value, -omega * zeta * Complex64::new(1.0, zeta / root)]
}

/// Beyond this a pole is no resonance, and its square root soon none either.
pub(super) const MOST_DAMPING: f64 = 0.9;

/// The records of one test and how they are fitted.
#[derive(Debug)]
pub(super) struct ModalFit<'a> {
    pub records: &'a [RecordLines],
    groups: Vec<LineGroups>,
    /// Of each record the columns of the remainder, and the data.
    known: Vec<Mat<f64>>,
    /// Lowest and highest line \[1/s\], by which the powers are scaled.
    ends: [f64; 2],
    powers: Vec<i32>,
}

/// What the poles make of all records.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    /// Sum of squares of the weighted misfit.
    pub misfit: f64,
    /// Half the sum's descent by the poles' parameters, and Kaufman's approximation of half its curvature.
    pub descent: DVector<f64>,
    pub curvature: DMatrix<f64>,
    /// One a record.
    pub records: Vec<FittedRecord>,
}

/// The linear part of one record.
#[derive(Debug, Clone)]
pub(super) struct FittedRecord {
    /// Real and imaginary part of each residue, then a coefficient a power.
    pub coefficients: Vec<f64>,
    /// $R$ with $R^TR$ the covariance of these where the poles are known: where poles lie close, the product itself would be lost in rounding.
    pub root: Mat<f64>,
    /// How they follow the poles' parameters: a row a coefficient.
    pub by_poles: Mat<f64>,
    /// What this record alone adds to [`Fitted::descent`] and [`Fitted::curvature`].
    pub descent: DVector<f64>,
    pub curvature: DMatrix<f64>,
}

impl FittedRecord {
    pub(super) fn residue(&self, pole: usize) -> Complex64 {
        Complex64::new(self.coefficients[2 * pole], self.coefficients[2 * pole + 1])
    }

    /// By how much the misfit rises without a pole, where the others stay: $q^T\Sigma^{-1}q$ with its residue and the residue's own block $\Sigma$ of
    /// the covariance.
    pub(super) fn loss_without(&self, pole: usize) -> f64 {
        let of = |i: usize, j: usize| self.root.col(2 * pole + i).transpose() * self.root.col(2 * pole + j);
        let Complex64 { re, im } = self.residue(pole);
        let determinant = of(0, 0) * of(1, 1) - of(0, 1) * of(1, 0);
        (of(1, 1) * re * re - 2.0 * of(0, 1) * re * im + of(0, 0) * im * im) / determinant
    }
}

impl<'a> ModalFit<'a> {
    /// `poles` are those near which every line counts by itself.
    pub(super) fn new(records: &'a [RecordLines], poles: &[[f64; 2]]) -> Self {
        let lines = || records.iter().flat_map(|record| &record.s).map(|s| s.im);
        let ends = [lines().fold(f64::INFINITY, f64::min), lines().fold(0.0, f64::max)];
        let groups = records.iter().map(|record| record.groups(poles)).collect();
        let powers = if ends[1] > WIDE * ends[0] { POWERS_OF_WIDE } else { POWERS };
        let mut fit = Self { records, groups, known: vec![], ends, powers: powers.collect() };
        let terms = fit.powers.len();
        let known = records.par_iter().zip(&fit.groups).map(|(record, groups)| {
            let mut columns = Mat::zeros(groups.rows(), terms + 1);
            for term in 0..terms {
                let values: Vec<Complex64> =
                    groups.nodes().iter().map(|line| fit.remainder_term(term, record.s[*line])).collect();
                groups.project_smooth(&record.weight, columns.col_mut(term).as_mat_mut(), &values);
            }
            let data = columns.col_mut(terms).as_mat_mut();
            groups.project(&record.weight, data, |line| record.value[line]);
            columns
        });
        fit.known = known.collect();
        fit
    }

    /// Real data that the fit weighs.
    pub(super) fn data(&self) -> f64 {
        self.groups.iter().zip(self.records).map(|(groups, record)| groups.data(record.per_datum)).sum()
    }

    /// The data beyond what `poles` poles and everything linear may take up.
    pub(super) fn freedom(&self, poles: usize) -> f64 {
        let linear = self.records.len() * (2 * poles + self.powers.len());
        (self.data() - (linear + 2 * poles) as f64).max(1.0)
    }

    /// A power of $s$ of the remainder, made real and of size one at the end of the band where it is greatest.
    pub(super) fn remainder_term(&self, term: usize, s: Complex64) -> Complex64 {
        let power = self.powers[term];
        let end = self.ends[usize::from(power >= 0)];
        (s / Complex64::new(0.0, end)).powi(power) * if power % 2 == 0 { Complex64::ONE } else { Complex64::I }
    }

    /// Solves for everything linear at these poles; `None` where the columns depend on each other.
    pub(super) fn at(&self, poles: &[[f64; 2]]) -> Option<Fitted> {
        let lambdas: Vec<[Complex64; 3]> = poles.iter().map(|pole| lambda(*pole)).collect();
        let solved: Vec<(f64, FittedRecord)> = self
            .records
            .par_iter()
            .zip(&self.groups)
            .zip(&self.known)
            .map(|of| self.record(of, &lambdas))
            .collect::<Option<_>>()?;
        let size = 2 * poles.len();
        let mut fitted = Fitted {
            misfit: 0.0,
            descent: DVector::zeros(size),
            curvature: DMatrix::zeros(size, size),
            records: Vec::with_capacity(solved.len()),
        };
        for (misfit, record) in solved {
            fitted.misfit += misfit;
            fitted.descent += &record.descent;
            fitted.curvature += &record.curvature;
            fitted.records.push(record);
        }
        fitted.misfit.is_finite().then_some(fitted)
    }

    /// With the columns $A$ of everything linear, those $D$ of the derivative by each pole and the data $x$, all that is needed stands in
    /// $[A\;D\;x]^T[A\;D\;x]$: $c = (A^TA)^{-1}A^Tx$, the Jacobian $J = DT(c)$, its part across $A$ (Kaufman), and the misfit.
    fn record(
        &self,
        ((record, groups), known): ((&RecordLines, &LineGroups), &Mat<f64>),
        lambdas: &[[Complex64; 3]],
    ) -> Option<(f64, FittedRecord)> {
        let modes = lambdas.len();
        let terms = self.powers.len();
        let linear = 2 * modes + terms;
        let width = linear + 2 * modes + 1;
        let mut columns = Mat::zeros(groups.rows(), width);
        for (m, [lambda, ..]) in lambdas.iter().enumerate() {
            let PoleColumns { by_residue, by_pole } = record.pole(*lambda, groups.nodes());
            for part in 0..2 {
                let mut put = |column: usize, values: &[Complex64]| {
                    groups.project_smooth(&record.weight, columns.col_mut(column).as_mat_mut(), values);
                };
                put(2 * m + part, &by_residue[part]);
                put(linear + 2 * m + part, &by_pole[part]);
            }
        }
        columns.subcols_mut(2 * modes, terms).copy_from(known.subcols(0, terms));
        columns.col_mut(width - 1).copy_from(known.col(terms));
        let mut products = Mat::<f64>::zeros(width, width);
        matmul(
            products.as_mut(),
            BlockStructure::TriangularLower,
            Accum::Replace,
            columns.transpose(),
            BlockStructure::Rectangular,
            columns.as_ref(),
            BlockStructure::Rectangular,
            1.0,
            Par::Seq,
        );
        let product = |i: usize, j: usize| if i >= j { products[(i, j)] } else { products[(j, i)] };
        let scale: Vec<f64> = (0..linear).map(|i| product(i, i).sqrt()).collect();
        if scale.iter().any(|scale| !(*scale > 0.0 && scale.is_finite())) {
            return None;
        }
        let normal = Mat::from_fn(linear, linear, |i, j| product(i, j) / (scale[i] * scale[j]));
        let factor: Llt<f64> = normal.llt(Side::Lower).ok()?;
        let derivatives = 2 * modes;
        // $A^T[D\;x]$, scaled, and $(A^TA)^{-1}$ times it.
        let against = Mat::from_fn(linear, derivatives + 1, |i, j| product(i, linear + j) / scale[i]);
        let solved = factor.solve(&against);
        let scaled = solved.col(derivatives);
        let misfit =
            product(width - 1, width - 1) - (0..linear).map(|i| against[(i, derivatives)] * scaled[i]).sum::<f64>();
        let coefficients: Vec<f64> = (0..linear).map(|i| scaled[i] / scale[i]).collect();
        // $D^TD$ and $D^Tx$ across $A$.
        let across = |i: usize, j: usize| {
            product(linear + i, linear + j) - (0..linear).map(|k| against[(k, i)] * solved[(k, j)]).sum::<f64>()
        };
        let turns: Vec<[Complex64; 2]> = (0..modes)
            .map(|m| {
                let residue = Complex64::new(coefficients[2 * m], coefficients[2 * m + 1]);
                [residue * lambdas[m][1], residue * lambdas[m][2]]
            })
            .collect();
        // The Jacobian's column of a parameter is these two parts of the two derivative columns of its pole.
        let part = |parameter: usize, of: usize| {
            let turn = turns[parameter / 2][parameter % 2];
            if of == 0 { turn.re } else { turn.im }
        };
        let squares = DMatrix::from_fn(derivatives, derivatives, across);
        let turned = DMatrix::from_fn(derivatives, derivatives, |row, parameter| {
            if row / 2 == parameter / 2 { part(parameter, row % 2) } else { 0.0 }
        });
        let gradient = DVector::from_fn(derivatives, |i, _| across(i, derivatives));
        let by_poles = Mat::from_fn(linear, derivatives, |i, parameter| {
            let column = 2 * (parameter / 2);
            let sum: f64 = (0..2).map(|of| part(parameter, of) * solved[(i, column + of)]).sum();
            -sum / scale[i]
        });
        let mut root = Mat::from_fn(linear, linear, |i, j| if i == j { scale[i].recip() } else { 0.0 });
        solve_lower_triangular_in_place(factor.L(), root.as_mut(), Par::Seq);
        let record = FittedRecord {
            coefficients,
            root,
            by_poles,
            descent: turned.transpose() * gradient,
            curvature: turned.transpose() * squares * &turned,
        };
        Some((misfit, record))
    }

    /// The poles that meet the records best, from a start, until the misfit falls by less than this part.
    pub(super) fn minimise(&self, start: PoleParameters, tolerance: f64) -> Option<(PoleParameters, Fitted)> {
        heed();
        let fitted = self.at(&start)?;
        let size = 2 * start.len();
        if size == 0 {
            return Some((start, fitted));
        }
        let problem = Projected { fit: self, poles: start.clone(), fitted: Some(fitted.clone()) };
        let solver =
            LevenbergMarquardt::new().with_patience(PATIENCE).with_ftol(tolerance).with_xtol(1e-10).with_stepbound(0.1);
        let (Projected { poles, fitted: found, .. }, _) = solver.minimize(problem);
        // A step may end where columns depend on each other.
        Some(found.map_or((start, fitted), |found| (poles, found)))
    }

    /// The misfit of every line of a record in units of its standard deviation, real and imaginary part together.
    pub(super) fn residuals(&self, poles: &[[f64; 2]], fitted: &Fitted) -> Vec<Vec<Complex64>> {
        let of_record = |(record, found): (&RecordLines, &FittedRecord)| {
            let mut left = record.value.clone();
            for (m, pole) in poles.iter().enumerate() {
                record.add_pole(&mut left, lambda(*pole)[0], -found.residue(m));
            }
            for (term, coefficient) in found.coefficients.iter().skip(2 * poles.len()).enumerate() {
                let of_line = left.iter_mut().zip(&record.s);
                of_line.for_each(|(left, s)| *left -= coefficient * self.remainder_term(term, *s));
            }
            left.iter().zip(&record.weight).map(|(left, weight)| left * weight).collect()
        };
        self.records.par_iter().zip(&fitted.records).map(of_record).collect()
    }
}

impl RecordLines {
    /// Groups of lines, each shorter than its distance from the nearest pole.
    fn groups(&self, poles: &[[f64; 2]]) -> LineGroups {
        let step = match self.s[..] {
            [first, .., last] => (last.im - first.im) / (self.s.len() - 1) as f64,
            _ => 1.0,
        };
        // A blow at $t_0$ turns what the record's end cuts off by $t_0$ times the step from line to line: a parabola follows two radians.
        let late = |all: &Truncations| {
            let duration = TAU / step;
            all.hits.iter().map(|hit| duration - hit.left).fold(0.0, f64::max)
        };
        let turn = 2.0 / (REACH * self.truncations.as_ref().map_or(0.0, late) * step);
        let lambdas: Vec<Complex64> = poles.iter().map(|pole| lambda(*pole)[0]).collect();
        LineGroups::new(&self.weight, |line| {
            let near = lambdas.iter().map(|lambda| (self.s[line] - lambda).norm() / step);
            // Below the band lie the poles of the suspension: the lowest powers are steep there.
            near.fold(turn, f64::min).min(self.s[line].norm() / step)
        })
    }
}

/// The projected problem as `levenberg-marquardt` wants it.
///
/// The solver sees residuals and Jacobian only through their products, so a triangular factor of the curvature stands for the Jacobian
/// and a vector of the same length for tens of thousands of residuals.
struct Projected<'a> {
    fit: &'a ModalFit<'a>,
    poles: PoleParameters,
    fitted: Option<Fitted>,
}

impl Projected<'_> {
    /// $R$ with $R^TR$ the curvature, scaled so that the factor exists.
    fn factor(&self) -> Option<DMatrix<f64>> {
        let curvature = &self.fitted.as_ref()?.curvature;
        let trace = curvature.trace().max(f64::MIN_POSITIVE);
        let regular = curvature + DMatrix::identity(curvature.nrows(), curvature.ncols()) * (1e-14 * trace);
        regular.cholesky().map(|factor| factor.l().transpose())
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Projected<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, parameters: &DVector<f64>) {
        self.poles = parameters.as_slice().chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        self.fitted = self.fit.at(&self.poles);
    }

    fn params(&self) -> DVector<f64> {
        DVector::from_iterator(2 * self.poles.len(), self.poles.iter().flatten().copied())
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let fitted = self.fitted.as_ref()?;
        // $J^Tr$ is the negative descent.
        let along = -self.factor()?.transpose().solve_lower_triangular(&fitted.descent)?;
        let across = (fitted.misfit - along.norm_squared()).max(0.0).sqrt();
        Some(along.push(across))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let factor = self.factor()?;
        let rows = factor.nrows() + 1;
        Some(factor.resize(rows, rows - 1, 0.0))
    }
}
