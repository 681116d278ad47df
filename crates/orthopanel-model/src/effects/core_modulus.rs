//! A shear modulus that depends on frequency.

use num_complex::Complex64;

/// The fractional Zener core: $G(s) = G\,g(s)$,
/// $$g(s) = 1 + \Delta\,\frac{(s\tau)^\alpha}{1 + (s\tau)^\alpha}$$
/// from the relaxed modulus $G$ at low frequency to $G(1+\Delta)$ at high. $\alpha = 1$ is the standard linear solid.
/// Reference: Bagley and Torvik, J. Rheology 27 (1983) 201.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoreModulus {
    /// $\Delta$ \[1\].
    pub strength: f64,
    /// $\tau$ \[s\].
    pub tau: f64,
    /// $\alpha$ \[1\].
    pub alpha: f64,
}

/// A modulus factor at one $s$ with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoreLine {
    /// $g$.
    pub value: Complex64,
    /// By $s$.
    pub by_s: Complex64,
    /// By strength, $\tau$ and $\alpha$.
    pub by_numbers: [Complex64; 3],
}

impl CoreModulus {
    /// The factor at $s \ne 0$, principal branch.
    pub fn line(&self, s: Complex64) -> CoreLine {
        let Self { strength, tau, alpha } = *self;
        if s == Complex64::ZERO {
            return CoreLine { value: Complex64::ONE, by_s: Complex64::ZERO, by_numbers: [Complex64::ZERO; 3] };
        }
        let log = (s * tau).ln();
        let power = (alpha * log).exp();
        let share = power / (1.0 + power);
        let by_log_power = strength * share / (1.0 + power);
        CoreLine {
            value: 1.0 + strength * share,
            by_s: by_log_power * alpha / s,
            by_numbers: [share, by_log_power * alpha / tau, by_log_power * log],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_standard_linear_solid_and_derivatives() {
        let (s, core) = (Complex64::new(20.0, 3000.0), CoreModulus { strength: 0.3, tau: 4e-4, alpha: 0.6 });
        let solid = CoreModulus { alpha: 1.0, ..core }.line(s).value;
        assert!((solid - (1.0 + 0.3 * s * 4e-4 / (1.0 + s * 4e-4))).norm() < 1e-15);
        let here = core.line(s);
        let at = |strength: f64, tau: f64, alpha: f64, s: Complex64| CoreModulus { strength, tau, alpha }.line(s).value;
        let h = 1e-5;
        let differences = [
            (at(0.3 + h, 4e-4, 0.6, s) - at(0.3 - h, 4e-4, 0.6, s)) / (2.0 * h),
            (at(0.3, 4e-4 * (1.0 + h), 0.6, s) - at(0.3, 4e-4 * (1.0 - h), 0.6, s)) / (8e-4 * h),
            (at(0.3, 4e-4, 0.6 + h, s) - at(0.3, 4e-4, 0.6 - h, s)) / (2.0 * h),
            (at(0.3, 4e-4, 0.6, s + 1.0) - at(0.3, 4e-4, 0.6, s - 1.0)) / 2.0,
        ];
        let [strength, tau, alpha] = here.by_numbers;
        for (by, difference) in [strength, tau, alpha, here.by_s].into_iter().zip(differences) {
            assert!((by - difference).norm() < 1e-6 * difference.norm());
        }
    }
}
