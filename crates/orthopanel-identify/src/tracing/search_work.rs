//! What a search has cost, counted in lines of the plain beam and not in seconds: where it ends is the same on any machine.

use std::sync::atomic::{AtomicU64, Ordering};

use super::core_modes::CORE;
use super::hypothesis::{Hypothesis, PLATE};
use super::rough::ROUGHNESS;

/// Making a model costs as much as so many of its lines.
const MAKING: u64 = 4000;
/// Effects for which modes are solved at several nodes, on a basis with moving edges, of a plate, or with a dozen derivatives
/// more, and how much more each line of these costs.
const DEARER: [(&str, u64); 4] = [(CORE, 8), ("stiffness-loss", 4), (PLATE, 8), (ROUGHNESS, 4)];

/// How much more a line costs with this effect than without.
pub(super) fn dearness(id: &str) -> u64 {
    DEARER.iter().find(|(dear, _)| *dear == id).map_or(1, |(_, factor)| *factor)
}

/// Lines that were evaluated, as those of the plain beam; threads count together.
#[derive(Debug, Default)]
pub(super) struct SearchWork(AtomicU64);

impl SearchWork {
    /// Counts so many lines of a model with these effects, and its making.
    pub(super) fn count(&self, hypothesis: &Hypothesis, lines: usize) {
        let factor: u64 = hypothesis.effects.iter().map(|on| dearness(on.effect.id())).product();
        self.0.fetch_add((MAKING + lines as u64) * factor, Ordering::Relaxed);
    }

    pub(super) fn lines(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    pub(super) fn begin_anew(&self) {
        self.0.store(0, Ordering::Relaxed);
    }
}
