//! An effect on its way from a net of starts to the posterior.

use crate::hypothesis::Hypothesis;
use crate::model_error::KINDS;
use crate::posterior::Point;

/// A start with its way, and what it makes good.
pub(super) type Promise = (f64, (usize, Point));

/// An effect beside a base: its ways, and where to begin.
pub(super) struct Ranked {
    pub ways: Vec<Hypothesis>,
    /// Of all starts the best, by their cost under wide sizes of model error, each with its way.
    pub points: Vec<(usize, Point)>,
    /// Those that may come to the odds that count, each with what it makes good of the misfit to first order; `None` where that is not known.
    pub promising: Option<Vec<Promise>>,
    /// Whether the base's own coordinates begin in several places.
    pub of_several: bool,
}

impl Ranked {
    /// What the best start makes good of the misfit, to first order.
    pub(super) fn gain(&self) -> f64 {
        self.promising.iter().flatten().map(|(gain, _)| *gain).filter(|gain| gain.is_finite()).fold(0.0, f64::max)
    }

    /// Leaves out what makes good much less than another effect does.
    pub(super) fn without_minor(mut self, most: f64) -> Self {
        if let Some(promising) = &mut self.promising {
            promising.retain(|(gain, _)| *gain > MINOR * most);
        }
        self
    }
}

/// Part of what the best effect makes good of a plate's misfit, below which an effect is not followed: a plate has places without number, and most
/// effects make good a little of what another does.
const MINOR: f64 = 0.1;

/// An effect beside a base, near where its starts lead.
pub(super) struct Approach {
    pub ways: Vec<Hypothesis>,
    /// The best first, each with its way.
    pub points: Vec<(usize, Point)>,
    /// $\ln\tau_k$ under which they are the best.
    pub sizes: [f64; KINDS],
    /// By how much the best is better than the base; $-\infty$ where it was not followed.
    pub gain: f64,
}

impl Approach {
    pub(super) fn gain(&self) -> f64 {
        self.gain
    }
}
