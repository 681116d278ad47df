//! Accelerance of a [`ModalModel`] (eq. 21).

use faer::Mat;
use faer::prelude::Solve;
use num_complex::Complex64;

use crate::{ModalModel, Mode};

impl ModalModel {
    /// Accelerance \[(m/s²)/N\] at `frequency` \[Hz\], convention $e^{+j\omega t}$:
    /// $$G(f) = -\sum_m\frac{W_m(l_1)W_m(l_x)\,\omega^2}{\omega_m^2-\omega^2+2j\zeta_m\omega_m\omega}$$
    /// A rigid mode contributes $W_m(l_1)W_m(l_x)$ at every frequency. Ports are counted from zero; a port that the
    /// model lacks contributes nothing.
    pub fn accelerance(&self, force: usize, response: usize, frequency: f64) -> Complex64 {
        let omega = frequency * std::f64::consts::TAU;
        if !(self.damping_coupling().is_empty() && self.stiffness_coupling().is_empty()) {
            return self.coupled_accelerance(force, response, omega);
        }
        let part = |mode: &Mode| -> Option<Complex64> {
            let product = mode.at_forces.get(force)? * mode.at_responses.get(response)?;
            Some(product * mode.acceleration_per_force(omega))
        };
        self.modes().iter().filter_map(part).sum()
    }

    /// $-\omega^2W_r^T(\Omega + K - \omega^2 + j\omega(\Lambda + C))^{-1}W_f$, with the rigid modes, unless springs couple them, beside
    /// it.
    fn coupled_accelerance(&self, force: usize, response: usize, omega: f64) -> Complex64 {
        let seen = |mode: &Mode| Some((mode.at_forces.get(force).copied()?, mode.at_responses.get(response).copied()?));
        let Some(ports) = self.modes().iter().map(seen).collect::<Option<Vec<_>>>() else { return Complex64::ZERO };
        let all = || self.modes().iter().enumerate().zip(&ports);
        let alone = |mode: &Mode| mode.angular_frequency == 0.0 && self.stiffness_coupling().is_empty();
        let rigid: f64 = all().filter(|((_, mode), _)| alone(mode)).map(|(_, (f, r))| f * r).sum();
        let flexible: Vec<_> = all().filter(|((_, mode), _)| !alone(mode)).collect();
        let at = |coupling: &[Vec<f64>], m: usize, n: usize| coupling.get(m).map_or(0.0, |row| row[n]);
        let dynamic = Mat::from_fn(flexible.len(), flexible.len(), |i, j| {
            let ((m, mode), (n, _)) = (flexible[i].0, flexible[j].0);
            let [stiffness, damping] =
                [self.stiffness_coupling(), self.damping_coupling()].map(|coupling| at(coupling, m, n));
            let coupling = Complex64::new(stiffness, omega * damping);
            if i == j { mode.dynamic_stiffness(omega) + coupling } else { coupling }
        });
        let pushed = Mat::from_fn(flexible.len(), 1, |i, _| Complex64::from(flexible[i].1.0));
        let moved = dynamic.partial_piv_lu().solve(&pushed);
        let sum: Complex64 = flexible.iter().enumerate().map(|(i, (_, (_, r)))| moved[(i, 0)] * *r).sum();
        rigid - omega * omega * sum
    }
}

impl Mode {
    /// Modal acceleration for a modal force of one, $-\omega^2/(\omega_m^2-\omega^2+2j\zeta_m\omega_m\omega)$.
    pub(crate) fn acceleration_per_force(&self, omega: f64) -> Complex64 {
        if self.angular_frequency == 0.0 {
            return Complex64::new(1.0, 0.0);
        }
        -omega * omega / self.dynamic_stiffness(omega)
    }

    /// $\omega_m^2-\omega^2+2j\zeta_m\omega_m\omega$.
    fn dynamic_stiffness(&self, omega: f64) -> Complex64 {
        let own = self.angular_frequency;
        Complex64::new(own * own - omega * omega, 2.0 * self.damping_ratio * own * omega)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> ModalModel {
        let mode = |frequency: f64, zeta: f64, f: f64, r: f64| Mode {
            angular_frequency: frequency * std::f64::consts::TAU,
            damping_ratio: zeta,
            at_forces: vec![f],
            at_responses: vec![r],
        };
        ModalModel::new(
            1,
            1,
            vec![mode(0.0, 0.0, 1.2, 1.1), mode(100.0, 0.01, 0.7, -0.9), mode(250.0, 0.002, 1.3, 0.4)],
        )
        .unwrap()
    }

    /// The paper's second form of eq. 21, with its misprinted factor conjugated.
    #[test]
    fn val_both_forms_of_eq_21_agree() {
        let model = model();
        for frequency in [1.0, 99.9, 100.0, 180.0, 250.0, 900.0] {
            let omega: f64 = frequency * std::f64::consts::TAU;
            let sum: Complex64 = model
                .modes()
                .iter()
                .map(|mode| {
                    let own = mode.angular_frequency;
                    let gap = own * own - omega * omega;
                    let loss = 2.0 * mode.damping_ratio * own * omega;
                    -mode.at_forces[0] * mode.at_responses[0] * omega * omega / (gap * gap + loss * loss)
                        * Complex64::new(gap, -loss)
                })
                .sum();
            assert!((model.accelerance(0, 0, frequency) - sum).norm() < 1e-12 * sum.norm());
        }
    }

    #[test]
    fn val_rigid_mode_alone_at_zero_frequency() {
        assert!((model().accelerance(0, 0, 0.0).re - 1.2 * 1.1).abs() < 1e-15);
    }

    #[test]
    fn a_port_that_is_not_there_contributes_nothing() {
        assert_eq!(model().accelerance(3, 0, 10.0), Complex64::new(0.0, 0.0));
    }
}
