//! A closer look for effects at a place that the usual starts missed.
//!
//! With a place too far off a search comes down beside the effect. Looking from twice as many places costs several times the usual
//! search, so one effect is looked for after the other, until one of them explains the records.

use orthopanel_model::Effect;

use super::each_effect::Count;
use super::elsewhere::put_elsewhere;
use super::fit::Fit;
use super::hypothesis::{PLATE, has_place};
use super::ranking::{LITTLE, Ranking, Search, least_cost};
use super::search_work::dearness;
use super::starts::{Costed, Look, followed_far, followed_near};
use super::verdict::{EXPLAINED, MET};
use crate::IdentifyError;

/// The widening up to which many starts are followed.
const FOLLOWED_TO: usize = 1;
/// What has come down to another minimum leaves less than this part of what a fit leaves there that is known: the known one lies at
/// the minimum of narrower lines, which on these is none.
const BETTER: f64 = 0.95;

/// Effects that are looked for together.
type Sought = (Vec<&'static dyn Effect>, Look);

impl Search<'_> {
    /// Where the chosen fit misses more than noise, looks closer for effects with a place and, where a beam had modes for all
    /// resonances, for a plate from the poles. Follows the best that there is to its minimum.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn look_closer(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        if self.explains(&ranking.fits[ranking.chosen]) {
            return Ok(());
        }
        let looks = self.looks();
        let count = Count::of(looks.iter().map(|(sought, _)| sought.len()).sum());
        for look in &looks {
            if !self.look_closer_for(look, &count, &mut ranking.fits) {
                continue;
            }
            self.lead_where_near(&mut ranking.fits);
            self.choose(ranking)?;
            if self.explains(&ranking.fits[ranking.chosen]) {
                self.others_there(ranking);
                break;
            }
        }
        self.lead(&mut ranking.fits[1..]);
        put_elsewhere(self.records, &mut ranking.fits, self.declared());
        self.choose(ranking)
    }

    /// What is looked for, in this order: what costs the least first, of that the simplest. Beside a plate what costs much is first: a core
    /// or a face moves its modes as the plate does.
    fn looks(&self) -> Vec<Sought> {
        let placed = self.placed();
        let (dear, mut quick): (Vec<_>, Vec<_>) = placed.into_iter().partition(|effect| dearness(effect.id()) > 1);
        quick.sort_by_key(|effect| effect.parameters().len());
        let by_poles = (dear.clone(), Look::ByPoles);
        let quick = quick.into_iter().map(|effect| (vec![effect], Look::Closest));
        // More resonances than a beam has are a plate's, for which the usual look has asked the poles.
        if self.records.shows_more_than_a_beam() {
            return [(dear, Look::Closest)].into_iter().chain(quick).collect();
        }
        let plate = self.undeclared().into_iter().filter(|effect| effect.id() == PLATE).collect();
        [by_poles].into_iter().chain(quick).chain([(dear, Look::Closest), (plate, Look::Closest)]).collect()
    }

    /// The undeclared effects with a place.
    fn placed(&self) -> Vec<&'static dyn Effect> {
        self.undeclared().into_iter().filter(|effect| has_place(*effect)).collect()
    }

    /// Looks for some effects. Tells whether it found any that does better than what is known of it.
    fn look_closer_for(&self, (sought, look): &Sought, count: &Count, fits: &mut Vec<Fit>) -> bool {
        let (begun, _) = self.begun_alone((sought, *look), count, |starts| match look {
            Look::Closest => followed_far(self.records, starts, FOLLOWED_TO),
            _ => followed_near(self.records, starts, FOLLOWED_TO),
        });
        let begun = begun.into_iter().filter(|begun| self.gains_on(fits, begun)).collect();
        self.taken_in(begun, fits)
    }

    /// At the place where one effect explains the records another may explain them, too: those that cost no more are fitted there.
    fn others_there(&self, ranking: &mut Ranking) {
        let chosen = &ranking.fits[ranking.chosen];
        let Some(at) = chosen.state.hypothesis.last_place() else { return };
        let Some(here) = self.left_at(FOLLOWED_TO, chosen) else { return };
        let found = chosen.state.hypothesis.effects.last().map(|on| on.effect.id());
        let there = |effect: &&dyn Effect| dearness(effect.id()) == 1 && Some(effect.id()) != found;
        let others: Vec<_> = self.placed().into_iter().filter(there).collect();
        let count = Count::of(others.len());
        let (begun, _) = self
            .begun_alone((&others, Look::At(at)), &count, |starts| followed_near(self.records, starts, FOLLOWED_TO));
        let may_be_alike = |begun: &Costed| begun.1 <= here + LITTLE && self.gains_on(&ranking.fits, begun);
        let begun = begun.into_iter().filter(may_be_alike).collect();
        self.taken_in(begun, &mut ranking.fits);
    }

    /// Fits what was begun to the end, and takes it in where it does better than what is known of the same effects. Tells whether
    /// any does.
    fn taken_in(&self, begun: Vec<Costed>, fits: &mut Vec<Fit>) -> bool {
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

    /// Follows the best of some fits to its minimum where it nearly explains the records: there it may.
    fn lead_where_near(&self, fits: &mut [Fit]) {
        let is_near = |best: &Fit| {
            !self.explains(best) && self.records.misfit_over_floor(best).is_ok_and(|left| left <= EXPLAINED)
        };
        if least_cost(&fits[1..]).is_some_and(is_near) {
            self.lead(&mut fits[1..]);
        }
    }

    /// Whether a search that came down to [`FOLLOWED_TO`] did better there than the fit of the same effects that is known, or as well
    /// where that meets the noise: then these lines do not tell.
    fn gains_on(&self, fits: &[Fit], (state, cost): &Costed) -> bool {
        let name = state.hypothesis.name();
        let known = fits.iter().find(|fit| fit.given_up.is_none() && fit.state.hypothesis.name() == name);
        let noise = MET * self.records.problem(FOLLOWED_TO).data() as f64;
        let gains = |known: f64| *cost < BETTER * known || known <= noise && *cost <= known + LITTLE;
        known.and_then(|fit| self.left_at(FOLLOWED_TO, fit)).is_none_or(gains)
    }

    /// What a fit leaves on the lines of a widening.
    fn left_at(&self, stage: usize, fit: &Fit) -> Option<f64> {
        self.records.problem(stage).at(&fit.state).ok().map(|at| at.cost)
    }
}
