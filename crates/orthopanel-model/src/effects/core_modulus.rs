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

impl CoreModulus {
    /// $g(s)$, principal branch.
    pub fn factor(&self, s: Complex64) -> Complex64 {
        if s == Complex64::ZERO {
            return Complex64::ONE;
        }
        let power = (self.alpha * (s * self.tau).ln()).exp();
        1.0 + self.strength * power / (1.0 + power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_the_standard_linear_solid() {
        let (s, core) = (Complex64::new(20.0, 3000.0), CoreModulus { strength: 0.3, tau: 4e-4, alpha: 0.6 });
        let solid = CoreModulus { alpha: 1.0, ..core }.factor(s);
        assert!((solid - (1.0 + 0.3 * s * 4e-4 / (1.0 + s * 4e-4))).norm() < 1e-15);
    }
}
