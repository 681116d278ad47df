//! Damping between the modes of a pair.

use num_complex::Complex64;

use super::column::Column;
use super::kind::{COUPLING, Kind};
use crate::comparison::Comparison;
use crate::predicted::Prediction;

/// Modes that are many, and the distance in widths up to which damping between two of them counts.
const MANY: usize = 16;
const NEAR: f64 = 10.0;
/// Root mean square of the square of a normal number.
const OF_SQUARE: f64 = 1.732_050_807_568_877_2;

/// What damping between two modes of each pair does, to first order. With $c_{nm}$ the damping matrix in the real modes $\phi$,
/// $$\delta\psi_n = -\frac{\lambda_nc_{nm}}{(\lambda_n-\lambda_m)(\lambda_n-\bar\lambda_m)}\phi_m\ ,\qquad
/// \delta H(s) = -\frac{c_{nm}s^3}{D_n(s)D_m(s)}(\phi_n\phi_m^T+\phi_m\phi_n^T)\ ,$$
/// which is small below the band: what the residues there gain, the remainder loses. Of modes that run together the second order counts too, with
/// $\theta$ the share of $\phi_m$ in $\delta\psi_n$:
/// $$\frac{\delta\lambda_n}{\lambda_n} = \frac{\lambda_nc_{nm}^2}{(\lambda_n-\bar\lambda_n)(\lambda_n-\lambda_m)(\lambda_n-\bar\lambda_m)}\ ,\qquad
/// \delta(\psi_n\psi_n^T) = \theta^2(\phi_m\phi_m^T-\phi_n\phi_n^T) .$$
pub(super) fn columns(comparison: &Comparison, at: &Prediction) -> Vec<Column> {
    let measured = comparison.measured;
    let pole = |n: usize| at.partners.iter().find_map(|record| record[n]).map(|partner| partner.pole);
    let flexible: Vec<usize> = (0..measured.poles.len()).filter(|&n| !at.hangs[n] && pole(n).is_some()).collect();
    let mut columns = Vec::new();
    for (number, &n) in flexible.iter().enumerate() {
        for &m in &flexible[..number] {
            let (Some(of_n), Some(of_m)) = (pole(n), pole(m)) else { continue };
            let own = 2.0 * (of_n.re * of_m.re).sqrt();
            // What damping does between modes far from each other is below what residues miss by themselves; of many modes most are.
            let are_near = (of_n - of_m).norm() < NEAR * own;
            if flexible.len() > MANY && !are_near {
                continue;
            }
            let share = |own_pole, other| coupled(own, own_pole, other)[0];
            if are_near {
                let shift = |own_pole, other| coupled(own, own_pole, other)[1];
                let mut column = vec![(n, OF_SQUARE * shift(of_n, of_m).re), (m, OF_SQUARE * shift(of_m, of_n).re)];
                for (record, partners) in at.partners.iter().enumerate() {
                    let (Some(a), Some(b)) = (partners[n], partners[m]) else { continue };
                    let [of_a, of_b] = [a, b].map(|partner| partner.deflection[0] * partner.deflection[1]);
                    let first = share(of_n, of_m).powi(2) * (of_b - of_a) * a.unit;
                    let second = share(of_m, of_n).powi(2) * (of_a - of_b) * b.unit;
                    for (pole, residue) in [(n, first), (m, second)] {
                        let value = OF_SQUARE * residue / comparison.residue[pole];
                        let place = comparison.residue_place(record, pole);
                        column.extend([(place, value.re), (place + 1, value.im)]);
                    }
                }
                columns.push(((Kind::Coupling as usize, 2), column));
            }
            let mut column = Vec::new();
            for (record, partners) in at.partners.iter().enumerate() {
                let (Some(a), Some(b)) = (partners[n], partners[m]) else { continue };
                let product = a.deflection[0] * b.deflection[1] + a.deflection[1] * b.deflection[0];
                let gained = [share(of_n, of_m) * product * a.unit, share(of_m, of_n) * product * b.unit];
                let ends = [(n, of_n, gained[0]), (m, of_m, gained[1])];
                for (pole, _, residue) in ends {
                    let value = residue / comparison.residue[pole];
                    let place = comparison.residue_place(record, pole);
                    column.extend([(place, value.re), (place + 1, value.im)]);
                }
                for (line, frequency) in measured.remainder_frequencies.iter().enumerate() {
                    let s = Complex64::new(0.0, std::f64::consts::TAU * frequency);
                    let apart = |(_, pole, residue): (usize, Complex64, Complex64)| {
                        residue / (s - pole) + residue.conj() / (s - pole.conj())
                    };
                    let value = -ends.into_iter().map(apart).sum::<Complex64>() / comparison.rigid;
                    let place = comparison.remainder_place(record, line);
                    column.extend([(place, value.re), (place + 1, value.im)]);
                }
            }
            columns.push(((Kind::Coupling as usize, 1), column));
        }
    }
    columns
}

/// The share $\theta$ of another mode in that of a pole, by damping $c$ between the two, and the pole's shift $\delta\lambda/\lambda$.
fn coupled(damping: f64, pole: Complex64, other: Complex64) -> [Complex64; 2] {
    // Nearer to each other than the damping between them moves poles, modes mix wholly.
    let least = 0.5 * COUPLING * damping;
    let apart = pole - other;
    let apart = if apart.norm() < least { Complex64::new(0.0, least) } else { apart };
    // Beside the pole itself, $D_m(\lambda_n)$.
    let share = -damping * pole / (apart * (pole - other.conj()));
    [share, -damping * share / (pole - pole.conj())]
}

#[cfg(test)]
mod tests {
    use nalgebra::{Complex, Matrix4};

    use super::*;

    /// Two modes 6 Hz apart with half-widths of 6 and 4 Hz and a small part of that as damping between them: their poles, by the eigenvalues of the whole,
    /// and how much of the other each has, by the null vector there.
    #[test]
    fn val_poles_and_shapes_of_modes_that_run_together_are_those_of_the_pair() {
        let [first, second] = [(755.0, 8e-3), (761.0, 5e-3)].map(|(hertz, zeta)| (std::f64::consts::TAU * hertz, zeta));
        let pole = |(omega, zeta): (f64, f64)| omega * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt());
        let damping = [2.0 * first.0 * first.1, 2.0 * second.0 * second.1];
        for part in [0.05, 0.15] {
            let between = part * (damping[0] * damping[1]).sqrt();
            let whole = Matrix4::new(
                0.0,
                0.0,
                1.0,
                0.0, //
                0.0,
                0.0,
                0.0,
                1.0, //
                -first.0.powi(2),
                0.0,
                -damping[0],
                -between, //
                0.0,
                -second.0.powi(2),
                -between,
                -damping[1],
            );
            let exact = whole.complex_eigenvalues();
            let modes = [first, second];
            for number in [0, 1] {
                let (own, other) = (pole(modes[number]), pole(modes[1 - number]));
                let [share, shift] = coupled(between, own, other);
                let near = |a: &&Complex<f64>, b: &&Complex<f64>| (**a - own).norm().total_cmp(&(**b - own).norm());
                let found = *exact.iter().min_by(near).unwrap();
                let moved = found / own - 1.0;
                assert!(
                    moved.norm() > 1e-5 && (moved - shift).norm() < 3.0 * part.powi(2) * moved.norm(),
                    "{moved} {shift}"
                );
                // The row of the pole's own mode at the null vector gives the other's share.
                let exact = -(found * found + damping[number] * found + modes[number].0.powi(2)) / (between * found);
                assert!((exact - share).norm() < 3.0 * part.powi(2) * share.norm(), "{exact} {share}");
            }
        }
    }
}
