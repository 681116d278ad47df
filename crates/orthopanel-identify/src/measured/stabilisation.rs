//! Poles that stay where they are whatever the order of a rational fit: where a search for poles may begin.

use std::f64::consts::TAU;

use faer::linalg::solvers::Llt;
use faer::prelude::Solve;
use faer::{Mat, Side};
use num_complex::Complex64;
use rayon::prelude::*;

use super::lines::RecordLines;
use super::modal_fit::PoleParameters;

/// Orders of the denominator that are tried: the first, the last, and from one to the next.
const ORDERS: [usize; 3] = [4, 40, 2];
/// Part of the orders in which a pole has to be found.
const PRESENT: f64 = 0.35;
/// Poles of two orders are one where their frequencies differ by less than this part, or by this part of the damping.
const SAME: [f64; 2] = [8e-4, 0.3];
/// Damping ratios of resonances.
const ZETAS: [f64; 2] = [5e-5, 0.06];
/// Part of the largest entry of a normal matrix that keeps it definite.
const RIDGE: f64 = 1e-10;
/// Part of the unit circle on which the lines lie: on a whole one the ends would meet.
const CIRCLE: f64 = 0.8;

/// Poles of a common denominator of all records by least squares (Guillaume et al., Proc. IMAC 21, 2003), with
/// $$H_r(s) = \frac{\sum_i b_{ri}z^i}{\sum_i a_iz^i},\qquad z = e^{-(s-j\omega_0)\Delta t}$$
/// about the middle $\omega_0$ of the lines, which lie on four fifths of the unit circle, complex coefficients, and the numerators projected out. With the highest coefficient of the denominator
/// at one, poles that are mere mathematics come out unstable (Cauberghe et al., J. Sound Vib. 284, 2005) and are left out. All normal
/// matrices are Toeplitz: their entries depend on $i - j$ alone.
///
/// Limits: some twenty modes between the ends, which should be no more than an octave apart.
pub(super) fn stable_poles(records: &[RecordLines]) -> PoleParameters {
    let lines = || records.iter().flat_map(|record| &record.s);
    let [first, last] =
        [lines().map(|s| s.im).fold(f64::INFINITY, f64::min), lines().map(|s| s.im).fold(0.0, f64::max)];
    let Some(decay) = lines().next().map(|s| s.re) else { return vec![] };
    let (middle, step) = (0.5 * (first + last), CIRCLE * TAU / (last - first).max(f64::MIN_POSITIVE));
    let [from, to, by] = ORDERS;
    let of_record = |record| denominator(record, (middle, step), to + 1);
    let Some(normal) = records.par_iter().filter_map(of_record).reduce_with(|a, b| a + b) else { return vec![] };
    let orders: Vec<usize> = (from..=to).step_by(by).collect();
    let of_order = |order: &usize| {
        let pole = |z: Complex64| {
            let lambda = decay - z.ln() / step + Complex64::new(0.0, middle);
            (lambda.im, [lambda.norm(), -lambda.re / lambda.norm()])
        };
        let is_resonance = |(damped, [_, zeta]): &(f64, [f64; 2])| {
            (first..last).contains(damped) && (ZETAS[0]..ZETAS[1]).contains(zeta)
        };
        roots(&normal, *order).into_iter().map(pole).filter(is_resonance).map(|(_, pole)| pole).collect::<Vec<_>>()
    };
    let mut poles: Vec<[f64; 2]> = orders.par_iter().flat_map_iter(of_order).collect();
    poles.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let clusters = poles.chunk_by(|a, b| b[0] - a[0] < (SAME[0] * b[0]).max(SAME[1] * b[1] * b[0]));
    let stable = clusters.filter(|cluster| cluster.len() as f64 >= PRESENT * orders.len() as f64);
    let median = |cluster: &[[f64; 2]], part: usize| {
        let mut values: Vec<f64> = cluster.iter().map(|pole| pole[part]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2].ln()
    };
    stable.map(|cluster| [median(cluster, 0), median(cluster, 1)]).collect()
}

/// What a record adds to the normal matrix of the denominator's `size` coefficients: $T - S^HR^{-1}S$ with $R = X^HX$, $S = -X^HX_H$,
/// $T = X_H^HX_H$ of the weighed columns $X$ of the numerator, and $X_H$ of the denominator.
fn denominator(record: &RecordLines, (middle, step): (f64, f64), size: usize) -> Option<Mat<Complex64>> {
    // Sums of $g^2$, $g^2H$ and $g^2|H|^2$ times $e^{j\theta n}$, $n$ from $1 - \mathtt{size}$ on.
    let mut sums = vec![[Complex64::ZERO; 3]; 2 * size - 1];
    for ((s, value), weight) in record.s.iter().zip(&record.value).zip(&record.weight) {
        let turn = Complex64::cis((s.im - middle) * step);
        let mut power = weight * weight * turn.powi(1 - size as i32);
        for [plain, cross, square] in &mut sums {
            *plain += power;
            *cross -= power * value;
            *square += power * value.norm_sqr();
            power *= turn;
        }
    }
    let toeplitz = |of: usize| Mat::from_fn(size, size, |i, j| sums[size - 1 + i - j][of]);
    let [mut numerator, cross, square] = [0, 1, 2].map(toeplitz);
    let most = numerator[(0, 0)].re;
    (0..size).for_each(|i| numerator[(i, i)] += RIDGE * most);
    let factor: Llt<Complex64> = numerator.llt(Side::Lower).ok()?;
    Some(square - cross.adjoint() * factor.solve(&cross))
}

/// The roots of a denominator of this order.
fn roots(normal: &Mat<Complex64>, order: usize) -> Vec<Complex64> {
    let most = (0..order).map(|i| normal[(i, i)].re).fold(0.0, f64::max);
    let own = Mat::from_fn(order, order, |i, j| normal[(i, j)] + if i == j { RIDGE * most } else { 0.0 });
    // Rounding leaves it short of definite.
    let coefficients = own.partial_piv_lu().solve(Mat::from_fn(order, 1, |i, _| -normal[(i, order)]));
    let companion = Mat::from_fn(order, order, |i, j| match j {
        _ if j + 1 == order => -coefficients[(i, 0)],
        _ if i == j + 1 => Complex64::ONE,
        _ => Complex64::ZERO,
    });
    companion.eigenvalues().unwrap_or_default().into_iter().filter(|root| root.norm() > 1e-9).collect()
}
