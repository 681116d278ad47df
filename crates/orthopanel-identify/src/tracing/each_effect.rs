//! Every effect of the catalogue alone beside the base.

use std::sync::atomic::{AtomicUsize, Ordering};

use orthopanel_model::{Effect, catalogue};
use rayon::prelude::*;

use super::declared_starts::base_fit;
use super::elsewhere::put_elsewhere;
use super::hypothesis::{PLATE, has_place};
use super::outcome::{NotTested, Progress};
use super::ranking::{Ranking, Search};
use super::starts::{Costed, Look, followed_far, followed_where_told, scored_starts};
use crate::IdentifyError;

/// The widening up to which the many starts of a closer look are followed.
const FOLLOWED_TO: usize = 1;

impl Search<'_> {
    /// Fits the base and every effect of the catalogue.
    ///
    /// # Errors
    /// Where the base itself cannot be fitted.
    pub(super) fn each_alone(&self) -> Result<Ranking, IdentifyError> {
        let base = base_fit(self.records)?;
        let lacking = self.first_that_lacks(&base)?;
        let (begun, not_tested) = self.begun_alone((&self.undeclared(), Look::Usual), |starts| {
            followed_where_told(self.records, starts, lacking)
        });
        let mut fits = [base].into_iter().chain(self.finish(begun, 0)).collect::<Vec<_>>();
        put_elsewhere(self.records, &mut fits, self.declared());
        let mut ranking = Ranking { scale: self.scale(&fits)?, fits, chosen: 0, not_tested, unfinished: false };
        self.choose(&mut ranking)?;
        Ok(ranking)
    }

    /// The effects of the catalogue that the test file does not declare.
    pub(super) fn undeclared(&self) -> Vec<&'static dyn Effect> {
        let declared = &self.records.start.hypothesis;
        catalogue().iter().copied().filter(|effect| !declared.holds(*effect)).collect()
    }

    /// Each of these effects beside the base, `followed` from its starts on the widest lines; and those that the test cannot tell of.
    pub(super) fn begun_alone(
        &self,
        (tried, look): (&[&'static dyn Effect], Look),
        followed: impl Fn(&[Costed]) -> Option<Costed> + Sync,
    ) -> (Vec<Costed>, Vec<NotTested>) {
        let done = AtomicUsize::new(0);
        let starts: Vec<_> = tried
            .par_iter()
            .map(|effect| {
                let scored = scored_starts(self.records, &self.records.start, *effect, (&self.piece, 0), look);
                let found = scored.map(|starts| followed(&starts));
                let number = done.fetch_add(1, Ordering::Relaxed) + 1;
                (self.progress)(Progress { effect: effect.id(), done: number, of: tried.len() });
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

    /// Where nothing so far meets the noise, looks once more for effects with a place, from twice as many of these: with a place
    /// too far off a search comes down beside the effect. And for a plate from the poles, where a beam had modes for all of them.
    pub(super) fn look_closer(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        if self.meets_noise(&ranking.fits[ranking.chosen]) {
            return Ok(());
        }
        let mut placed = self.undeclared();
        let is_new = |effect: &dyn Effect| effect.id() == PLATE && !self.records.shows_more_than_a_beam();
        placed.retain(|effect| has_place(*effect) || is_new(*effect));
        let (begun, _) =
            self.begun_alone((&placed, Look::Closest), |starts| followed_far(self.records, starts, FOLLOWED_TO));
        for fit in self.finish(begun, FOLLOWED_TO + 1).into_iter().filter(|fit| fit.given_up.is_none()) {
            let name = fit.state.hypothesis.name();
            match ranking.fits.iter_mut().find(|other| other.state.hypothesis.name() == name) {
                Some(other) if other.given_up.is_none() && other.cost <= fit.cost => {}
                Some(other) => *other = fit,
                None => ranking.fits.push(fit),
            }
        }
        self.choose(ranking)
    }
}
