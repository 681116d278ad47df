//! Sums of squares that were worked out before: a search begins where another has ended, or at a start that was scored.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use super::record_problem::{Grouping, State};
use crate::least_squares::Quadratic;

/// So many are kept: the starts of some effects.
const KEPT: usize = 256;

/// The latest sums of squares of a test's records.
#[derive(Default)]
pub(super) struct KnownSums(Mutex<VecDeque<Known>>);

/// Of which lines and groups, where, and the sums.
struct Known {
    stage: usize,
    grouping: Grouping,
    state: State,
    sums: Arc<Vec<Quadratic>>,
}

impl KnownSums {
    /// The sums at just this state; what a panic has poisoned is only worked out once more.
    pub(super) fn find(&self, (stage, grouping): (usize, Grouping), state: &State) -> Option<Arc<Vec<Quadratic>>> {
        let known = self.0.lock().ok()?;
        let is_it = |known: &&Known| (known.stage, known.grouping) == (stage, grouping) && known.state.is(state);
        known.iter().rev().find(is_it).map(|known| Arc::clone(&known.sums))
    }

    pub(super) fn keep(&self, (stage, grouping): (usize, Grouping), state: State, sums: &Arc<Vec<Quadratic>>) {
        let Ok(mut known) = self.0.lock() else { return };
        if known.len() >= KEPT {
            known.pop_front();
        }
        known.push_back(Known { stage, grouping, state, sums: Arc::clone(sums) });
    }

    /// To be called where the records change.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }
}
