//! Bayes' information criterion, scaled to what the residuals are.

/// What turns a sum of squares into a likelihood: the part of the lines that is independent, and the misfit per datum of
/// the best hypothesis where even that is above the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LikelihoodScale {
    /// From [`super::whiteness::independent_part`].
    pub independent: f64,
    /// Misfit per datum that counts as one; at least 1.
    pub unit: f64,
    /// Real data.
    pub data: usize,
}

impl LikelihoodScale {
    /// $\kappa c/s^2 + k\ln(\kappa n)$ for the sum of squares $c$ with $k$ free parameters: less is better, and a difference of
    /// $d$ stands for odds of $e^{d/2}$. Without the scaling thousands of lines that err together would prove anything.
    pub(super) fn bic(&self, cost: f64, size: usize) -> f64 {
        self.independent * cost / self.unit + size as f64 * (self.independent * self.data as f64).max(1.0).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_white_residuals_give_the_plain_criterion() {
        let scale = LikelihoodScale { independent: 1.0, unit: 1.0, data: 1000 };
        assert!((scale.bic(950.0, 7) - (950.0 + 7.0 * 1000.0_f64.ln())).abs() < 1e-9);
    }

    #[test]
    fn lines_that_err_together_weigh_less() {
        let plain = LikelihoodScale { independent: 1.0, unit: 1.0, data: 1000 };
        let tied = LikelihoodScale { independent: 0.25, unit: 1.0, data: 1000 };
        let margin = |scale: &LikelihoodScale| scale.bic(1100.0, 5) - scale.bic(1000.0, 6);
        assert!(margin(&tied) < 0.26 * margin(&plain) + 1.0 && margin(&tied) > 0.0);
    }
}
