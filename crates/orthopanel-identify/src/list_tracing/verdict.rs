//! Which word the fits of the lists deserve.

use super::list_fit::ListFit;
use super::trust::Trust;
use crate::outcome::Verdict;

/// By so much the criterion must fall for an effect, and so far behind a rival must stay: odds of a hundred and fifty to one.
pub(super) const CLEAR: f64 = 10.0;
/// An effect that leaves more than this of the error explains little.
const LEFT: f64 = 0.6;

/// What is chosen of the fits, and what comes near it.
pub(super) struct Choice {
    pub chosen: usize,
    pub rivals: Vec<usize>,
    /// The parameter of the chosen one that lies on its bound.
    pub on_bound: Option<String>,
    /// Effects that only more frequencies would test, with the unknowns that each brings.
    pub wants_more: Vec<(&'static str, usize)>,
}

impl Choice {
    /// Whether lists are too short to test more than one effect: then the base pays by default.
    pub(super) fn tested_too_little(&self, fits: &[ListFit]) -> bool {
        fits.len() <= 2 && self.wants_more.len() >= fits.len()
    }

    /// Whether effects that the lists are too short to test may stand behind what the chosen one does not foretell within the noise.
    pub(super) fn leaves_room(&self, chosen: &ListFit, trust: &Trust) -> bool {
        !self.wants_more.is_empty() && !trust.is_foretold_within_noise(chosen)
    }

    pub(super) fn verdict(&self, fits: &[ListFit], trust: &Trust) -> Verdict {
        let chosen = &fits[self.chosen];
        if !trust.is_met(chosen) || self.on_bound.is_some() {
            return Verdict::Unexplained;
        }
        if self.chosen == 0 {
            let is_told = trust.is_foretold(chosen) && !self.tested_too_little(fits);
            return if is_told { Verdict::NothingMissing } else { Verdict::Ambiguous };
        }
        // What foretells nothing explains nothing, though the base foretold even less.
        if !trust.is_foretold(chosen) {
            Verdict::Unexplained
        } else if !self.rivals.is_empty() || self.leaves_room(chosen, trust) {
            Verdict::Ambiguous
        } else if chosen.percent() > LEFT * fits[0].percent() {
            Verdict::Unexplained
        } else {
            Verdict::Explained
        }
    }
}
