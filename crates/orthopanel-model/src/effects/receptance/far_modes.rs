//! Weights of the series that stands for the modes above the sum.
//!
//! With $C_k = \sum\phi\phi^T\lambda^{-(k+1)}$ over these modes, $1/(\lambda+s^2+2\zeta\sqrt\lambda s)$ is to first order in $\zeta$
//! $$\sum_k(-s^2)^k\lambda^{-(k+1)} - 2\zeta s\sum_k(k+1)(-s^2)^k\lambda^{-(k+3/2)}.$$
//! The half powers are read off the whole ones: above the last mode that is summed, $\lambda_c$, the root is a polynomial of
//! $u=\lambda_c/\lambda\le1$, $\lambda^{-1/2}\approx\lambda_c^{-1/2}\sum_ia_iu^i$. So the series stays, only its weights change:
//! $$w_k = (-s^2)^k - \frac{2\zeta s}{\sqrt{\lambda_c}}\sum_{i\le k}a_i\lambda_c^i\,(k-i+1)(-s^2)^{k-i}.$$
//! Without damping of these modes a driving point is wrong by 1e-3 of its motion where 24 are summed.

use super::view::SERIES_TERMS;
use super::wide::Wide;

/// $\sqrt u$ on $0..1$ by least squares, weighed as modes at even distances count in $C_0$: nothing is missed in the mean, 6 % rms.
const ROOT: [f64; 3] = [0.11926884, 1.63064541, -0.8110908];

/// The weights on some lines.
#[derive(Debug, Clone, Default)]
pub(super) struct FarModes {
    /// $w_k$.
    pub weights: Vec<Wide>,
    /// What damping adds to these, which is their derivative by $\ln\zeta$ too.
    pub by_damping: Vec<Wide>,
    /// Their derivatives by $\lambda_c$.
    pub by_lambda: Vec<Wide>,
    /// Their derivatives by $s$.
    pub by_s: Vec<Wide>,
    /// $(-s^2)^k$.
    powers: Vec<Wide>,
}

impl FarModes {
    /// At `s`, above a mode of $\lambda_c$ and its root, all with one damping ratio; derivatives by $s$ only where asked for.
    #[inline(always)]
    pub(super) fn set(&mut self, s: &Wide, zeta: f64, [lambda, root]: [&Wide; 2], with_by_s: bool) {
        let step = s.times(s).scaled(-1.0);
        self.powers.clear();
        self.powers.push(Wide::ONE);
        for k in 1..SERIES_TERMS {
            self.powers.push(self.powers[k - 1].times(&step));
        }
        let slowness = root.inverse().scaled(-2.0 * zeta);
        let scales = [slowness, slowness.times(lambda), slowness.times(&lambda.times(lambda))];
        let by_log = s.times(&lambda.inverse());
        for list in [&mut self.weights, &mut self.by_damping, &mut self.by_lambda, &mut self.by_s] {
            list.clear();
        }
        for k in 0..SERIES_TERMS {
            let (mut loss, mut steeper, mut by_s) = (Wide::ZERO, Wide::ZERO, Wide::ZERO);
            for (i, (scale, a)) in scales.iter().zip(ROOT).enumerate().take(k + 1) {
                let term = scale.scaled(a * (k - i + 1) as f64).times(&self.powers[k - i]);
                loss.add(&term);
                steeper.add_scaled(i as f64 - 0.5, &term);
                if with_by_s {
                    // d(s(-s²)^k)/ds = (2k+1)(-s²)^k
                    by_s.add_scaled((2 * (k - i) + 1) as f64, &term);
                }
            }
            let loss = loss.times(s);
            let mut weight = self.powers[k];
            weight.add(&loss);
            self.weights.push(weight);
            self.by_damping.push(loss);
            self.by_lambda.push(steeper.times(&by_log));
            if with_by_s {
                if k > 0 {
                    by_s.add_product(&s.scaled(-2.0 * k as f64), &self.powers[k - 1]);
                }
                self.by_s.push(by_s);
            }
        }
    }
}
