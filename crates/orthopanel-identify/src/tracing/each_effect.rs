//! Every effect of the catalogue alone beside the base.

use std::sync::atomic::{AtomicUsize, Ordering};

use orthopanel_model::{Effect, catalogue};
use rayon::prelude::*;

use super::elsewhere::put_elsewhere;
use super::fit::Fit;
use super::ranking::{Ranking, Search, least_cost};
use super::starts::declared::base_fit;
use super::starts::{Costed, Look, followed_where_told, scored_starts};
use crate::IdentifyError;
use crate::outcome::{NotTested, Progress};

/// How many effects are done of those that a round of the search tries.
pub(super) struct Count {
    done: AtomicUsize,
    of: usize,
}

impl Count {
    pub(super) fn of(of: usize) -> Self {
        Self { done: AtomicUsize::new(0), of }
    }
}

impl Search<'_> {
    /// Fits the base and every effect of the catalogue, from the usual places.
    ///
    /// # Errors
    /// Where the base itself cannot be fitted.
    pub(super) fn each_alone(&self) -> Result<Ranking, IdentifyError> {
        let base = base_fit(self.records)?;
        let lacking = self.first_that_lacks(&base)?;
        let undeclared = self.undeclared();
        let count = Count::of(undeclared.len());
        let (begun, not_tested) = self.begun_alone((&undeclared, Look::Usual), &count, |starts| {
            followed_where_told(self.records, starts, lacking)
        });
        let mut fits = [base].into_iter().chain(self.finish(begun, 0)).collect::<Vec<_>>();
        let is_open = !self.records.hits_differ() && !fits.iter().any(|fit| self.explains(fit));
        // A core's or a plate's valley is long. Beside a place that is too far off no valley leads to it: there a closer look is to
        // come, which may find a better one. Nor does one where swings fall out of step, before their motion is doubted.
        let is_to_wait = |best: &Fit| is_open && best.state.hypothesis.ends_with_a_place() || self.is_undoubted(best);
        if !least_cost(&fits[1..]).is_some_and(is_to_wait) {
            self.lead(&mut fits[1..]);
        }
        if !is_open {
            put_elsewhere(self.records, &mut fits, self.declared());
        }
        let mut ranking = Ranking { scale: self.scale(&fits)?, fits, chosen: 0, not_tested, unfinished: false };
        self.choose(&mut ranking)?;
        Ok(ranking)
    }

    /// The effects of the catalogue that the test file does not declare.
    pub(super) fn undeclared(&self) -> Vec<&'static dyn Effect> {
        let declared = &self.records.start.hypothesis;
        catalogue().iter().copied().filter(|effect| !declared.holds(*effect)).collect()
    }

    /// Each of these effects beside the base, where `followed` brings it from its starts; and those that the test cannot tell of.
    pub(super) fn begun_alone(
        &self,
        (tried, look): (&[&'static dyn Effect], Look),
        count: &Count,
        followed: impl Fn(&[Costed]) -> Option<Costed> + Sync,
    ) -> (Vec<Costed>, Vec<NotTested>) {
        let starts: Vec<_> = tried
            .par_iter()
            .map(|effect| {
                let scored = scored_starts(self.records, &self.records.start, *effect, (&self.piece, 0), look);
                let found = scored.map(|starts| followed(&starts));
                let done = count.done.fetch_add(1, Ordering::Relaxed) + 1;
                (self.progress)(Progress { effect: effect.id(), done, of: count.of });
                (effect.id(), found)
            })
            .collect();
        let mut not_tested = Vec::new();
        let mut begun = Vec::new();
        for (id, found) in starts {
            match found {
                Ok(found) => begun.extend(found),
                Err(error) => not_tested.push(NotTested { id, reason: error.to_string() }),
            }
        }
        (begun, not_tested)
    }
}
