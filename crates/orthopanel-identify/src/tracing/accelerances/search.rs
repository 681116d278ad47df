//! The search through the catalogue: one more effect as long as it pays.

use std::sync::atomic::{AtomicUsize, Ordering};

use orthopanel_data::Accelerance;
use orthopanel_model::{Effect, Owner, Piece, catalogue};
use rayon::prelude::*;

use super::problem::{AccelerancesFit, AccelerancesProblem, BLUNT, LEAST};
use crate::IdentifyError;
use crate::least_squares::Ending;
use crate::outcome::{NotTested, Progress};
use crate::tracing::core_modes::CORE;
use crate::tracing::fit::promise;
use crate::tracing::held_out::predicted;
use crate::tracing::hypothesis::{PLATE, Switched};
use crate::tracing::ranking::PAYS;
use crate::tracing::record_problem::{State, total};
use crate::tracing::starts::supports::{SUPPORT, SupportStarts, support_starts};
use crate::tracing::starts::{Look, can_differ, grid};

/// Effects at most.
const MOST_EFFECTS: usize = 4;
/// A rival must stay behind by so much of the criterion to be out of the question.
pub(super) const CLEAR: f64 = 10.0;
/// Starts that are followed to their minimum.
const FOLLOWED: usize = 4;
const FOLLOW: Ending = Ending::short(15, 0.1);
const POLISH: Ending = Ending::short(60, 1e-3);
/// Times that the base is weighed anew by what it misses.
const WEIGHED: usize = 3;

/// The base with every hypothesis that was fitted beside it.
pub(super) struct Found {
    pub fits: Vec<AccelerancesFit>,
    pub chosen: usize,
    /// Hypotheses that fit about as well as the chosen one.
    pub rivals: Vec<usize>,
    pub not_tested: Vec<NotTested>,
}

pub(super) struct Search<'a> {
    pub problem: AccelerancesProblem,
    pub piece: Piece,
    /// Effects of the base: they come first in every hypothesis.
    pub declared: usize,
    pub band: f64,
    pub accelerances: Vec<Accelerance>,
    /// All resonances \[Hz\], rising.
    pub poles: Vec<f64>,
    pub progress: &'a (dyn Fn(Progress) + Sync),
}

impl Search<'_> {
    /// The base model, weighed by what it misses itself.
    ///
    /// # Errors
    /// Where it cannot be fitted.
    pub(super) fn base(&mut self, start: &State) -> Result<AccelerancesFit, IdentifyError> {
        let mut base = self.problem.fit(start, FOLLOW)?;
        for _ in 0..WEIGHED {
            self.problem.weigh_by(&base)?;
            base = self.problem.fit(&base.state, POLISH)?;
        }
        Ok(base)
    }

    /// # Errors
    /// Where the base itself cannot be fitted.
    pub(super) fn run(&mut self, start: State) -> Result<Found, IdentifyError> {
        let base = self.base(&start)?;
        let mut found = Found { fits: vec![base], chosen: 0, rivals: vec![], not_tested: vec![] };
        for round in 0..MOST_EFFECTS {
            let (first, before) = (found.fits.len(), found.chosen);
            self.extend(&mut found, round == 0);
            let Some(best) = self.best(&found, first)? else { break };
            found.chosen = best;
            let limit = self.bic(&found.fits[best]) + CLEAR;
            let near = (first..found.fits.len()).filter(|&i| i != best && self.bic(&found.fits[i]) < limit);
            let near: Vec<usize> = near.collect();
            // What stood beside an effect of an earlier round is tried beside those of this one.
            let earlier: Vec<(&'static str, &'static str)> = std::mem::replace(&mut found.rivals, near)
                .into_iter()
                .filter_map(|i| self.exchange(&found.fits[i], &found.fits[before]))
                .collect();
            self.problem.weigh_by(&found.fits[best])?;
            found.fits[best] = self.problem.fit(&found.fits[best].state, POLISH)?;
            for (id, in_place_of) in earlier {
                self.add_rival(&mut found, id, in_place_of);
            }
        }
        // The last word of the criterion, once all that comes near stands beside the same effects.
        let chosen = found.chosen;
        let likelier = found.rivals.iter_mut().filter(|rival| self.resonances_can_tell(&found.fits[**rival]));
        let likelier = likelier.min_by(|a, b| self.bic(&found.fits[**a]).total_cmp(&self.bic(&found.fits[**b])));
        if let Some(rival) = likelier.filter(|rival| self.bic(&found.fits[**rival]) < self.bic(&found.fits[chosen])) {
            found.chosen = std::mem::replace(rival, chosen);
        }
        self.leave_out(&mut found);
        Ok(found)
    }

    /// Takes out of the chosen hypothesis what no longer pays beside what was found after it.
    fn leave_out(&self, found: &mut Found) {
        loop {
            let chosen = &found.fits[found.chosen];
            let of_chosen = self.ids(chosen).len();
            let without = (0..of_chosen).filter(|_| of_chosen > 1).filter_map(|index| {
                let mut state = chosen.state.clone();
                state.hypothesis.effects.remove(self.declared + index);
                self.problem.led(&state, POLISH).ok()
            });
            let Some(least) = without.min_by(|a, b| self.bic(a).total_cmp(&self.bic(b))) else { return };
            if self.bic(&least) > self.bic(chosen) + PAYS {
                return;
            }
            found.chosen = found.fits.len();
            found.fits.push(least);
        }
    }

    /// The effect that a rival has and the one that it lacks.
    fn exchange(&self, rival: &AccelerancesFit, chosen: &AccelerancesFit) -> Option<(&'static str, &'static str)> {
        let (own, others) = (self.ids(rival), self.ids(chosen));
        let more = own.iter().find(|id| !others.contains(id))?;
        let less = others.iter().find(|id| !own.contains(id))?;
        Some((more, less))
    }

    /// Fits the chosen hypothesis with one effect in place of another, and keeps it where it comes near.
    fn add_rival(&self, found: &mut Found, id: &str, in_place_of: &str) {
        let Some(effect) = catalogue().iter().find(|effect| effect.id() == id) else { return };
        let chosen = &found.fits[found.chosen];
        if self.ids(chosen).contains(&id) {
            return;
        }
        let mut without = chosen.state.clone();
        without.hypothesis.effects.retain(|on| on.effect.id() != in_place_of);
        let Ok(rival) = self.with(&without, *effect, stood(found, id)) else { return };
        if self.bic(&rival) < self.bic(chosen) + CLEAR {
            found.rivals.push(found.fits.len());
            found.fits.push(rival);
        }
    }

    /// Ids beyond the base's.
    pub(super) fn ids(&self, fit: &AccelerancesFit) -> Vec<&'static str> {
        fit.state.hypothesis.effects.iter().skip(self.declared).map(|on| on.effect.id()).collect()
    }

    /// Adds every effect that is not on yet to the chosen hypothesis.
    fn extend(&self, found: &mut Found, told: bool) {
        let root = found.fits[found.chosen].state.clone();
        // A second one of the same effect is looked for beside a declared one only.
        let found_already = self.ids(&found.fits[found.chosen]);
        let is_on = |effect: &dyn Effect| found_already.contains(&effect.id()) || root.hypothesis.holds(effect);
        let tried: Vec<_> = catalogue().iter().filter(|effect| !is_on(**effect)).collect();
        let done = AtomicUsize::new(0);
        let fitted: Vec<_> = tried
            .par_iter()
            .filter(|effect| told || stood(found, effect.id()).is_some())
            .map(|effect| {
                let fit = self.with(&root, **effect, stood(found, effect.id()));
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                (self.progress)(Progress { effect: effect.id(), done, of: tried.len() });
                (effect.id(), fit)
            })
            .collect();
        for (id, fit) in fitted {
            match fit {
                Ok(fit) => found.fits.push(fit),
                Err(error) if told => found.not_tested.push(NotTested { id, reason: error.to_string() }),
                Err(_) => {}
            }
        }
    }

    /// A hypothesis with one more effect, from where it stood before or else from the best of its starts; a parameter that
    /// ends on its bound stays there.
    fn with(
        &self,
        root: &State,
        effect: &'static dyn Effect,
        again: Option<Switched>,
    ) -> Result<AccelerancesFit, IdentifyError> {
        let records = self.problem.between.value.len();
        can_differ(effect, records)?;
        if effect.id() == PLATE {
            let message = "width-coupling in files of accelerances (hammer records and lists of natural frequencies are \
                           tested for it), or say structure = \"mindlin-plate\"";
            return Err(IdentifyError::Unsupported(message.to_owned()));
        }
        if effect.id() == CORE {
            let message = "viscoelastic-core in files of accelerances (hammer records, kind = \"time-history\", are tested for it)";
            return Err(IdentifyError::Unsupported(message.to_owned()));
        }
        let and = |switched: Switched| State { hypothesis: root.hypothesis.and(switched), ..root.clone() };
        let states: Vec<State> = match again {
            Some(switched) => vec![and(switched)],
            None => {
                let values = grid(effect, &self.piece, (records, self.band), Look::Finer).into_iter();
                let usual = values.map(|values| {
                    let at = |name: &str| effect.parameters().iter().position(|p| p.name == name).map(|i| values[i]);
                    and(Switched::new(effect, &self.piece, records, at, |_| false))
                });
                let AccelerancesProblem { held, setup, .. } = &self.problem;
                let known = SupportStarts { poles: &self.poles, held, setup, piece: &self.piece };
                let beside = (effect.id() == SUPPORT).then(|| support_starts(known, root, effect, records));
                usual.chain(beside.and_then(Result::ok).into_iter().flatten()).collect()
            }
        };
        let scored: Vec<Result<(f64, State), IdentifyError>> = states
            .into_par_iter()
            .map(|state| {
                let at = self.problem.linearise(&self.problem.parameters(&state), &state, BLUNT[0])?;
                Ok((promise(&at), state))
            })
            .collect();
        let mut reason = None;
        let mut starts: Vec<(f64, State)> = Vec::new();
        for start in scored {
            match start {
                Ok(start) => starts.push(start),
                Err(error) => reason = reason.or(Some(error)),
            }
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<AccelerancesFit> = None;
        for (_, state) in starts.into_iter().take(FOLLOWED) {
            let Ok(mut fit) = self.problem.led(&state, FOLLOW) else { continue };
            if fit.state.hypothesis.rest_on_bounds() {
                let Ok(rested) = self.problem.fit(&fit.state.clone(), FOLLOW) else { continue };
                fit = rested;
            }
            if best.as_ref().is_none_or(|best| self.bic(&fit) < self.bic(best)) {
                best = Some(fit);
            }
        }
        best.ok_or_else(|| reason.unwrap_or_else(|| IdentifyError::Unsupported(format!("{}: no start", effect.id()))))
    }

    /// The fit from `first` on that pays most for its effect.
    ///
    /// The lines between the resonances come first, on the data and on what was held out: what they lack is a thousand
    /// times what the resonances lack. Once no effect pays there, the resonances may ask for one.
    fn best(&self, found: &Found, first: usize) -> Result<Option<usize>, IdentifyError> {
        let current = &found.fits[found.chosen];
        let by_gain = |gain: &dyn Fn(&AccelerancesFit) -> f64| {
            let paying = (first..found.fits.len()).map(|index| (gain(&found.fits[index]), index));
            let mut paying: Vec<(f64, usize)> = paying.filter(|(gain, _)| *gain >= PAYS).collect();
            paying.sort_by(|a, b| b.0.total_cmp(&a.0));
            paying.into_iter().map(|(_, index)| index)
        };
        let before = self.held_out(current)?;
        for index in by_gain(&|fit| self.of_lines(current) - self.of_lines(fit)) {
            if self.held_out(&found.fits[index])? < before {
                return Ok(Some(index));
            }
        }
        let alike = |fit: &AccelerancesFit| fit.resonances + PAYS < current.resonances && self.resonances_can_tell(fit);
        let order = by_gain(&|fit| if alike(fit) { self.bic(current) - self.bic(fit) } else { 0.0 }).next();
        Ok(order)
    }

    /// Whether more resonances were read than constants and effects of panel and rig are free.
    fn resonances_can_tell(&self, fit: &AccelerancesFit) -> bool {
        let hypothesis = &fit.state.hypothesis;
        let of_channel = hypothesis.each_free().filter(|(on, _)| on.effect.owner() == Owner::Channel).count();
        self.problem.resonances.len() > fit.size - of_channel
    }

    fn lines(&self) -> f64 {
        self.problem.weighing.independent * 2.0 * self.problem.between.count() as f64
    }

    /// $\kappa n\ln(R/n) + k\ln(m+\kappa n)$: the part of the criterion that the lines tell.
    fn of_lines(&self, fit: &AccelerancesFit) -> f64 {
        let data = self.lines() + self.problem.resonances.len() as f64;
        self.lines() * fit.missed.max(LEAST * LEAST).ln() + fit.size as f64 * data.max(1.0).ln()
    }

    /// $\sum((f_{cal}-f_{exp})/s)^2 + \kappa n\ln(R/n) + k\ln(m+\kappa n)$: the resonances' scatter is told by the records,
    /// that of the lines is not and comes from what a fit leaves of them.
    pub(super) fn bic(&self, fit: &AccelerancesFit) -> f64 {
        fit.resonances + self.of_lines(fit)
    }

    /// Mean square misfit of the lines of each gap, predicted from all other gaps and the resonances.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn held_out(&self, fit: &AccelerancesFit) -> Result<f64, IdentifyError> {
        let sums = self.problem.by_gap(fit)?;
        let whole = total(&sums);
        let Some((_, gaps)) = sums.split_last() else { return Ok(f64::NAN) };
        let neutral = vec![0.0; fit.size];
        let missed: f64 = gaps.iter().map(|gap| predicted(&whole, gap, &neutral)).sum();
        let fitted: f64 = gaps.iter().map(|gap| gap.cost).sum();
        Ok(fit.missed * missed / fitted.max(f64::MIN_POSITIVE))
    }
}

/// An effect where it stood in the latest fit that has it last.
fn stood(found: &Found, id: &str) -> Option<Switched> {
    let fit = found.fits.iter().rev().find(|fit| last(fit) == id)?;
    fit.state.hypothesis.effects.last().cloned()
}

fn last(fit: &AccelerancesFit) -> &'static str {
    fit.state.hypothesis.effects.last().map_or("", |on| on.effect.id())
}
