//! The search through the catalogue: every effect alone, then one more as long as it pays.

use orthopanel_model::{Piece, catalogue};
use rayon::prelude::*;

use super::elsewhere::put_elsewhere;
use super::fit::{Fit, LAST, PATIENCE, fit, polish, settle};
use super::held_out::held_out;
use super::hypothesis::Hypothesis;
use super::information::LikelihoodScale;
use super::record_problem::{Grouping, State};
use super::records_of_test::TestRecords;
use super::rough::{exceeds_any_test, is_roughness};
use super::starts::{Costed, Look, followed, scored_starts};
use super::valley::lead_on;
use super::verdict::{CLEAR, MET};
use super::whiteness::{independent_part, whitened};
use crate::IdentifyError;
use crate::outcome::{NotTested, Progress};

/// Every hypothesis that was fitted, the base first.
pub(super) struct Ranking {
    pub fits: Vec<Fit>,
    /// Position of the one that is chosen.
    pub chosen: usize,
    pub not_tested: Vec<NotTested>,
    pub scale: LikelihoodScale,
    /// Whether further effects were left untried, the search having cost what it may.
    pub unfinished: bool,
}

/// By so much a criterion must fall for one more effect of one parameter: odds of 20 000 to one; [`SIMPLER`] is what each
/// parameter has to pay of it.
pub(super) const PAYS: f64 = 20.0;
const SIMPLER: f64 = 10.0;
/// What was held out is foretold beyond doubt better where its misfit, squared, falls to less than this part: then a criterion need fall,
/// but not by [`PAYS`]. Where hits of unequal strength scatter by a cubic force, that scatter is the noise that the criterion knows.
const FAR_BETTER: f64 = 0.25;
/// Effects at most.
const MOST_EFFECTS: usize = 3;
/// Single effects from which pairs are built, and partners that are fitted to the end beside each.
const ROOTS: usize = 2;
const PARTNERS: usize = 3;
/// Partners that are followed from their starts, the most promising of all.
const PROMISING: usize = 6;
/// Lines of the plain beam after which no further effect is added: some 25 s of one processor. Counted rather than timed,
/// so that an answer is the same on any machine.
const MOST_WORK: u64 = 30_000_000;
/// Of what the best effect gains on the widest lines over the worst, another must gain all but this part to be followed on;
/// [`LITTLE`] is what the narrower lines may still tell apart.
pub(super) const BEHIND: f64 = 0.2;
pub(super) const LITTLE: f64 = 300.0;

/// What a search needs to know.
pub(super) struct Search<'a> {
    pub records: &'a TestRecords,
    pub piece: Piece,
    pub progress: &'a (dyn Fn(Progress) + Sync),
}

impl Search<'_> {
    /// How many effects the test file declares: they come first in every hypothesis.
    pub(super) fn declared(&self) -> usize {
        self.records.start.hypothesis.effects.len()
    }

    /// Adds greedily one more effect.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn together(&self, mut ranking: Ranking) -> Result<Ranking, IdentifyError> {
        if self.records.hits_differ() {
            self.look_closer(&mut ranking)?;
        }
        // Nothing before is taken from the pairs: a plate that is dear to find alone must not keep a gain beside it from being tried.
        self.records.work.begin_anew();
        for size in 1..MOST_EFFECTS {
            let before = ranking.chosen;
            if self.meets_noise(&ranking.fits[ranking.chosen]) {
                break;
            }
            // Where neither of two effects pays alone, both together may.
            self.extend(&mut ranking, self.declared() + size)?;
            self.choose(&mut ranking)?;
            if ranking.unfinished || (before > 0 && ranking.chosen == before) {
                break;
            }
            if ranking.chosen != before {
                self.drop_each(&mut ranking)?;
            }
        }
        ranking.prefer_the_simpler();
        Ok(ranking)
    }

    /// Fits to the end what is not hopelessly behind, widening by widening: the narrow lines cost the most, and few need them.
    pub(super) fn finish(&self, begun: Vec<Costed>, from: usize) -> Vec<Fit> {
        let (mut running, left) = part(begun);
        let mut behind: Vec<(State, usize)> = left.into_iter().map(|(state, _)| (state, from)).collect();
        for (stage, &patience) in PATIENCE.iter().enumerate().skip(from) {
            let polished: Vec<_> =
                running.par_iter().filter_map(|(state, _)| polish(self.records, state, stage, patience).ok()).collect();
            if stage == LAST {
                running = polished;
            } else {
                let (ahead, left) = part(polished);
                running = ahead;
                behind.extend(left.into_iter().map(|(state, _)| (state, stage)));
            }
        }
        let ahead = running.into_iter().map(|(state, _)| (state, None));
        let behind = behind.into_iter().map(|(state, stage)| (state, Some(stage)));
        let ends: Vec<(State, Option<usize>)> = ahead.chain(behind).collect();
        ends.into_par_iter().filter_map(|(state, given_up)| settle(self.records, state, given_up).ok()).collect()
    }

    /// Follows the best of some fits to its minimum.
    pub(super) fn lead(&self, fits: &mut [Fit]) {
        let to_the_end = fits.iter_mut().filter(|fit| fit.given_up.is_none());
        if let Some(best) = to_the_end.min_by(|a, b| a.cost.total_cmp(&b.cost)) {
            let mut led = (best.state.clone(), best.cost);
            lead_on(self.records, &mut led);
            if let Ok(led) = settle(self.records, led.0, None) {
                *best = led;
            }
        }
    }

    /// Whiteness and misfit of the best fit so far make the measure for all.
    pub(super) fn scale(&self, fits: &[Fit]) -> Result<LikelihoodScale, IdentifyError> {
        let problem = self.records.problem(LAST);
        let Some(best) = least_cost(fits) else {
            return Ok(LikelihoodScale { independent: 1.0, unit: 1.0, data: problem.data() });
        };
        let independent = independent_part(&whitened(self.records, best)?);
        Ok(LikelihoodScale { independent, unit: best.chi_square(self.records).max(1.0), data: problem.data() })
    }

    /// Whether a fit leaves nothing to explain. What a model refuses meets nothing.
    pub(super) fn meets_noise(&self, fit: &Fit) -> bool {
        self.records.misfit_over_floor(fit).is_ok_and(|left| left <= MET)
    }

    /// Whether a fit that was brought to its end does so.
    pub(super) fn explains(&self, fit: &Fit) -> bool {
        fit.given_up.is_none() && self.meets_noise(fit)
    }

    /// Moves on to the hypothesis that pays best for its effects and their parameters, on the data and on what was held out.
    pub(super) fn choose(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        ranking.scale = self.scale(&ranking.fits)?;
        let current = ranking.chosen;
        let is_too_rough: Vec<bool> = ranking.fits.iter().map(|fit| exceeds_any_test(&fit.state.hypothesis)).collect();
        // No test is so rough: whatever else meets the noise need not pay beside it, as a record's gain of 3 or 4 %.
        let makes_smooth =
            |index: usize| is_too_rough[current] && !is_too_rough[index] && self.meets_noise(&ranking.fits[index]);
        // More roughness than a test has has paid what it costs beforehand, and pays this besides.
        let price = |index: usize| ranking.price(index) + if is_too_rough[index] { CLEAR } else { 0.0 };
        let mut order: Vec<usize> = (0..ranking.fits.len())
            .filter(|&index| index != current && ranking.fits[index].given_up.is_none())
            .filter(|&index| {
                price(index) < price(current) || makes_smooth(index) || self.foretells_far_better(ranking, index)
            })
            .collect();
        order.sort_by(|&a, &b| price(a).total_cmp(&price(b)));
        let size = |index: usize| ranking.fits[index].state.hypothesis.size();
        for index in order {
            // What is simpler and pays as well need not foretell better, too; nor need what leaves no more roughness than a test has,
            // nor what pays by roughness that it spares: what all hits of a record share, as their place, none left out tells.
            let spared = ranking.beforehand(current) - ranking.beforehand(index);
            let pays_by_roughness = spared > 0.5 * (ranking.price(current) - ranking.price(index));
            let is_simpler = size(index) < size(current) || is_too_rough[current] && !is_too_rough[index];
            let grouping = ranking.grouping(self.records, index);
            let before = held_out(self.records, &ranking.fits[current], grouping)?;
            if is_simpler || pays_by_roughness || held_out(self.records, &ranking.fits[index], grouping)? < before {
                ranking.chosen = index;
                break;
            }
        }
        Ok(())
    }

    /// Where the chosen fit misses more than noise: frees what the catalogue keeps of effects unless it pays, as a sensor's moment of
    /// inertia, which else a mass beside the sensor and the hammer's places make up for. A fit that it pays for takes the other's place.
    /// Of hypotheses with `least` undeclared effects or more, as what is smaller was tried before.
    ///
    /// # Errors
    /// What the model refuses of a fit.
    pub(super) fn free_what_is_kept(&self, ranking: &mut Ranking, least: usize) -> Result<(), IdentifyError> {
        if self.meets_noise(&ranking.fits[ranking.chosen]) {
            return Ok(());
        }
        let last = ranking.fits.len();
        let mut is_changed = false;
        for index in 1..last {
            let kept = &ranking.fits[index];
            let mut state = kept.state.clone();
            if state.hypothesis.effects.len() < self.declared() + least {
                continue;
            }
            let undeclared = state.hypothesis.effects.iter_mut().skip(self.declared());
            let count = undeclared.filter_map(|on| on.free_what_is_kept(&self.piece).then_some(())).count();
            if count == 0 {
                continue;
            }
            let Ok(freed) = fit(self.records, state, 1) else { continue };
            let grouping = ranking.grouping(self.records, index);
            let foretells = held_out(self.records, &freed, grouping)? < held_out(self.records, kept, grouping)?;
            ranking.fits.push(freed);
            if foretells && ranking.price(last) < ranking.price(index) {
                ranking.fits.swap(last, index);
                is_changed = true;
            }
            ranking.fits.truncate(last);
        }
        if is_changed { self.choose(ranking) } else { Ok(()) }
    }

    /// Whether a fit is likelier than the chosen one, if by little, and foretells what is held out as no noise would let it: see
    /// [`FAR_BETTER`].
    fn foretells_far_better(&self, ranking: &Ranking, index: usize) -> bool {
        let grouping = ranking.grouping(self.records, index);
        let missed = |index: usize| held_out(self.records, &ranking.fits[index], grouping);
        ranking.bic(index) < ranking.bic(ranking.chosen)
            && matches!((missed(index), missed(ranking.chosen)), (Ok(after), Ok(before)) if after < FAR_BETTER * before)
    }

    /// Adds one more effect to the best few hypotheses of so many.
    fn extend(&self, ranking: &mut Ranking, size: usize) -> Result<(), IdentifyError> {
        let mut roots: Vec<usize> =
            (0..ranking.fits.len()).filter(|&i| ranking.fits[i].state.hypothesis.effects.len() == size).collect();
        roots.sort_by(|&a, &b| ranking.bic(a).total_cmp(&ranking.bic(b)));
        let paying = roots.iter().filter(|&&root| ranking.bic(root) < ranking.bic(0) - PAYS).count();
        roots.truncate(if ranking.chosen == 0 { ROOTS } else { paying.min(ROOTS) });
        let mut more = Vec::new();
        for root in roots {
            if self.records.work.lines() > MOST_WORK {
                ranking.unfinished = true;
                break;
            }
            more.extend(self.partners(&ranking.fits[root])?);
            // What meets the noise leaves nothing that another root could do better.
            if more.iter().any(|fit| self.explains(fit)) {
                break;
            }
        }
        put_elsewhere(self.records, &mut more, self.declared());
        ranking.fits.extend(each_once(more));
        Ok(())
    }

    /// Fits the chosen hypothesis without each of its effects: one that came in early may have stood for what a later one
    /// explains better.
    fn drop_each(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        let chosen = &ranking.fits[ranking.chosen];
        let all = &chosen.state.hypothesis.effects;
        // Without the last one it is the hypothesis from which it was reached.
        let fewer = (self.declared()..all.len().saturating_sub(1)).map(|without| {
            let mut effects = all.clone();
            effects.remove(without);
            State { hypothesis: Hypothesis { effects }, ..chosen.state.clone() }
        });
        let states: Vec<State> = fewer.collect();
        let fits: Vec<Fit> = states.into_par_iter().filter_map(|state| fit(self.records, state, 1).ok()).collect();
        let mut all = std::mem::take(&mut ranking.fits);
        let chosen = all.remove(ranking.chosen);
        let base = all.remove(0);
        all.extend(fits);
        ranking.fits = [base, chosen].into_iter().chain(each_once(all)).collect();
        ranking.chosen = 1;
        self.choose(ranking)
    }

    /// The widest lines on which a fit misses more than noise: wider ones cannot tell what it lacks.
    pub(super) fn first_that_lacks(&self, fit: &Fit) -> Result<usize, IdentifyError> {
        for stage in 0..LAST {
            let problem = self.records.problem(stage);
            let at = problem.at(&fit.state)?;
            if at.cost > MET * problem.data() as f64 {
                return Ok(stage);
            }
        }
        Ok(LAST)
    }

    /// The root with each of the effects that promise most beside it.
    fn partners(&self, root: &Fit) -> Result<Vec<Fit>, IdentifyError> {
        let stage = self.first_that_lacks(root)?;
        let on: Vec<&str> = root.state.hypothesis.effects.iter().map(|on| on.effect.id()).collect();
        let others: Vec<_> = catalogue().iter().filter(|effect| !on.contains(&effect.id())).collect();
        let mut scored: Vec<Vec<Costed>> = others
            .par_iter()
            .filter_map(|effect| {
                scored_starts(self.records, &root.state, **effect, (&self.piece, stage), Look::Usual).ok()
            })
            .collect();
        scored.sort_by(|a, b| a[0].1.total_cmp(&b[0].1));
        scored.truncate(PROMISING);
        let mut begun: Vec<Costed> =
            scored.par_iter().filter_map(|starts| followed(self.records, starts, stage)).collect();
        begun.sort_by(|a, b| a.1.total_cmp(&b.1));
        begun.truncate(PARTNERS);
        let mut fits = self.finish(begun, stage);
        self.lead(&mut fits);
        Ok(fits)
    }
}

/// The best of the fits that were brought to their end.
pub(super) fn least_cost(fits: &[Fit]) -> Option<&Fit> {
    fits.iter().filter(|fit| fit.given_up.is_none()).min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Of fits with the same effects, reached in another order, the best.
fn each_once(mut fits: Vec<Fit>) -> Vec<Fit> {
    let mut ids: Vec<Vec<&str>> = Vec::new();
    fits.sort_by(|a, b| a.given_up.is_some().cmp(&b.given_up.is_some()).then(a.cost.total_cmp(&b.cost)));
    fits.retain(|fit| {
        let mut own: Vec<&str> = fit.state.hypothesis.effects.iter().map(|on| on.effect.id()).collect();
        own.sort_unstable();
        let is_new = !ids.contains(&own);
        ids.push(own);
        is_new
    });
    fits
}

/// Those that may still win, and those that are behind.
fn part(begun: Vec<Costed>) -> (Vec<Costed>, Vec<Costed>) {
    let best = begun.iter().map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
    let worst = begun.iter().map(|(_, cost)| *cost).fold(0.0, f64::max);
    let limit = best + BEHIND * (worst - best) + LITTLE;
    begun.into_iter().partition(|(_, cost)| *cost <= limit)
}

impl Ranking {
    /// The likeliest hypothesis that is neither the base nor the chosen one with more effects.
    pub(super) fn nearest(&self) -> Option<usize> {
        let chosen = self.fits[self.chosen].state.hypothesis.name();
        let others = (1..self.fits.len()).filter(|&i| {
            i != self.chosen
                && self.fits[i].given_up.is_none()
                && !self.fits[i].state.hypothesis.name().starts_with(&chosen)
        });
        others.min_by(|&a, &b| self.bic(a).total_cmp(&self.bic(b)))
    }

    /// Names the simplest first of as many effects that the data do not part: a mass that the data put beside the sensor, at a
    /// place of its own, is the sensor's.
    pub(super) fn prefer_the_simpler(&mut self) {
        let effects = |index: usize| self.fits[index].state.hypothesis.effects.len();
        let size = |index: usize| self.fits[index].state.hypothesis.size();
        let limit = self.bic(self.chosen) + CLEAR;
        let base = self.price(0);
        let alike = (1..self.fits.len()).filter(|&index| {
            let as_many = effects(index) == effects(self.chosen) && size(index) < size(self.chosen);
            // What does not pay beside the base is no name for anything.
            as_many && self.fits[index].given_up.is_none() && self.bic(index) < limit && self.price(index) < base
        });
        let simplest = alike.min_by(|&a, &b| size(a).cmp(&size(b)).then(self.bic(a).total_cmp(&self.bic(b))));
        self.chosen = simplest.unwrap_or(self.chosen);
    }

    /// Criterion of one of the fits.
    pub(super) fn bic(&self, index: usize) -> f64 {
        let fit = &self.fits[index];
        // What is known beforehand is no line that errs with its neighbours.
        let beforehand = self.beforehand(index);
        self.scale.bic((fit.cost - beforehand).max(0.0), fit.size) + beforehand
    }

    /// What the roughness of one of the fits costs, where it has any.
    fn beforehand(&self, index: usize) -> f64 {
        let fit = &self.fits[index];
        let rough = fit.state.hypothesis.effects.iter().any(is_roughness);
        fit.places.last().filter(|_| rough).map_or(0.0, |prior| prior.cost)
    }

    /// Criterion with what each effect and each of its parameters must pay.
    fn price(&self, index: usize) -> f64 {
        let hypothesis = &self.fits[index].state.hypothesis;
        let effects = (PAYS - SIMPLER) * hypothesis.effects.len() as f64;
        self.bic(index) + effects + SIMPLER * hypothesis.size() as f64
    }

    /// What is left out to judge a fit: what one record alone tells, as its gain, no other record can foretell.
    pub(super) fn grouping(&self, records: &TestRecords, index: usize) -> Grouping {
        let of_one_record = self.fits[index].state.hypothesis.effects.iter().filter(|on| !is_roughness(on)).any(|on| {
            on.effect.parameters().iter().any(|parameter| parameter.each_record || parameter.name == "record")
        });
        if of_one_record { Grouping::Hits } else { super::held_out::grouping(records) }
    }
}
