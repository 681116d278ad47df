//! Modes of a modified structure, which the damping of the panel couples, and dashpots of what stands on it.
//!
//! The damping of a panel is spread over it as its stiffness is: its own modes have a damping ratio each and do not couple. Those of the panel with a
//! mass do. With $V$ the shares of the panel's modes in the modified ones, and $c_m = 2\zeta_m\omega_m$,
//! $$\big(s^2 + sC + \Omega^2\big)q = 0\ ,\qquad C = V^T\mathrm{diag}(c)\,V + C_d\ ,$$
//! with $C_d$ of the dashpots.
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
/// Rounds in which a pole's mode is found.
const STEPS: usize = 8;
/// Share of another mode to first order from which on it brings others with it: what a mode at this limit brings is next to nothing, or derivatives by
/// differences would see it come and go.
const LARGE: f64 = 1e-4;
/// Largest share of another mode: those that run together altogether are not told apart.
const MOST: f64 = 1.0;

/// Modes with what each has of the others.
pub(crate) struct CoupledModes {
    /// $|\lambda|$ \[rad/s\].
    pub angular_frequency: Vec<f64>,
    /// Of each mode the deflection at every port, the slope along and the slope across, so that the residue of a receptance is
    /// $\phi\phi^T/(\lambda-\bar\lambda)$.
    shapes: [Vec<Vec<Complex64>>; 3],
    /// Shares $V$ of the panel's own modes, a row each, in the modes without coupling.
    of_panel: Mat<f64>,
    /// Deviation of each $c_m$ from what is found.
    deviations: Vec<f64>,
    /// $C_{nn}$.
    own: Vec<f64>,
}

impl CoupledModes {
    /// Of modes with these damping ratios, of which the effects' dashpots bring their own, and the deviations of their logarithms where they are measured;
    /// `None` where shares of the panel's own modes are not known.
    pub(crate) fn new(modes: &SeenModes, zeta: &[f64], deviations: &[Option<f64>]) -> Option<Self> {
        let panel_modes = modes.own.shares.first()?.len();
        let count = modes.own.shares.len().min(zeta.len());
        let omega = &modes.angular_frequency[..count];
        let of_panel = Mat::from_fn(panel_modes, count, |m, n| modes.own.shares[n][m]);
        let is_measured: Vec<bool> = deviations.iter().map(Option::is_some).collect();
        let mut by_others = vec![0.0; count];
        let mut found = None;
        for _ in 0..ROUNDS {
            let (panel, deviations) =
                damping_of_panel((&modes.own, &of_panel), omega, (zeta, deviations, &modes.damping_ratio), &by_others)?;
            let damped = Mat::from_fn(panel_modes, count, |m, n| panel[m] * of_panel[(m, n)]);
            let mut damping = of_panel.transpose() * damped;
            for (n, couplings) in modes.couplings.iter().enumerate().take(count) {
                couplings.iter().enumerate().take(count).for_each(|(j, by_effects)| damping[(n, j)] += by_effects);
                damping[(n, n)] += 2.0 * modes.damping_ratio[n] * omega[n];
            }
            // What is no pole counts in the remainder alone.
            let rounds = |n: usize| if is_measured[n] { STEPS } else { 1 };
            let modes: Vec<_> = (0..count).map(|n| coupled(n, (omega, zeta[n]), &damping, rounds(n))).collect();
            by_others = modes.iter().map(|(.., by_others)| *by_others).collect();
            found = Some((modes, deviations, (0..count).map(|n| damping[(n, n)]).collect()));
        }
        let (modes_with_damping, deviations, own) = found?;
        let (angular_frequency, shares): (Vec<f64>, Vec<_>) =
            modes_with_damping.into_iter().map(|(size, shares, _)| (size, shares)).unzip();
        let shapes = [&modes.deflection, &modes.slope, &modes.slope_across].map(|of| mixed(&shares, of));
        Some(Self { angular_frequency, shapes, of_panel, deviations, own })
    }

    /// The deflection of a mode at a port; `None` of one that is not coupled.
    pub(crate) fn deflection(&self, n: usize, port: usize) -> Option<Complex64> {
        self.shapes[0].get(n)?.get(port).copied()
    }

    /// Deviations of what damps the panel's own modes, $c_m$.
    pub(crate) fn deviations(&self) -> &[f64] {
        &self.deviations
    }

    /// The share of one of the panel's own modes in a mode without coupling.
    pub(crate) fn share(&self, m: usize, n: usize) -> f64 {
        self.of_panel[(m, n)]
    }

    /// $s^2 + sC_{nn} + \omega_n^2$.
    pub(crate) fn stiffness(&self, modes: &SeenModes, n: usize, s: Complex64) -> Complex64 {
        s * s + s * self.own[n] + modes.angular_frequency[n].powi(2)
    }

    /// What each of the panel's own modes sees at $s$ of a force at every port, $\sum_jV_{mj}\phi_j/(s^2+sC_{jj}+\omega_j^2)$, without the mode `but`: real and
    /// imaginary part, a row a mode.
    pub(crate) fn seen_by_panel(&self, modes: &SeenModes, s: Complex64, but: Option<usize>) -> [Mat<f64>; 2] {
        let ports = modes.deflection.first().map_or(0, Vec::len);
        let answers: Vec<Complex64> = (0..self.own.len())
            .map(|n| if but == Some(n) { Complex64::ZERO } else { self.stiffness(modes, n, s).inv() })
            .collect();
        let along = |part: fn(&Complex64) -> f64| {
            let moved = Mat::from_fn(answers.len(), ports, |n, port| part(&answers[n]) * modes.deflection[n][port]);
            &self.of_panel * moved
        };
        [along(|answer| answer.re), along(|answer| answer.im)]
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
/// and of which those that damping couples them with bring some; and the deviations of these.
fn damping_of_panel(
    (own, shares): (&OwnModes, &Mat<f64>),
    omega: &[f64],
    (zeta, deviations, of_effects): (&[f64], &[Option<f64>], &[f64]),
    by_others: &[f64],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let count = own.angular_frequency.len();
    let shown = |n: usize| (zeta[n] - of_effects[n]).max(0.0);
    let measured: Vec<(usize, f64)> = (0..omega.len()).filter_map(|n| Some((n, deviations[n]?))).collect();
    let mut ratios: Vec<f64> = measured.iter().map(|(n, _)| shown(*n)).collect();
    ratios.sort_by(f64::total_cmp);
    let usual = ratios.get(ratios.len() / 2).copied().unwrap_or(0.0);
    let before: Vec<f64> = own.angular_frequency.iter().map(|omega| 2.0 * usual * omega).collect();
    let variance = |m: usize| (OWN_DAMPING * before[m]).powi(2);
    let rows = Mat::from_fn(measured.len(), count, |row, m| shares[(m, measured[row].0)].powi(2));
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
    let factor = whole.llt(Side::Lower).ok()?;
    let found = &spread * factor.solve(&missed);
    let told = factor.solve(spread.transpose());
    let deviation = |m: usize| {
        let told: f64 = (0..measured.len()).map(|row| spread[(m, row)] * told[(row, m)]).sum();
        (variance(m) - told).max(0.0).sqrt()
    };
    let damping = (0..count).map(|m| (before[m] + found[(m, 0)]).max(0.0)).collect();
    Some((damping, (0..count).map(deviation).collect()))
}

/// $|\lambda|$ and the shares of a mode, and what the others bring of its damping, $\mathrm{Re}\sum_jC_{nj}q_j$, up to [`BY_OTHERS`]: row by row, the row of the mode itself for its
/// pole, whose damping is known, in so many rounds: one is the first order. Modes that have a small share have it of this mode and of those with large ones alone.
fn coupled(n: usize, (omega, zeta): (&[f64], f64), damping: &Mat<f64>, rounds: usize) -> (f64, Vec<Complex64>, f64) {
    let count = omega.len();
    let mut shares = vec![Complex64::ZERO; count];
    shares[n] = Complex64::ONE;
    if omega[n] <= 0.0 {
        return (omega[n], shares, 0.0);
    }
    let own = 2.0 * zeta * omega[n];
    let of_mode = damping.col_as_slice(n);
    let first = |j: usize| (of_mode[j] * omega[n] / (omega[j] * omega[j] - omega[n] * omega[n])).abs();
    let others: Vec<usize> = (0..count).filter(|j| *j != n && omega[*j] > 0.0).collect();
    let large: Vec<usize> = others.iter().copied().filter(|j| rounds > 1 && first(*j) >= LARGE).collect();
    let mut s = Complex64::new(-0.5 * own, (omega[n].powi(2) - 0.25 * own * own).max(0.0).sqrt());
    let mut by_others = Complex64::ZERO;
    for _ in 0..rounds {
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

    /// The receptance of three modes of which two lie 0.8 % apart is the sum over the coupled ones, with a dashpot on them and without.
    #[test]
    fn val_coupled_modes_make_the_receptance() {
        receptance_of_modes([0.0; 3]);
        receptance_of_modes([1.5, 2.0, -2.5]);
    }

    /// With a dashpot that damps modes $i$ and $j$ by the product of two of these.
    fn receptance_of_modes(dashpot: [f64; 3]) {
        let omega = [1000.0, 1008.0, 1500.0];
        let own: [f64; 3] = [16.0, 9.0, 20.0];
        let (sin, cos) = 0.45_f64.sin_cos();
        // The modified modes, each in shares of the panel's own.
        let turned = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let (sin, cos) = 0.2_f64.sin_cos();
        let shares: Vec<Vec<f64>> =
            turned.iter().map(|[a, b, c]| vec![*a, cos * b - sin * c, sin * b + cos * c]).collect();
        let coupling = |i: usize, j: usize| -> f64 {
            (0..3).map(|m| shares[i][m] * shares[j][m] * own[m]).sum::<f64>() + dashpot[i] * dashpot[j]
        };
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
            damping_ratio: (0..3).map(|n| dashpot[n] * dashpot[n] / 2.0 / omega[n]).collect(),
            couplings: (0..3)
                .map(|n| (0..3).map(|j| if n == j { 0.0 } else { dashpot[n] * dashpot[j] }).collect())
                .collect(),
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
        assert!(alone > 0.02 && coupled < 3e-3, "{coupled} {alone}");
    }

    /// What one of the panel's own modes damps more changes modes as [`CoupledModes::seen_by_panel`] has it, to first order.
    #[test]
    fn val_modes_change_with_the_damping_of_the_panel() {
        let omega = [1000.0, 1040.0, 1500.0];
        let (sin, cos) = 0.45_f64.sin_cos();
        let turned = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let (sin, cos) = 0.3_f64.sin_cos();
        let shares = turned.map(|[a, b, c]| vec![a, cos * b - sin * c, sin * b + cos * c]);
        let of_panel = Mat::from_fn(3, 3, |m, n| shares[n][m]);
        let damping = |own: [f64; 3]| {
            Mat::from_fn(3, 3, |i, j| (0..3).map(|m| of_panel[(m, i)] * own[m] * of_panel[(m, j)]).sum())
        };
        let (before, more) = (damping([16.0, 9.0, 20.0]), 0.2);
        let after = damping([16.0, 9.0, 20.0 + more]);
        let modes = SeenModes {
            angular_frequency: omega.to_vec(),
            deflection: (0..3).map(|n| (0..3).map(|port| f64::from(u8::from(port == n))).collect()).collect(),
            ..SeenModes::default()
        };
        for n in 0..3 {
            let zeta = 0.5 * before[(n, n)] / omega[n];
            let [(size, of_before, _), (_, of_after, _)] =
                [&before, &after].map(|damping| coupled(n, (&omega, zeta), damping, STEPS));
            let lambda = size * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt());
            let found = CoupledModes {
                angular_frequency: omega.to_vec(),
                shapes: Default::default(),
                of_panel: of_panel.clone(),
                deviations: vec![0.0, 0.0, more],
                own: (0..3).map(|n| before[(n, n)]).collect(),
            };
            let [re, im] = found.seen_by_panel(&modes, lambda, Some(n));
            let share = -lambda * found.deviations()[2] * found.share(2, n);
            let exact: Vec<Complex64> = of_after.iter().zip(&of_before).map(|(after, before)| after - before).collect();
            let others = exact.iter().enumerate().filter(|(j, _)| *j != n);
            let largest = others.map(|(_, change)| change.norm()).fold(0.0, f64::max);
            // Its own share is one, but for what makes all of one size.
            for (j, exact) in exact.iter().enumerate().filter(|(j, _)| *j != n) {
                let first = share * Complex64::new(re[(2, j)], im[(2, j)]);
                assert!((first - exact).norm() < 0.1 * largest, "mode {n} in {j}: {first} {exact}");
            }
        }
    }
}
