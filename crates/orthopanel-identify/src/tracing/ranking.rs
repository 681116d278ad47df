//! The search through the catalogue: every effect alone, then one more as long as it pays.

use std::sync::atomic::{AtomicUsize, Ordering};

use orthopanel_model::{Piece, catalogue};
use rayon::prelude::*;

use super::fit::{Fit, LAST, PATIENCE, fit, polish, settle};
use super::held_out::held_out;
use super::information::LikelihoodScale;
use super::outcome::{NotTested, Progress};
use super::record_problem::{Grouping, State};
use super::records_of_test::TestRecords;
use super::starts::best_start;
use super::whiteness::{independent_part, residuals};
use crate::IdentifyError;

/// Every hypothesis that was fitted, the base first.
pub(super) struct Ranking {
    pub fits: Vec<Fit>,
    /// Position of the one that is chosen.
    pub chosen: usize,
    pub not_tested: Vec<NotTested>,
    pub scale: LikelihoodScale,
}

/// By so much a criterion must fall for one more effect: odds of 20 000 to one.
pub(super) const PAYS: f64 = 20.0;
/// Effects at most.
const MOST_EFFECTS: usize = 3;
/// Single effects from which pairs are built, and partners that are fitted to the end beside each.
const ROOTS: usize = 2;
const PARTNERS: usize = 3;
/// Of what the best effect gains on the widest lines over the worst, another must gain all but this part to be followed on;
/// [`LITTLE`] is what the narrower lines may still tell apart.
const BEHIND: f64 = 0.2;
const LITTLE: f64 = 300.0;
/// A misfit per datum this near that of the hits' scatter leaves nothing for another effect.
const DONE: f64 = 1.05;

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

    /// Fits the base, every effect of the catalogue, and greedily one more.
    ///
    /// # Errors
    /// Where the base itself cannot be fitted.
    pub(super) fn run(&self) -> Result<Ranking, IdentifyError> {
        let base = fit(self.records, self.records.start.clone(), 0)?;
        let declared = &base.state.hypothesis;
        let tried: Vec<_> = catalogue().iter().filter(|effect| !declared.holds(**effect)).collect();
        let done = AtomicUsize::new(0);
        let starts: Vec<_> = tried
            .par_iter()
            .map(|effect| {
                let found = best_start(self.records, &self.records.start, **effect, &self.piece);
                let number = done.fetch_add(1, Ordering::Relaxed) + 1;
                (self.progress)(Progress { effect: effect.id(), done: number, of: tried.len() });
                (effect.id(), found)
            })
            .collect();
        let mut not_tested = Vec::new();
        let mut begun = Vec::new();
        for (id, found) in starts {
            match found {
                Ok(found) => begun.push(found),
                Err(error) => not_tested.push(NotTested { id, reason: error.to_string() }),
            }
        }
        let fits = [base].into_iter().chain(self.finish(begun)).collect::<Vec<_>>();
        let mut ranking = Ranking { scale: self.scale(&fits)?, fits, chosen: 0, not_tested };
        self.choose(&mut ranking)?;
        for _ in 1..MOST_EFFECTS {
            let before = ranking.chosen;
            if before == 0 || !self.leaves_something(&ranking) {
                break;
            }
            self.extend(&mut ranking)?;
            self.choose(&mut ranking)?;
            if ranking.chosen == before {
                break;
            }
        }
        Ok(ranking)
    }

    /// Fits to the end what is not hopelessly behind, widening by widening: the narrow lines cost the most, and few need them.
    fn finish(&self, begun: Vec<Costed>) -> Vec<Fit> {
        let (mut running, mut behind) = part(begun);
        for (stage, &patience) in PATIENCE.iter().enumerate() {
            let polished: Vec<_> =
                running.par_iter().filter_map(|(state, _)| polish(self.records, state, stage, patience).ok()).collect();
            if stage == LAST {
                running = polished;
            } else {
                let (ahead, left) = part(polished);
                running = ahead;
                behind.extend(left);
            }
        }
        let ends =
            running.into_iter().map(|(state, _)| (state, false)).chain(behind.into_iter().map(|(s, _)| (s, true)));
        let ends: Vec<(State, bool)> = ends.collect();
        ends.into_par_iter().filter_map(|(state, given_up)| settle(self.records, state, given_up).ok()).collect()
    }

    /// Whiteness and misfit of the best fit so far make the measure for all.
    fn scale(&self, fits: &[Fit]) -> Result<LikelihoodScale, IdentifyError> {
        let problem = self.records.problem(LAST);
        let best = fits.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        let Some(best) = best else { return Ok(LikelihoodScale { independent: 1.0, unit: 1.0, data: problem.data() }) };
        let independent = independent_part(&residuals(self.records, best)?);
        Ok(LikelihoodScale { independent, unit: best.chi_square(self.records).max(1.0), data: problem.data() })
    }

    fn leaves_something(&self, ranking: &Ranking) -> bool {
        let scatter = self.records.noise_floor();
        ranking.fits[ranking.chosen].chi_square(self.records) > DONE * scatter.max(1.0)
    }

    /// Moves on to the hypothesis of least criterion that pays for each of its effects, on the data and on what was held
    /// out.
    fn choose(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        ranking.scale = self.scale(&ranking.fits)?;
        let current = ranking.chosen;
        let mut order: Vec<usize> = (0..ranking.fits.len()).filter(|&index| index != current).collect();
        order.sort_by(|&a, &b| ranking.bic(a).total_cmp(&ranking.bic(b)));
        for index in order {
            if ranking.bic(current) - ranking.bic(index) < PAYS {
                break;
            }
            let grouping = ranking.grouping(self.records, index);
            let before = held_out(self.records, &ranking.fits[current], grouping)?;
            if held_out(self.records, &ranking.fits[index], grouping)? < before {
                ranking.chosen = index;
                break;
            }
        }
        Ok(())
    }

    /// Adds one more effect to the best few hypotheses of the size reached.
    fn extend(&self, ranking: &mut Ranking) -> Result<(), IdentifyError> {
        let size = ranking.fits[ranking.chosen].state.hypothesis.effects.len();
        let mut roots: Vec<usize> =
            (0..ranking.fits.len()).filter(|&i| ranking.fits[i].state.hypothesis.effects.len() == size).collect();
        roots.sort_by(|&a, &b| ranking.bic(a).total_cmp(&ranking.bic(b)));
        let base = ranking.bic(0);
        roots.retain(|&root| ranking.bic(root) < base - PAYS);
        roots.truncate(ROOTS);
        let mut more = Vec::new();
        for root in roots {
            more.extend(self.partners(&ranking.fits[root])?);
        }
        ranking.fits.extend(each_once(more));
        Ok(())
    }

    /// The root with each of the effects that promise most beside it.
    fn partners(&self, root: &Fit) -> Result<Vec<Fit>, IdentifyError> {
        let on: Vec<&str> = root.state.hypothesis.effects.iter().map(|on| on.effect.id()).collect();
        let others: Vec<_> = catalogue().iter().filter(|effect| !on.contains(&effect.id())).collect();
        let mut starts: Vec<Costed> = others
            .par_iter()
            .filter_map(|effect| best_start(self.records, &root.state, **effect, &self.piece).ok())
            .collect();
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        starts.truncate(PARTNERS);
        Ok(self.finish(starts))
    }
}

/// Of fits with the same effects, reached in another order, the best.
fn each_once(mut fits: Vec<Fit>) -> Vec<Fit> {
    let mut ids: Vec<Vec<&str>> = Vec::new();
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits.retain(|fit| {
        let mut own: Vec<&str> = fit.state.hypothesis.effects.iter().map(|on| on.effect.id()).collect();
        own.sort_unstable();
        let is_new = !ids.contains(&own);
        ids.push(own);
        is_new
    });
    fits
}

/// A hypothesis on its way, and the misfit so far.
type Costed = (State, f64);

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
        let others = (1..self.fits.len())
            .filter(|&i| i != self.chosen && !self.fits[i].state.hypothesis.name().starts_with(&chosen));
        others.min_by(|&a, &b| self.bic(a).total_cmp(&self.bic(b)))
    }

    /// Criterion of one of the fits.
    pub(super) fn bic(&self, index: usize) -> f64 {
        let fit = &self.fits[index];
        self.scale.bic(fit.cost, fit.size)
    }

    /// What is left out to judge a fit: what one record alone tells, as its gain, no other record can foretell.
    pub(super) fn grouping(&self, records: &TestRecords, index: usize) -> Grouping {
        let of_one_record = self.fits[index].state.hypothesis.effects.iter().any(|on| {
            on.effect.parameters().iter().any(|parameter| parameter.each_record || parameter.name == "record")
        });
        if of_one_record { Grouping::Hits } else { super::held_out::grouping(records) }
    }
}
