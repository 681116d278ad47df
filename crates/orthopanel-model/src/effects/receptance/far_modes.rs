//! Weights of the series that stands for the modes above the sum.
//!
//! With $C_k = \sum\phi\phi^T\lambda^{-(k+1)}$ over these modes, $1/(\lambda+s^2+2\zeta\sqrt\lambda s)$ is to first order in $\zeta$
//! $$\sum_k(-s^2)^k\lambda^{-(k+1)} - 2\zeta s\sum_k(k+1)(-s^2)^k\lambda^{-(k+3/2)}.$$
//! The half powers are read off the whole ones: above the last mode that is summed, $\lambda_c$, the root is a polynomial of
//! $u=\lambda_c/\lambda\le1$, $\lambda^{-1/2}\approx\lambda_c^{-1/2}\sum_ia_iu^i$. So the series stays, only its weights change:
//! $$w_k = (-s^2)^k - \frac{2\zeta s}{\sqrt{\lambda_c}}\sum_{i\le k}a_i\lambda_c^i\,(k-i+1)(-s^2)^{k-i}.$$
//! Without damping of these modes a driving point is wrong by 1e-3 of its motion where 24 are summed.

use num_complex::Complex64;

/// Terms of the series in $s^2$ that stands for the modes above the sum. Where these begin at 2.5 times the band, six
/// leave 2e-5 of a part that is small itself.
pub(super) const SERIES_TERMS: usize = 6;

/// $\sqrt u$ on $0..1$ by least squares, weighed as modes at even distances count in $C_0$: nothing is missed in the mean, 6 % rms.
const ROOT: [f64; 3] = [0.11926884, 1.63064541, -0.8110908];

/// $w_k$ at `s` above a mode of $\lambda_c$; none without a mode. All have one damping ratio.
pub(super) fn weights(s: Complex64, zeta: f64, lambda: Option<Complex64>) -> [Complex64; SERIES_TERMS] {
    let mut powers = [Complex64::ONE; SERIES_TERMS];
    for k in 1..SERIES_TERMS {
        powers[k] = -powers[k - 1] * s * s;
    }
    let Some(lambda) = lambda else { return powers };
    let slowness = -2.0 * zeta * s / lambda.sqrt();
    let scales = [slowness, slowness * lambda, slowness * lambda * lambda];
    std::array::from_fn(|k| {
        let terms = scales.iter().zip(ROOT).enumerate().take(k + 1);
        let loss = terms.map(|(i, (scale, a))| scale * a * (k - i + 1) as f64 * powers[k - i]);
        powers[k] + loss.sum::<Complex64>()
    })
}
