//! Spans across the plate that have lost shear stiffness, and the kinks of the deflection at their edges.
//!
//! The shear force is continuous, so at an edge the shear strain jumps and $w$ has a kink; the rotations stay smooth. A
//! series of polynomials would follow it with an error that falls no faster than one over their number.

use crate::ShearLoss;
use crate::legendre::gauss_legendre;
use crate::order::sort;

/// The spans in $t = x/h$.
#[derive(Debug, Clone)]
pub(super) struct Spans {
    losses: Vec<(f64, [f64; 2])>,
}

/// Closer than this, in $t$, two edges are one, or an edge is the plate's own.
const SAME: f64 = 1e-9;

impl Spans {
    pub(super) fn new(half_length: f64, losses: &[ShearLoss]) -> Self {
        let span = |loss: &ShearLoss| (loss.loss, loss.edges(half_length).map(|edge| edge / half_length));
        Self { losses: losses.iter().map(span).collect() }
    }

    /// Rising, those of the plate left out.
    fn edges(&self) -> Vec<f64> {
        let mut edges: Vec<f64> = self.losses.iter().flat_map(|(_, edges)| *edges).collect();
        edges.retain(|edge| edge.abs() < 1.0 - SAME);
        sort(&mut edges);
        edges.dedup_by(|a, b| (*a - *b).abs() < SAME);
        edges
    }

    /// The kinks of $w$ and of its slope, where these ends hold the deflection.
    pub(super) fn kinks(&self, held: [bool; 2]) -> Vec<Kink> {
        let at = |edge: f64| [1, 2].map(|degree| Kink { edge, degree, held });
        self.edges().into_iter().flat_map(at).collect()
    }

    /// Points and weights from edge to edge, exact for degree $2\,\text{count}-1$ between them.
    pub(super) fn rule(&self, count: usize) -> Vec<(f64, f64)> {
        let ends: Vec<f64> = [-1.0].into_iter().chain(self.edges()).chain([1.0]).collect();
        let piece = |pair: &[f64]| {
            let [low, high] = [pair[0], pair[1]];
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            gauss_legendre(count).iter().map(|(t, weight)| (middle + half * t, half * weight)).collect::<Vec<_>>()
        };
        ends.windows(2).flat_map(piece).collect()
    }

    /// The share of the shear stiffness that is left at $t$.
    pub(super) fn remaining(&self, t: f64) -> f64 {
        let lost = self.losses.iter().filter(|(_, [low, high])| (*low..*high).contains(&t));
        1.0 - lost.map(|(loss, _)| loss).sum::<f64>()
    }
}

/// $b(t)\,|t-e|\,(t-e)^{d-1}$, with $b$ zero where the deflection is held.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kink {
    edge: f64,
    degree: i32,
    held: [bool; 2],
}

impl Kink {
    /// Value and derivative.
    pub(super) fn at(&self, t: f64) -> [f64; 2] {
        let away = t - self.edge;
        let side = if away < 0.0 { -1.0 } else { 1.0 };
        let (kink, slope) = (side * away.powi(self.degree), side * f64::from(self.degree) * away.powi(self.degree - 1));
        let (bubble, bubble_slope) = match self.held {
            [false, false] => (1.0, 0.0),
            [true, false] => (1.0 + t, 1.0),
            [false, true] => (1.0 - t, -1.0),
            [true, true] => (1.0 - t * t, -2.0 * t),
        };
        [bubble * kink, bubble_slope * kink + bubble * slope]
    }
}
