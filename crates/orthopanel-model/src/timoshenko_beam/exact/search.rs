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

/// The family seen at one $\mu$.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sight {
    mu: f64,
    probe: Probe,
}

impl Sight {
    /// Whether the residual changes sign from here to there.
    fn parts(self, other: Self) -> bool {
        self.probe.residual * other.probe.residual < 0.0
    }
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

    fn look(&self, mu: f64) -> Sight {
        Sight { mu, probe: probe(self.ratios, self.boundary, self.family, mu) }
    }

    /// Pinned value number `k`, from 1; a small fraction of the first for `k = 0`.
    fn pinned_value(&mut self, k: usize) -> f64 {
        while self.window.len() < k.max(1) {
            // The pinned spectrum has no end.
            self.window.extend(self.pinned.next());
        }
        if k == 0 { 1e-4 * self.window[0] } else { self.window[k - 1] }
    }

    /// Two sights with mode `k` alone between them, or as close to each other as numbers can be.
    fn bracket(&mut self, k: usize) -> (Sight, Sight) {
        let (below, above) = match (self.family, self.boundary.left, self.boundary.right) {
            (Family::Mixed, _, _) => (SHIFT + 1, SHIFT),
            (_, End::Free, _) => (1, 0),
            _ => (0, 1),
        };
        // A hair outwards: at a pinned frequency itself the count is not defined.
        let (lowest, highest) = (self.pinned_value(k.saturating_sub(below)), self.pinned_value(k + above));
        let mut low = self.look(lowest * (1.0 - 1e-9));
        let mut high = self.look(highest * (1.0 + 1e-9));
        while low.probe.below >= k {
            low = self.look(0.5 * low.mu);
        }
        while high.probe.below < k {
            high = self.look(1.1 * high.mu);
        }
        while high.mu - low.mu > 4.0 * f64::EPSILON * high.mu {
            if low.probe.below + 1 == k && high.probe.below == k && low.parts(high) {
                break;
            }
            let middle = self.look((low.mu * high.mu).sqrt());
            if middle.probe.below >= k {
                high = middle;
            } else {
                low = middle;
            }
        }
        (low, high)
    }

    /// Chandrupatla's root search (1997) on the residual: inverse quadratic where safe, else bisection. Written here
    /// because a search may cost no more than some tens of evaluations of 50 ns, set-up included.
    fn polish(&self, low: Sight, high: Sight) -> f64 {
        let (mut a, mut fa) = (low.mu, low.probe.residual);
        let (mut b, mut fb) = (high.mu, high.probe.residual);
        let (mut c, mut fc);
        let mut fraction = 0.5;
        for _ in 0..120 {
            let trial = a + fraction * (b - a);
            let ft = self.look(trial).probe.residual;
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
        // Without a change of sign the bracket has closed on modes that numbers cannot part.
        Some(if low.parts(high) { self.polish(low, high) } else { 0.5 * (low.mu + high.mu) })
    }
}
