//! The states that an instance keeps for its importer.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::situation::Snapshot;
use crate::FmuError;

/// The states that an instance keeps for its importer.
#[derive(Debug)]
pub(super) struct FmuStates {
    pub(super) kept: BTreeMap<usize, Snapshot>,
    /// Token of the resource: bytes of another panel are refused.
    pub(super) token: String,
}

impl FmuStates {
    pub(super) fn new(token: &str) -> Self {
        Self { kept: BTreeMap::new(), token: token.into() }
    }

    /// A number that stands for no other state; never zero, which is C's null.
    fn new_handle() -> usize {
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        NEXT.fetch_add(1, Ordering::Relaxed)
    }

    pub(super) fn get(&self, handle: usize) -> Result<&Snapshot, FmuError> {
        self.kept.get(&handle).ok_or(FmuError::State(UNKNOWN))
    }

    /// Keeps a snapshot under `handle`, overwriting what was there, or under a new one where it is 0.
    pub(super) fn keep(&mut self, handle: usize, snapshot: Snapshot) -> Result<usize, FmuError> {
        let handle = match handle {
            0 => Self::new_handle(),
            _ => self.get(handle).map(|_| handle)?,
        };
        self.kept.insert(handle, snapshot);
        Ok(handle)
    }
}

/// What is said of a handle that stands for no state.
pub(super) const UNKNOWN: &str = "it is none that this instance keeps: it was freed, or is another instance's (carry it over by \
                       serializing it)";
