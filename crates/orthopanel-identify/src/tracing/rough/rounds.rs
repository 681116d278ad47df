//! Rounds of fitting hypotheses beside roughness, and of estimating how rough the test is from the best of them.

use orthopanel_model::{Effect, Piece};
use rayon::prelude::*;

use super::RoughScales;
use super::rest::RoughRest;
use crate::IdentifyError;
use crate::least_squares::Ending;
use crate::outcome::{Progress, Verdict};
use crate::tracing::each_effect::Count;
use crate::tracing::fit::{Fit, LAST, PATIENCE, covariance, polish, polished_through, settle};
use crate::tracing::ranking::{BEHIND, LITTLE, Ranking, Search};
use crate::tracing::record_problem::State;
use crate::tracing::records_of_test::TestRecords;
use crate::tracing::starts::{Costed, Look, followed};
use crate::tracing::verdict::{CLEAR, is_too_rough, verdict};
use crate::tracing::whiteness::residuals;

/// The widening at which hypotheses that are behind are left: wider ones show no roughness.
pub(super) const SIFTED: usize = 2;
/// Rounds of estimating the scales, and the change of one that is worth another round.
const ROUNDS: usize = 3;
const SETTLED: f64 = 1.2;
/// Lines of the plain beam after which no further round begins, see `tracing::ranking`: some 75 s of one processor.
pub(in crate::tracing) const MOST_WORK: u64 = 100_000_000;
/// Evaluations of a hypothesis at scales that have changed since it was fitted.
const AGAIN: Ending = Ending::far(8, 0.2);

/// A hypothesis of a round: where it begins, and how long it is followed or the widening at which it was left behind.
pub(super) struct Begun {
    state: State,
    followed: Result<Ending, usize>,
}

impl Begun {
    pub(super) fn new(state: State, left: Option<usize>) -> Self {
        Self { state, followed: left.map_or(Ok(PATIENCE[LAST]), Err) }
    }

    /// From a fit: one that was not given up is near its minimum.
    fn from_fit(fit: &Fit, left: Option<usize>) -> Self {
        let patience = if fit.given_up.is_none() { AGAIN } else { PATIENCE[LAST] };
        Self { state: fit.state.clone(), followed: left.map_or(Ok(patience), Err) }
    }
}

/// A rough test between two rounds.
pub(super) struct Rounds<'a> {
    records: &'a mut TestRecords,
    piece: Piece,
    progress: &'a (dyn Fn(Progress) + Sync),
    rest: RoughRest,
    /// What the mean of a record's hits scatters by \[m\].
    place: f64,
    /// What the best hypothesis of the last round tells of the roughness, for the next one.
    told: Option<(RoughRest, RoughScales, State)>,
}

impl<'a> Rounds<'a> {
    pub(super) fn new(
        records: &'a mut TestRecords,
        (piece, progress): (Piece, &'a (dyn Fn(Progress) + Sync)),
        (rest, place): (RoughRest, f64),
    ) -> Self {
        Self { records, piece, progress, rest, place, told: None }
    }

    /// Rounds until the scales stay and no hypothesis comes near that was behind; `None` where the base cannot be fitted.
    pub(super) fn settled(&mut self, mut states: Vec<Begun>) -> Result<Option<Ranking>, IdentifyError> {
        let most_work = self.records.work.lines() + MOST_WORK;
        let mut ranking = None;
        for round in 1..=ROUNDS {
            if let Some((rest, scales, best)) = self.told.take() {
                self.rest = rest;
                self.records.rough = Some(scales);
                self.place = self.records.align_hits(&best, (SIFTED, rest))?;
            }
            let records = &*self.records;
            let fit = |begun: Begun| match begun.followed {
                Ok(patience) => settle(records, polish(records, &begun.state, LAST, patience)?.0, None),
                Err(left) => settle(records, begun.state, Some(left)),
            };
            let fits: Vec<Fit> = states.into_par_iter().filter_map(|begun| fit(begun).ok()).collect();
            if !fits.first().is_some_and(|fit| is_base(&fit.state, records)) {
                return Ok(None);
            }
            let search = Search { records, piece: self.piece, progress: self.progress };
            let mut found =
                Ranking { scale: search.scale(&fits)?, fits, chosen: 0, not_tested: vec![], unfinished: false };
            search.choose(&mut found)?;
            let chosen = &found.fits[found.chosen];
            let unit = chosen.chi_square(records).max(1.0) / found.scale.independent;
            let scales =
                RoughScales::estimated(&chosen.state.hypothesis, &deviations(chosen, unit)).with_hits(self.place);
            let rest = self.rest.estimated(records.problem(LAST).records, &residuals(records, chosen)?);
            let is_settled = rest == self.rest && records.rough.is_some_and(|before| !before.differ(&scales, SETTLED));
            self.told = Some((rest, scales, chosen.state.clone()));
            states = near(&found);
            let is_new = |(fit, begun): (&Fit, &Begun)| fit.given_up.is_some() && begun.followed.is_ok();
            let is_settled = is_settled && !found.fits.iter().zip(&states).any(is_new);
            let is_over = records.work.lines() > most_work;
            found.unfinished = is_over && !is_settled && round < ROUNDS;
            ranking = Some(found);
            if is_settled || is_over {
                break;
            }
        }
        Ok(ranking)
    }

    /// What was fitted once more, and every effect that was left behind begun anew beside the roughness of the base: where peaks were
    /// wide, or beside another model's roughness, it may have gone astray.
    pub(super) fn revived(&mut self, ranking: &Ranking) -> Vec<Begun> {
        if let Some(base) = ranking.fits.first() {
            self.records.start = base.state.clone();
        }
        let records = &*self.records;
        let search = Search { records, piece: self.piece, progress: self.progress };
        let is_left = |fit: &&Fit| fit.given_up.is_some();
        let is_on = |fit: &Fit, effect: &dyn Effect| {
            fit.state.hypothesis.effects.iter().any(|on| on.effect.id() == effect.id())
        };
        let left = |effect: &&dyn Effect| ranking.fits.iter().filter(is_left).any(|fit| is_on(fit, *effect));
        let tried: Vec<&'static dyn Effect> = search.undeclared().into_iter().filter(left).collect();
        let (begun, _) = search.begun_alone((&tried, Look::Usual), &Count::of(tried.len()), |starts| {
            polished_through(records, followed(records, starts, 0)?, 1..=SIFTED).ok()
        });
        let anew = sifted(records, begun);
        let known = ranking.fits.iter().map(|fit| Begun::from_fit(fit, fit.given_up));
        let is_anew =
            |known: &Begun| anew.iter().any(|anew| anew.state.hypothesis.name() == known.state.hypothesis.name());
        let kept: Vec<Begun> = known.filter(|known| !is_anew(known)).collect();
        kept.into_iter().chain(anew).collect()
    }

    /// Whether more may be found than the best of a ranking: it leaves too much, or is rougher than a test by hand.
    pub(super) fn is_doubtful(&self, ranking: &Ranking) -> Result<bool, IdentifyError> {
        Ok(self.word(ranking)? == Verdict::Unexplained || is_too_rough(&ranking.fits[ranking.chosen]))
    }

    /// What the best of a ranking is worth.
    pub(super) fn word(&self, ranking: &Ranking) -> Result<Verdict, IdentifyError> {
        Ok(verdict(self.records, ranking)?.0)
    }
}

/// The base and those that may still win; and those that are behind: of what the best gains on the base, a part is missing.
pub(super) fn parted<'a>(records: &TestRecords, begun: &'a [Costed]) -> (Vec<&'a Costed>, Vec<&'a Costed>) {
    let base = begun.iter().find(|(state, _)| is_base(state, records));
    let others = begun.iter().filter(|(state, _)| !is_base(state, records));
    let least = others.map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
    let of_base = base.map_or(least, |(_, cost)| *cost);
    let limit = least + BEHIND * (of_base - least).max(0.0) + LITTLE;
    begun.iter().partition(|(state, cost)| is_base(state, records) || *cost <= limit)
}

/// The same, the base first.
pub(super) fn sifted(records: &TestRecords, begun: Vec<Costed>) -> Vec<Begun> {
    let (mut near, behind) = parted(records, &begun);
    near.sort_by_key(|(state, _)| !is_base(state, records));
    let near = near.into_iter().map(|(state, _)| Begun::new(state.clone(), None));
    near.chain(behind.into_iter().map(|(state, _)| Begun::new(state.clone(), Some(SIFTED)))).collect()
}

/// The same of a ranking: the base, and what lies or promises to lie so near to the chosen one that it may win.
fn near(ranking: &Ranking) -> Vec<Begun> {
    let limit = ranking.bic(ranking.chosen) + CLEAR;
    let begun = |(index, fit): (usize, &Fit)| {
        let is_near = index == 0 || index == ranking.chosen || ranking.bic(index) <= limit;
        Begun::from_fit(fit, (!is_near).then_some(SIFTED))
    };
    ranking.fits.iter().enumerate().map(begun).collect()
}

fn is_base(state: &State, records: &TestRecords) -> bool {
    state.hypothesis.effects.len() == records.start.hypothesis.effects.len()
}

/// Standard deviations of the coordinates of a hypothesis.
fn deviations(fit: &Fit, unit: f64) -> Vec<Option<f64>> {
    let first = fit.size - fit.state.hypothesis.size();
    let Some(covariance) = covariance(fit, unit) else { return vec![] };
    (first..fit.size).map(|i| Some(covariance[(i, i)].sqrt())).collect()
}
