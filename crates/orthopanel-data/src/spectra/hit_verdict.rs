//! What became of each hit of a history.

use super::{hit::Hit, hit_faults::HitFault, overload::shared_extremes, time_history::TimeHistory};
use crate::Estimation;

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

impl TimeHistory {
    /// What is wrong with each hit, in their order, as [`TimeHistory::accelerance`] with its usual settings judges them: by
    /// themselves, by extremes that they share, and beside one another. Where no accelerance can be made of them, not
    /// beside one another.
    pub fn verdicts(&self) -> Vec<HitVerdict> {
        let judged = self.accelerance(Estimation::default()).ok();
        judged.map_or_else(|| self.first_verdicts(), |accelerance| accelerance.verdicts)
    }

    /// What is wrong with each hit that is left out, a sentence a fault.
    pub fn left_out_of(&self, verdicts: &[HitVerdict]) -> Vec<String> {
        let left_out = verdicts.iter().enumerate().filter(|(_, verdict)| !verdict.is_kept());
        left_out.flat_map(|(index, verdict)| verdict.notes(&self.hit_name(index))).collect()
    }

    /// Before the hits are held against one another.
    pub(super) fn first_verdicts(&self) -> Vec<HitVerdict> {
        let shared = shared_extremes(&self.hits);
        let verdict = |(index, hit): (usize, &Hit)| {
            let mut faults = hit.faults(self.rate);
            if !faults.iter().any(|fault| matches!(fault, HitFault::Overload { .. })) {
                faults.extend(shared.iter().filter(|(of, _)| *of == index).map(|(_, fault)| *fault));
            }
            let original = self.hits.iter().take(index).position(|earlier| earlier == hit);
            faults.extend(original.map(|of| HitFault::Copy { of: of + 1 }));
            HitVerdict { faults }
        };
        self.hits.iter().enumerate().map(verdict).collect()
    }

    /// The hits that are kept, with their numbers from zero.
    pub(super) fn kept(&self, verdicts: &[HitVerdict]) -> Vec<(usize, &Hit)> {
        let judged = self.hits.iter().enumerate().zip(verdicts);
        judged.filter(|(_, verdict)| verdict.is_kept()).map(|(hit, _)| hit).collect()
    }
}
