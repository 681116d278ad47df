//! Finds the k-th mode of a family: brackets from the pinned beam, narrowed by the count, polished on the equation.

use super::end_conditions::{Family, Probe, probe};
use super::pinned_spectrum::PinnedSpectrum;
use super::waves::Ratios;
use crate::{Boundary, End};

/// Values of $\mu$ of the flexible modes of one family, rising, without end.
pub(super) struct ModeSearch {
    ratios: Ratios,
    boundary: Boundary,
    family: Family,
    pinned: PinnedSpectrum,
    /// Pinned values already drawn that may still bracket a mode.
    window: Vec<f64>,
    /// Number of the next mode in the family, counted from 1 with the rigid ones.
    next: usize,
}

/// By how many modes freeing or clamping both ends can shift the count, at the most.
const SHIFT: usize = 2;

impl ModeSearch {
    pub(super) fn new(ratios: Ratios, boundary: Boundary, family: Family) -> Self {
        let rigid = match family {
            Family::Mixed => boundary.rigid_modes(),
            _ => boundary.rigid_modes() / 2,
        };
        let pinned = PinnedSpectrum::new(ratios, family);
        Self { ratios, boundary, family, pinned, window: Vec::new(), next: rigid + 1 }
    }

    fn look(&self, mu: f64) -> Probe {
        probe(self.ratios, self.boundary, self.family, mu)
    }

    /// Pinned value number `k`, from 1; a small fraction of the first for `k = 0`.
    fn pinned_value(&mut self, k: usize) -> f64 {
        while self.window.len() < k.max(1) {
            // The pinned spectrum has no end.
            self.window.extend(self.pinned.next());
        }
        if k == 0 { 1e-4 * self.window[0] } else { self.window[k - 1] }
    }

    /// Lower and upper limit with mode `k` alone between them, or as close to each other as numbers can be.
    fn bracket(&mut self, k: usize) -> (f64, f64) {
        let (below, above) = match (self.family, self.boundary.left, self.boundary.right) {
            (Family::Mixed, _, _) => (SHIFT + 1, SHIFT),
            (_, End::Free, _) => (1, 0),
            _ => (0, 1),
        };
        // A hair outwards: at a pinned frequency itself the count is not defined.
        let mut low = self.pinned_value(k.saturating_sub(below)) * (1.0 - 1e-9);
        let mut high = self.pinned_value(k + above) * (1.0 + 1e-9);
        while self.look(low).below >= k {
            low *= 0.5;
        }
        while self.look(high).below < k {
            high *= 1.1;
        }
        while high - low > 4.0 * f64::EPSILON * high {
            let (at_low, at_high) = (self.look(low), self.look(high));
            let alone = at_low.below + 1 == k && at_high.below == k;
            if alone && at_low.residual * at_high.residual < 0.0 {
                break;
            }
            let middle = (low * high).sqrt();
            if self.look(middle).below >= k {
                high = middle;
            } else {
                low = middle;
            }
        }
        (low, high)
    }

    /// Chandrupatla's root search (1997) on the residual: inverse quadratic where safe, else bisection. Written here
    /// because a search may cost no more than some tens of evaluations of 50 ns, set-up included.
    fn polish(&self, low: f64, high: f64) -> f64 {
        let value = |mu: f64| self.look(mu).residual;
        let (mut a, mut b) = (low, high);
        let (mut fa, mut fb) = (value(a), value(b));
        let (mut c, mut fc);
        let mut fraction = 0.5;
        for _ in 0..120 {
            let trial = a + fraction * (b - a);
            let ft = value(trial);
            if (ft < 0.0) == (fa < 0.0) {
                (c, fc) = (a, fa);
            } else {
                (c, fc, b, fb) = (b, fb, a, fa);
            }
            (a, fa) = (trial, ft);
            let best = if fa.abs() < fb.abs() { a } else { b };
            let limit = 2.0 * f64::EPSILON * best / (b - a).abs();
            if limit > 0.5 || fa == 0.0 {
                return best;
            }
            let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
            fraction = if phi * phi < xi && (1.0 - phi).powi(2) < 1.0 - xi {
                fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            } else {
                0.5
            };
            fraction = fraction.clamp(limit, 1.0 - limit);
        }
        a
    }
}

impl Iterator for ModeSearch {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let (low, high) = self.bracket(self.next);
        self.next += 1;
        let (at_low, at_high) = (self.look(low), self.look(high));
        // Without a change of sign the bracket has closed on modes that numbers cannot part.
        let mu = if at_low.residual * at_high.residual < 0.0 { self.polish(low, high) } else { 0.5 * (low + high) };
        Some(mu)
    }
}
