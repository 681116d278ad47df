//! Modes of a plate, mixed by what the model misses of their frequencies.

use super::column::Column;
use super::kind::Kind;
use crate::comparison::Comparison;
use crate::predicted::Prediction;

/// Modes further apart than this part of a frequency mix by no more than residues miss by themselves,
const FAR: f64 = 0.3;
/// and those nearer than this so much that their residues in all records go together.
const NEAR: f64 = 0.03;
/// Modes nearer to each other than this part mix wholly.
const LEAST_APART: f64 = 1e-3;

/// What a model misses of the stiffness or of the mass, $\delta K_{nm} = \omega_n\omega_me_{nm}$ in the modes, moves frequencies by
/// $\delta\ln\omega_n = \tfrac12e_{nn}$, and mixes the modes:
/// $$\delta\phi_n = \theta_{nm}\phi_m\ ,\qquad\delta\phi_m = -\theta_{nm}\phi_n\ ,\qquad
/// \theta_{nm} = \frac{\omega_n\omega_m}{\omega_n^2-\omega_m^2}e_{nm} .$$
/// Of what has no direction of its own, a symmetric random matrix (Mehta, Random Matrices, 3rd ed. 2004, chapter 2), $e_{nm}$ has half the variance of
/// $e_{nn}$, so that its deviation is $\sqrt2$ times that of $\ln\omega_n$: one size for both. On a plate, whose modes lie close, shapes miss by it
/// far more than frequencies do. Of modes that are not near, which are many, each residue has the sum as an error of its own.
pub(super) fn columns(comparison: &Comparison, at: &Prediction) -> Vec<Column> {
    let measured = comparison.measured;
    let is_mode = |n: &usize| !at.hangs[*n] && at.partners.iter().any(|record| record[*n].is_some());
    let flexible: Vec<usize> = (0..measured.poles.len()).filter(is_mode).collect();
    let omega = |n: usize| measured.poles[n].angular_frequency;
    let mut columns = Vec::new();
    let mut squares = vec![vec![0.0; measured.poles.len()]; measured.records.len()];
    for (number, &n) in flexible.iter().enumerate() {
        for &m in &flexible[..number] {
            let Some((share, are_near)) = share(omega(n), omega(m)) else { continue };
            let mut column = Vec::new();
            for (record, partners) in at.partners.iter().enumerate() {
                let (Some(a), Some(b)) = (partners[n], partners[m]) else { continue };
                let product = a.deflection[0] * b.deflection[1] + a.deflection[1] * b.deflection[0];
                let product = std::f64::consts::SQRT_2 * share * product;
                for (pole, residue) in [(n, product * a.unit), (m, -product * b.unit)] {
                    let value = residue / comparison.residue[pole];
                    if are_near {
                        let place = comparison.residue_place(record, pole);
                        column.extend([(place, value.re), (place + 1, value.im)]);
                    } else {
                        squares[record][pole] += value.norm_sqr();
                    }
                }
            }
            if are_near {
                columns.push(((Kind::Frequency as usize, 1), column));
            }
        }
    }
    for (record, squares) in squares.iter().enumerate() {
        for (pole, square) in squares.iter().enumerate().filter(|(_, square)| **square > 0.0) {
            let (value, place) = (square.sqrt() * at.phase[pole], comparison.residue_place(record, pole));
            columns.push(((Kind::Frequency as usize, 1), vec![(place, value.re), (place + 1, value.im)]));
        }
    }
    columns
}

/// $\theta_{nm}/e_{nm}$, and whether they are near; `None` of modes that lie far apart.
fn share(omega: f64, other: f64) -> Option<(f64, bool)> {
    let apart = omega / other - other / omega;
    let share = apart.abs().max(2.0 * LEAST_APART).copysign(apart).recip();
    (apart.abs() < 2.0 * FAR).then_some((share, apart.abs() < 2.0 * NEAR))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two modes that stiffness couples turn by the angle of Jacobi's rotation, which makes their stiffness diagonal.
    #[test]
    fn val_modes_turn_as_the_pair_does() {
        let (omega, other) = (755.0_f64, 761.0_f64);
        for e in [1e-5, 1e-4] {
            let exact = 0.5 * (2.0 * omega * other * e / (omega.powi(2) - other.powi(2))).atan();
            let share = e * share(omega, other).unwrap().0;
            assert!((share / exact - 1.0).abs() < 2.0 * exact.powi(2), "{share} {exact}");
        }
        assert_eq!(share(100.0, 140.0), None);
        let (close, _) = share(500.0, 500.0).unwrap();
        assert!((close - 0.5 / LEAST_APART).abs() < 1e-9, "{close}");
    }
}
