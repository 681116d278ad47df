//! Modes of a modified structure, which the damping of the panel couples.
//!
//! The damping of a panel is spread over it as its stiffness is: its own modes have a damping ratio each and do not couple. Those of the panel with a
//! mass do. With $V$ the shares of the panel's modes in the modified ones, and $c_m = 2\zeta_m\omega_m$,
//! $$\big(s^2 + sC + \Omega^2\big)q = 0\ ,\qquad C = V^T\mathrm{diag}(c)\,V\ .$$
//! Of $C$ the records show the diagonal, the damping of the modified modes that are poles, with what other modes bring:
//! $\sum_mV_{mn}^2c_m = C_{nn} = 2\zeta_n\omega_n - \mathrm{Re}\sum_jC_{nj}q_j$. With $A$ of these rows, $N$ the
//! variances of the measured $C_{nn}$, and $c$ beforehand about $c_0 = 2\bar\zeta\Omega_m$, $\bar\zeta$ the median, with variances $S$,
//! $$c = c_0 + SA^T(ASA^T + N)^{-1}(C_{nn} - Ac_0) .$$
//! Two modes that lie a hundredth apart move by some $10^{-4}$ of their frequency, and each sees a tenth of the other in quadrature.

use faer::prelude::Solve;
use faer::{Mat, Side};
use num_complex::Complex64;
use orthopanel_model::{OwnModes, SeenModes};

use crate::comparison::OWN_DAMPING;

/// Rounds in which the panel's damping is found: what a mode shows of it is what all that it is coupled with does,
const ROUNDS: usize = 2;
/// of which others bring no more than this part, for modes that run together wholly do not tell whose damping it is.
const BY_OTHERS: f64 = 0.5;
/// Rounds in which a mode is found.
const STEPS: usize = 8;
/// Share of another mode that counts, to first order.
const LEAST: f64 = 1e-5;
/// Share of another mode to first order from which on it brings others with it.
const LARGE: f64 = 1e-3;
/// Largest share of another mode: those that run together altogether are not told apart.
const MOST: f64 = 1.0;

/// Modes with what each has of the others.
pub(crate) struct CoupledModes {
    /// $|\lambda|$ \[rad/s\].
    pub angular_frequency: Vec<f64>,
    /// Of each mode the deflection at every port, the slope along and the slope across, so that the residue of a receptance is
    /// $\phi\phi^T/(\lambda-\bar\lambda)$.
    shapes: [Vec<Vec<Complex64>>; 3],
}

impl CoupledModes {
    /// Of modes with these damping ratios, of which the effects' dashpots bring their own, and the deviations of their logarithms where they are measured;
    /// `None` where shares of the panel's own modes are not known.
    pub(crate) fn new(modes: &SeenModes, zeta: &[f64], deviations: &[Option<f64>]) -> Option<Self> {
        let count = modes.own.shares.first()?.len().min(zeta.len());
        let omega = &modes.angular_frequency[..count];
        let shares = &modes.own.shares[..count];
        let of_panel = Mat::from_fn(count, count, |m, n| shares[n][m]);
        let mut by_others = vec![0.0; count];
        let mut modes_with_damping = vec![];
        for _ in 0..ROUNDS {
            let panel = damping_of_panel(&modes.own, omega, (zeta, deviations, &modes.damping_ratio), &by_others)?;
            let damped = Mat::from_fn(count, count, |m, n| panel[m] * shares[n][m]);
            let damping = of_panel.transpose() * damped;
            modes_with_damping = (0..count).map(|n| coupled(n, (omega, zeta[n]), &damping)).collect();
            by_others = modes_with_damping.iter().map(|(.., by_others)| *by_others).collect();
        }
        let (angular_frequency, shares): (Vec<f64>, Vec<_>) =
            modes_with_damping.into_iter().map(|(size, shares, _)| (size, shares)).unzip();
        let shapes = [&modes.deflection, &modes.slope, &modes.slope_across].map(|of| mixed(&shares, of));
        Some(Self { angular_frequency, shapes })
    }

    /// The deflection of a mode at a port; `None` of one that is not coupled.
    pub(crate) fn deflection(&self, n: usize, port: usize) -> Option<Complex64> {
        self.shapes[0].get(n)?.get(port).copied()
    }

    /// Its slope along, or across, at a port.
    pub(crate) fn slope(&self, axis: usize, n: usize, port: usize) -> Option<Complex64> {
        self.shapes[1 + axis].get(n)?.get(port).copied()
    }
}

/// What each mode has at every port of what the modes without coupling have there.
fn mixed(shares: &[Vec<Complex64>], of: &[Vec<f64>]) -> Vec<Vec<Complex64>> {
    let ports = of.first().map_or(0, Vec::len);
    let mixed = |shares: &Vec<Complex64>| {
        let mut sum = vec![Complex64::ZERO; ports];
        for (share, own) in shares.iter().zip(of).filter(|(share, _)| **share != Complex64::ZERO) {
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += share * own);
        }
        sum
    };
    shares.iter().map(mixed).collect()
}

/// $c$ of the panel's own modes, about which nothing but their shares in the modified ones is known, whose damping ratios are the panel's and the effects',
/// and of which those that damping couples them with bring some.
fn damping_of_panel(
    own: &OwnModes,
    omega: &[f64],
    (zeta, deviations, of_effects): (&[f64], &[Option<f64>], &[f64]),
    by_others: &[f64],
) -> Option<Vec<f64>> {
    let count = omega.len();
    let shown = |n: usize| (zeta[n] - of_effects[n]).max(0.0);
    let measured: Vec<(usize, f64)> = (0..count).filter_map(|n| Some((n, deviations[n]?))).collect();
    let mut ratios: Vec<f64> = measured.iter().map(|(n, _)| shown(*n)).collect();
    ratios.sort_by(f64::total_cmp);
    let usual = ratios.get(ratios.len() / 2).copied().unwrap_or(0.0);
    let before: Vec<f64> = own.angular_frequency[..count].iter().map(|omega| 2.0 * usual * omega).collect();
    let variance = |m: usize| (OWN_DAMPING * before[m]).powi(2);
    let rows = Mat::from_fn(measured.len(), count, |row, m| own.shares[measured[row].0][m].powi(2));
    let spread = Mat::from_fn(count, measured.len(), |m, row| variance(m) * rows[(row, m)]);
    let mut whole = &rows * &spread;
    let missed = Mat::from_fn(measured.len(), 1, |row, _| {
        let n = measured[row].0;
        2.0 * shown(n) * omega[n] - by_others[n] - (0..count).map(|m| rows[(row, m)] * before[m]).sum::<f64>()
    });
    for (row, (n, deviation)) in measured.iter().enumerate() {
        let noise = deviation * 2.0 * zeta[*n] * omega[*n];
        whole[(row, row)] += noise * noise + f64::EPSILON * whole[(row, row)] + f64::MIN_POSITIVE.sqrt();
    }
    let weights = whole.llt(Side::Lower).ok()?.solve(&missed);
    let found = &spread * weights;
    Some((0..count).map(|m| (before[m] + found[(m, 0)]).max(0.0)).collect())
}

/// $|\lambda|$ and the shares of a mode, and what the others bring of its damping, $\mathrm{Re}\sum_jC_{nj}q_j$, up to [`BY_OTHERS`]: row by row, the row of the mode itself for its
/// pole, whose damping is known. Modes that have a small share have it of this mode and of those with large ones alone.
fn coupled(n: usize, (omega, zeta): (&[f64], f64), damping: &Mat<f64>) -> (f64, Vec<Complex64>, f64) {
    let count = omega.len();
    let mut shares = vec![Complex64::ZERO; count];
    shares[n] = Complex64::ONE;
    if omega[n] <= 0.0 {
        return (omega[n], shares, 0.0);
    }
    let own = 2.0 * zeta * omega[n];
    let of_mode = damping.col_as_slice(n);
    let first = |j: usize| (of_mode[j] * omega[n] / (omega[j] * omega[j] - omega[n] * omega[n])).abs();
    let others: Vec<usize> = (0..count).filter(|j| *j != n && omega[*j] > 0.0 && first(*j) >= LEAST).collect();
    let large: Vec<usize> = others.iter().copied().filter(|j| first(*j) >= LARGE).collect();
    let mut s = Complex64::new(-0.5 * own, (omega[n].powi(2) - 0.25 * own * own).max(0.0).sqrt());
    let mut by_others = Complex64::ZERO;
    for _ in 0..STEPS {
        for &j in &others {
            let column = damping.col_as_slice(j);
            let beside = large.iter().filter(|k| **k != j).map(|&k| column[k] * shares[k]).sum::<Complex64>();
            let share = -s * (beside + of_mode[j]) / (s * s + s * column[j] + omega[j] * omega[j]);
            shares[j] = share / (share.norm() / MOST).max(1.0);
        }
        by_others = others.iter().map(|&j| of_mode[j] * shares[j]).sum();
        let half = 0.5 * Complex64::new(own, by_others.im);
        let next = -half + Complex64::I * (omega[n] * omega[n] - half * half).sqrt();
        let is_there = (next - s).norm() < f64::EPSILON * next.norm();
        s = next;
        if is_there {
            break;
        }
    }
    let masses: Complex64 = shares.iter().map(|share| share * share).sum();
    let twice = |j: usize| -> Complex64 {
        let column = damping.col_as_slice(j);
        let beside: Complex64 = large.iter().map(|&k| column[k] * shares[k]).sum();
        let small = if first(j) < LARGE { 2.0 } else { 1.0 };
        shares[j] * (2.0 * of_mode[j] + small * beside)
    };
    let dampers: Complex64 = of_mode[n] + others.iter().map(|&j| twice(j)).sum::<Complex64>();
    let size = s.norm();
    let lambda = size * Complex64::new(-zeta, (1.0 - zeta * zeta).max(0.0).sqrt());
    let scale = ((lambda - lambda.conj()) / (2.0 * s * masses + dampers)).sqrt();
    // Either root: a shape has no sign.
    let scale = if scale.re < 0.0 { -scale } else { scale };
    let most = BY_OTHERS * own;
    let by_others = if most > 0.0 { most * (by_others.re / most).tanh() } else { 0.0 };
    (size, shares.into_iter().map(|share| scale * share).collect(), by_others)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The receptance of three modes of which two lie 0.8 % apart is the sum over the coupled ones.
    #[test]
    fn val_coupled_modes_make_the_receptance() {
        let omega = [1000.0, 1008.0, 1500.0];
        let own: [f64; 3] = [16.0, 9.0, 20.0];
        let (sin, cos) = 0.45_f64.sin_cos();
        // The modified modes, each in shares of the panel's own.
        let turned = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let (sin, cos) = 0.2_f64.sin_cos();
        let shares: Vec<Vec<f64>> =
            turned.iter().map(|[a, b, c]| vec![*a, cos * b - sin * c, sin * b + cos * c]).collect();
        let coupling = |i: usize, j: usize| -> f64 { (0..3).map(|m| shares[i][m] * shares[j][m] * own[m]).sum() };
        // What a record would show: damping as the coupled modes have it.
        let whole = nalgebra::DMatrix::from_fn(6, 6, |i, j| match (i, j) {
            (0..3, _) => f64::from(u8::from(j == i + 3)),
            (_, 0..3) if i == j + 3 => -omega[j] * omega[j],
            (_, 0..3) => 0.0,
            _ => -coupling(i - 3, j - 3),
        });
        let mut poles: Vec<_> = whole.complex_eigenvalues().iter().copied().filter(|pole| pole.im > 0.0).collect();
        poles.sort_by(|a, b| a.im.total_cmp(&b.im));
        let modes = SeenModes {
            angular_frequency: omega.to_vec(),
            damping_ratio: vec![0.0; 3],
            // As many ports as modes, each on one of them alone.
            deflection: (0..3).map(|n| (0..3).map(|port| f64::from(u8::from(port == n))).collect()).collect(),
            own: OwnModes { angular_frequency: omega.to_vec(), shares: shares.clone() },
            ..SeenModes::default()
        };
        let zeta: Vec<f64> = poles.iter().map(|pole| -pole.re / pole.norm()).collect();
        let found = CoupledModes::new(&modes, &zeta, &[Some(1e-4); 3]).expect("shares");
        let by_modes = |s: Complex64, i: usize, j: usize| -> Complex64 {
            let term = |n: usize| {
                let size = found.angular_frequency[n];
                let lambda = size * Complex64::new(-zeta[n], (1.0 - zeta[n] * zeta[n]).sqrt());
                let of = |row: usize| found.deflection(n, row).expect("a mode");
                let residue = of(i) * of(j) / (lambda - lambda.conj());
                residue / (s - lambda) + residue.conj() / (s - lambda.conj())
            };
            (0..3).map(term).sum()
        };
        let exact = |s: Complex64| -> faer::Mat<Complex64> {
            let entry = |i: usize, j: usize| {
                s * coupling(i, j) + if i == j { s * s + omega[i] * omega[i] } else { Complex64::ZERO }
            };
            let matrix = faer::Mat::from_fn(3, 3, entry);
            faer::linalg::solvers::DenseSolveCore::inverse(&matrix.partial_piv_lu())
        };
        let worst = |with: &dyn Fn(Complex64, usize, usize) -> Complex64| {
            let mut worst = 0.0_f64;
            for frequency in [950.0, 1000.0, 1004.0, 1008.0, 1040.0, 1500.0] {
                let s = Complex64::new(0.0, frequency);
                let exact = exact(s);
                for (i, j) in [(0, 0), (0, 1), (1, 1), (0, 2), (2, 2)] {
                    let size = (exact[(i, i)] * exact[(j, j)]).norm().sqrt();
                    worst = worst.max((with(s, i, j) - exact[(i, j)]).norm() / size);
                }
            }
            worst
        };
        let uncoupled = |s: Complex64, i: usize, j: usize| {
            let line = s * s + 2.0 * zeta[i] * omega[i] * s + omega[i] * omega[i];
            if i == j { line.inv() } else { Complex64::ZERO }
        };
        let (coupled, alone) = (worst(&by_modes), worst(&uncoupled));
        for (pole, size) in poles.iter().zip(&found.angular_frequency) {
            assert!((pole.norm() / size - 1.0).abs() < 1e-5, "{pole} {size}");
        }
        assert!(alone > 0.1 && coupled < 3e-3, "{coupled} {alone}");
    }
}
