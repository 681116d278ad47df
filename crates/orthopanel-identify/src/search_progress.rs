//! How far a search of hypotheses is.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::outcome::Progress;

/// Counts the hypotheses that were tried, and tells each.
#[derive(Default)]
pub(crate) struct SearchProgress<'a> {
    tell: Option<&'a (dyn Fn(Progress) + Sync)>,
    done: AtomicUsize,
    of: AtomicUsize,
}

impl<'a> SearchProgress<'a> {
    pub(crate) fn telling(tell: &'a (dyn Fn(Progress) + Sync)) -> Self {
        Self { tell: Some(tell), ..Self::default() }
    }

    /// So many more are to be tried.
    pub(crate) fn more(&self, count: usize) {
        self.of.fetch_add(count, Ordering::Relaxed);
    }

    /// One was tried: that which this effect was added to.
    pub(crate) fn tried(&self, effect: &'static str) {
        let done = 1 + self.done.fetch_add(1, Ordering::Relaxed);
        if let Some(tell) = self.tell {
            tell(Progress { effect, done, of: self.of.load(Ordering::Relaxed) });
        }
    }
}
