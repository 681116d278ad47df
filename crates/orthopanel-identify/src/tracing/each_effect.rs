//! Every effect of the catalogue alone beside the base.

use std::sync::atomic::{AtomicUsize, Ordering};

use orthopanel_model::{Effect, catalogue};
use rayon::prelude::*;

use super::declared_starts::base_fit;
use super::elsewhere::put_elsewhere;
use super::fit::Fit;
use super::hypothesis::{PLATE, has_place};
use super::outcome::{NotTested, Progress};
use super::ranking::{LITTLE, Ranking, Search};
use super::record_problem::dearness;
use super::starts::{Costed, Look, followed_far, followed_near, followed_where_told, scored_starts};
use crate::IdentifyError;

/// The widening up to which the many starts of a closer look are followed.
const FOLLOWED_TO: usize = 1;

impl Search<'_> {
    /// Fits the base and every effect of the catalogue; where none of them meets the noise, looks closer for those that cost little.
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
        let (dear, mut quick) = self.placed().into_iter().partition::<Vec<_>, _>(|effect| dearness(effect.id()) > 1);
        let explains = |fits: &[Fit]| fits.iter().any(|fit| fit.given_up.is_none() && self.meets_noise(fit));
        // A core's or a plate's valley is long; beside a place that is too far off no valley leads to it.
        let best = fits[1..].iter().filter(|fit| fit.given_up.is_none()).min_by(|a, b| a.cost.total_cmp(&b.cost));
        let mut is_led = best.is_some_and(|best| !best.state.hypothesis.ends_with_a_place());
        if is_led {
            self.lead(&mut fits[1..]);
        }
        // One after the other, the simplest first: what explains the records leaves nothing to look for.
        quick.sort_by_key(|effect| effect.parameters().len());
        let by_poles = (&dear[..], Look::ByPoles);
        for (sought, look) in [by_poles].into_iter().chain(quick.chunks(1).map(|one| (one, Look::Closest))) {
            // More resonances than a beam has are a plate's, whichever place an effect has.
            if explains(&fits) || self.records.shows_more_than_a_beam() {
                break;
            }
            is_led &= !self.look_closer_for((sought, look), &mut fits);
        }
        // Where a closer look is to come, that may find a better one.
        if explains(&fits) || self.records.hits_differ() {
            if !is_led {
                self.lead(&mut fits[1..]);
            }
            put_elsewhere(self.records, &mut fits, self.declared());
        }
        let mut ranking = Ranking { scale: self.scale(&fits)?, fits, chosen: 0, not_tested, unfinished: false };
        self.choose(&mut ranking)?;
        Ok(ranking)
    }

    /// The undeclared effects with a place.
    fn placed(&self) -> Vec<&'static dyn Effect> {
        self.undeclared().into_iter().filter(|effect| has_place(*effect)).collect()
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

    /// Where nothing so far meets the noise, looks closer for effects with a place that cost much, then for a plate from the poles,
    /// where a beam had modes for all of them. Follows the best that there is to its minimum.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn look_closer(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        if self.meets_noise(&ranking.fits[ranking.chosen]) {
            return Ok(());
        }
        let dear: Vec<_> = self.placed().into_iter().filter(|effect| dearness(effect.id()) > 1).collect();
        let plate = self.undeclared().into_iter().filter(|effect| effect.id() == PLATE);
        let plate = if self.records.shows_more_than_a_beam() { vec![] } else { plate.collect() };
        for sought in [dear, plate] {
            self.look_closer_for((&sought, Look::Closest), &mut ranking.fits);
            self.choose(ranking)?;
            if self.meets_noise(&ranking.fits[ranking.chosen]) {
                break;
            }
        }
        self.lead(&mut ranking.fits[1..]);
        put_elsewhere(self.records, &mut ranking.fits, self.declared());
        self.choose(ranking)
    }

    /// Looks once more for some effects, from twice as many places: with a place too far off a search comes down beside the effect.
    /// Tells whether it found any that does better.
    fn look_closer_for(&self, (sought, look): (&[&'static dyn Effect], Look), fits: &mut Vec<Fit>) -> bool {
        let (begun, _) = self.begun_alone((sought, look), |starts| match look {
            Look::ByPoles => followed_near(self.records, starts, FOLLOWED_TO),
            _ => followed_far(self.records, starts, FOLLOWED_TO),
        });
        let is_new = |begun: &Costed| self.gains_on(fits, begun);
        let begun = begun.into_iter().filter(is_new).collect();
        let mut is_better = false;
        for fit in self.finish(begun, FOLLOWED_TO + 1).into_iter().filter(|fit| fit.given_up.is_none()) {
            let name = fit.state.hypothesis.name();
            match fits.iter_mut().find(|other| other.state.hypothesis.name() == name) {
                Some(other) if other.given_up.is_none() && other.cost <= fit.cost => continue,
                Some(other) => *other = fit,
                None => fits.push(fit),
            }
            is_better = true;
        }
        is_better
    }

    /// Whether a search that came down to [`FOLLOWED_TO`] did better there than the fit of the same effects that there is.
    fn gains_on(&self, fits: &[Fit], (state, cost): &Costed) -> bool {
        let name = state.hypothesis.name();
        let known = fits.iter().find(|fit| fit.given_up.is_none() && fit.state.hypothesis.name() == name);
        let problem = self.records.problem(FOLLOWED_TO);
        let before = known.and_then(|fit| problem.linearise(&problem.parameters(&fit.state), &fit.state).ok());
        before.is_none_or(|before| *cost < before.cost - LITTLE)
    }
}
