//! Waves of the beam at one frequency and what they do at its end.
//!
//! Lengths are in units of $a$: $\xi = x/a$, $\bar w = w/a$. With
//! $$\mu = \frac{\rho A\omega^2a^4}{EI},\qquad r^2 = \frac{I}{Aa^2},\qquad s^2 = \frac{EI}{k'GAa^2}$$
//! eq. 5 reads $\psi'' - (\bar w'+\psi)/s^2 + \mu r^2\psi = 0$, $\bar w'' + \psi' + \mu s^2\bar w = 0$, and eq. 8
//! $$\alpha^2,\;-\beta^2 = \tfrac{\mu}{2}(r^2+s^2) \pm \sqrt{\tfrac{\mu^2}{4}(r^2-s^2)^2+\mu}.$$
//! Above the cut-off (9), $1 = \mu r^2s^2$, $\beta^2$ is negative and $\cosh\beta\xi$ turns into a cosine. Every
//! expression here is a function of $\beta^2$ that passes through zero smoothly.

use std::f64::consts::PI;

/// Slenderness and shear softness of a beam: $r^2$ and $s^2$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ratios {
    pub r2: f64,
    pub s2: f64,
}

/// The two wave numbers at $\mu$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Waves {
    /// $\alpha$, of the wave that always travels.
    pub alpha: f64,
    /// $\beta^2$, of the wave that decays while positive and travels while negative.
    pub beta2: f64,
    /// $\sqrt{|\beta^2|}$.
    pub beta: f64,
    /// $m_1 = \alpha^2 - \mu s^2$: moment per deflection of the first wave.
    pub m1: f64,
    /// $m_2 = \beta^2 + \mu s^2$: minus the moment per deflection of the second.
    pub m2: f64,
    /// $\mu s^2$.
    pub shear: f64,
}

impl Waves {
    pub(super) fn at(ratios: Ratios, mu: f64) -> Self {
        let Ratios { r2, s2 } = ratios;
        let root = (0.25 * (mu * (r2 - s2)).powi(2) + mu).sqrt();
        let alpha2 = 0.5 * mu * (r2 + s2) + root;
        // From the product of the roots: the difference in eq. 8 would cancel.
        let beta2 = mu * (1.0 - mu * r2 * s2) / alpha2;
        // m1 and m2 = root ± skew, and m1 m2 = μ: the smaller from the product, again without cancelling.
        let skew = 0.5 * mu * (r2 - s2);
        let (m1, m2) = if skew >= 0.0 { (root + skew, mu / (root + skew)) } else { (mu / (root - skew), root - skew) };
        Self { alpha: alpha2.sqrt(), beta2, beta: beta2.abs().sqrt(), m1, m2, shear: mu * s2 }
    }

    /// Number of natural frequencies below this one of the beam pinned at both ends, deflection (even, odd):
    /// there $\alpha = n\pi$, and above the cut-off also $|\beta| = n\pi$ with $n = 0$ (pure shear) among them.
    pub(super) fn pinned_counts(&self) -> [usize; 2] {
        let half = self.alpha / PI;
        let mut even = ((half + 1.0) / 2.0) as usize;
        let mut odd = (half / 2.0) as usize;
        if self.beta2 < 0.0 {
            let half = self.beta / PI;
            even += ((half + 1.0) / 2.0) as usize;
            odd += 1 + (half / 2.0) as usize;
        }
        [even, odd]
    }

    /// $\cosh(\beta\xi)$ and $\sinh(\beta\xi)/\beta$, both over $\cosh(\beta/2)$ while $\beta^2 > 0$, so that
    /// neither overflows for $|\xi| \le 1/2$.
    pub(super) fn second_wave(&self, xi: f64) -> (f64, f64) {
        let beta = self.beta;
        if self.beta2 > 0.0 {
            let whole = (-beta).exp();
            // Most calls are for the end, where these two are known.
            let at_end = xi == 0.5;
            let (far, near) =
                if at_end { (1.0, whole) } else { ((-beta * (0.5 - xi)).exp(), (-beta * (0.5 + xi)).exp()) };
            let scale = 1.0 + whole;
            // While β is small the two exponentials nearly cancel; sinh does not, nor can it overflow there.
            let difference = if beta < 1.0 { 2.0 * (-0.5 * beta).exp() * (beta * xi).sinh() } else { far - near };
            ((far + near) / scale, difference / (beta * scale))
        } else if beta == 0.0 {
            (1.0, xi)
        } else {
            let (sine, cosine) = (beta * xi).sin_cos();
            (cosine, sine / beta)
        }
    }
}

/// Deflection, rotation, moment ($\psi'$) and shear strain ($\bar w' + \psi$) of one wave at one place.
pub(super) type Field = [f64; 4];

/// Index of each quantity in a [`Field`].
pub(super) const DEFLECTION: usize = 0;
pub(super) const ROTATION: usize = 1;
pub(super) const MOMENT: usize = 2;
pub(super) const SHEAR: usize = 3;

/// The two waves of even and of odd deflection, in a form that stays regular at the cut-off.
///
/// Even: $\bar w = \cos\alpha\xi$ and $\cosh\beta\xi$; odd: $\sin\alpha\xi$ and $\beta\sinh\beta\xi$; rotations by
/// eq. 10.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fields {
    pub even: [Field; 2],
    pub odd: [Field; 2],
}

impl Fields {
    pub(super) fn at(waves: &Waves, xi: f64) -> Self {
        Self { even: even_fields(waves, xi), odd: odd_fields(waves, xi) }
    }
}

/// The two waves of even deflection at $\xi$.
pub(super) fn even_fields(waves: &Waves, xi: f64) -> [Field; 2] {
    let Waves { alpha, m1, m2, shear, .. } = *waves;
    let (sine, cosine) = (alpha * xi).sin_cos();
    let (cosh, sinh) = waves.second_wave(xi);
    [[cosine, m1 / alpha * sine, m1 * cosine, -shear / alpha * sine], [cosh, -m2 * sinh, -m2 * cosh, -shear * sinh]]
}

/// The two waves of odd deflection at $\xi$.
pub(super) fn odd_fields(waves: &Waves, xi: f64) -> [Field; 2] {
    let Waves { alpha, beta2, m1, m2, shear, .. } = *waves;
    let (sine, cosine) = (alpha * xi).sin_cos();
    let (cosh, sinh) = waves.second_wave(xi);
    [
        [sine, -m1 / alpha * cosine, m1 * sine, shear / alpha * cosine],
        [beta2 * sinh, -m2 * cosh, -m2 * beta2 * sinh, -shear * cosh],
    ]
}
