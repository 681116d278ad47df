//! What became of each hit of a history.

use super::hit_faults::HitFault;

/// The faults of one hit, found in itself or beside the other hits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HitVerdict {
    /// In the order in which they were found.
    pub faults: Vec<HitFault>,
}

impl HitVerdict {
    /// Whether an accelerance stands on the hit: none of its faults spoils it.
    pub fn is_kept(&self) -> bool {
        !self.faults.iter().any(|fault| fault.is_fatal())
    }

    /// Each fault and what became of the hit, such as `hit 2 left out: no signal in the force`, of a hit of this name.
    pub(super) fn notes(&self, name: &str) -> Vec<String> {
        let verdict = if self.is_kept() { "kept" } else { "left out" };
        self.faults.iter().map(|fault| format!("{name} {verdict}: {fault}")).collect()
    }
}
