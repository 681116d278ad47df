//! The hypotheses of a search once more, each beside the roughness that a test by hand has.

use std::sync::atomic::Ordering;

use orthopanel_model::Piece;
use rayon::prelude::*;

use super::fit::{Fit, LAST, PATIENCE, covariance, polish, polished_through, settle};
use super::hypothesis::Hypothesis;
use super::outcome::{Progress, Verdict};
use super::ranking::{BEHIND, LITTLE, Ranking, Search};
use super::record_problem::State;
use super::records_of_test::TestRecords;
use super::rough_rest::RoughRest;
use super::roughness::{RoughScales, none_yet};
use super::starts::{Costed, Look, followed_far};
use super::verdict::{CLEAR, verdict};
use super::whiteness::residuals;
use crate::IdentifyError;
use crate::least_squares::Ending;

/// The widest peaks but one: up to here a line's tolerance is beyond any roughness.
const WIDE: usize = 1;
/// Hypotheses of which one brings the hits together.
const LEADING: usize = 3;
/// The widening at which hypotheses that are behind are left: wider ones show no roughness.
const SIFTED: usize = 2;
/// What bringing hits to one place may leave of their scatter above noise: hits that differ by more differ by something else,
/// as a panel that warms up.
const LEFT: f64 = 0.3;
/// Rounds of estimating the scales, and the change of one that is worth another round.
const ROUNDS: usize = 3;
const SETTLED: f64 = 1.2;
/// Lines of the plain beam after which no further round begins, see [`super::ranking`]: some 75 s of one processor.
const MOST_WORK: u64 = 100_000_000;
/// Evaluations of each hypothesis at scales that have changed.
const AGAIN: Ending = Ending::far(8, 0.2);

/// What a search that each effect went through alone becomes where roughness is allowed for, with the scales that all its
/// hypotheses share; `None` where the hits do not show any, or where even then nothing explains the records.
///
/// Each begins where [`tolerant`] lines put it: roughness moves no effect far.
pub(super) fn rough_search(
    records: &mut TestRecords,
    piece: Piece,
    progress: &(dyn Fn(Progress) + Sync),
    plain: &Ranking,
) -> Option<Ranking> {
    let best = &plain.fits[plain.chosen];
    let is_met = Search { records, piece, progress }.meets_noise(best);
    if is_met || !records.hits_differ() {
        return None;
    }
    let before = (records.start.clone(), records.rough, records.work.load(Ordering::Relaxed));
    records.as_hit(WIDE, Some(RoughRest::OF_PLAIN));
    let plain_states = plain.fits.iter().map(|fit| &fit.state);
    let states = tolerant(&Search { records, piece, progress }, plain_states);
    let declared = records.start.hypothesis.effects.len();
    let roughness = none_yet(&piece, records.problem(LAST).records.len());
    let rough = |state: &State| {
        let mut effects = state.hypothesis.effects.clone();
        effects.insert(declared, roughness.clone());
        State { hypothesis: Hypothesis { effects }, ..state.clone() }
    };
    let states: Vec<State> = states.iter().map(|(state, _)| rough(state)).collect();
    records.start = rough(&records.start);
    // A model that cannot be made is the plain search's to tell of.
    if let Ok(Some(mut ranking)) = followed(records, (piece, progress), states) {
        ranking.not_tested.clone_from(&plain.not_tested);
        return Some(ranking);
    }
    // The plain search goes on as if nothing had been.
    let work;
    (records.start, records.rough, work) = before;
    records.work.store(work, Ordering::Relaxed);
    records.as_hit(WIDE, None);
    None
}

fn followed(
    records: &mut TestRecords,
    (piece, progress): (Piece, &(dyn Fn(Progress) + Sync)),
    states: Vec<State>,
) -> Result<Option<Ranking>, IdentifyError> {
    let mut rest = RoughRest::USUAL;
    records.rough = Some(RoughScales::USUAL);
    let scattered = records.hit_scatter();
    records.as_hit(SIFTED, Some(rest));
    // Hits can be brought together by a model whose resonances are where the test's are: one beside its roughness.
    let leading = polished_all(records, &states[..states.len().min(LEADING)]);
    let Some((best, _)) = leading.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(None) };
    // Hits that fall beside each other tell how far their mean may be from the mark.
    let mut place = records.align_hits(&best, (SIFTED, rest))?;
    let left = records.problem(LAST).scatter_beside_reactions(&best)?.unwrap_or_else(|| records.hit_scatter());
    if left - 1.0 > LEFT * (scattered - 1.0) {
        return Ok(None);
    }
    records.rough = Some(RoughScales::USUAL.with_hits(place));
    let mut states = sifted(records, polished_all(records, &states));
    let mut patience = PATIENCE[LAST];
    let mut ranking = None;
    for round in 1..=ROUNDS {
        let followed = |(state, left): (State, Option<usize>)| match left {
            None => settle(records, polish(records, &state, LAST, patience)?.0, None),
            Some(_) => settle(records, state, left),
        };
        let fits: Vec<Fit> = states.into_par_iter().filter_map(|state| followed(state).ok()).collect();
        if !fits.first().is_some_and(|fit| is_base(&fit.state, records)) {
            return Ok(None);
        }
        let search = Search { records, piece, progress };
        let mut found = Ranking { scale: search.scale(&fits)?, fits, chosen: 0, not_tested: vec![], unfinished: false };
        search.choose(&mut found)?;
        let chosen = &found.fits[found.chosen];
        let unit = chosen.chi_square(records).max(1.0) / found.scale.independent;
        let scales = RoughScales::estimated(&chosen.state.hypothesis, &deviations(chosen, unit)).with_hits(place);
        let left = rest.estimated(records.problem(LAST).records, &residuals(records, chosen)?);
        let settled = left == rest && records.rough.is_some_and(|before| !before.differ(&scales, SETTLED));
        let best = chosen.state.clone();
        states = near(&found);
        let is_new = found.fits.iter().zip(&states).any(|(fit, (_, left))| fit.given_up.is_some() && left.is_none());
        let is_settled = settled && !is_new;
        let is_over = records.work.load(Ordering::Relaxed) > MOST_WORK;
        found.unfinished = is_over && !is_settled && round < ROUNDS;
        ranking = Some(found);
        if is_settled || is_over || round == ROUNDS {
            break;
        }
        rest = left;
        records.rough = Some(scales);
        place = records.align_hits(&best, (SIFTED, rest))?;
        patience = AGAIN;
    }
    let Some(mut ranking) = ranking else { return Ok(None) };
    ranking.prefer_the_simpler();
    let (word, _) = verdict(records, &ranking)?;
    Ok((word != Verdict::Unexplained).then_some(ranking))
}

fn polished_all(records: &TestRecords, states: &[State]) -> Vec<Costed> {
    states.par_iter().filter_map(|state| polish(records, state, SIFTED, PATIENCE[SIFTED]).ok()).collect()
}

/// The base and each effect beside it as far as lines tell that take roughness for noise, the best first: sharp peaks of a rough
/// test drag a plain fit off. Where the plain fit is better even so, that.
fn tolerant<'a>(search: &Search, plain: impl Iterator<Item = &'a State>) -> Vec<Costed> {
    let records = search.records;
    let (begun, _) =
        search.begun_alone((&search.undeclared(), Look::Finer), |starts| followed_far(records, starts, WIDE));
    let mut fits: Vec<Costed> =
        begun.into_par_iter().filter_map(|begun| polished_through(records, begun, SIFTED..=SIFTED).ok()).collect();
    fits.extend(polished_through(records, (records.start.clone(), f64::INFINITY), 0..=SIFTED));
    let problem = records.problem(SIFTED);
    for state in plain {
        let Ok(at) = problem.linearise(&problem.parameters(state), state) else { continue };
        let name = state.hypothesis.name();
        match fits.iter_mut().find(|(fit, _)| fit.hypothesis.name() == name) {
            Some(fit) if at.cost < fit.1 => *fit = (state.clone(), at.cost),
            Some(_) => {}
            None => fits.push((state.clone(), at.cost)),
        }
    }
    fits.sort_by(|a, b| a.1.total_cmp(&b.1));
    fits
}

/// The base first, then those that may still win, with none; and those that are behind, with the widening where they are left:
/// of what the best gains on the base, a part is missing.
fn sifted(records: &TestRecords, begun: Vec<Costed>) -> Vec<(State, Option<usize>)> {
    let (base, others): (Vec<_>, Vec<_>) = begun.into_iter().partition(|(state, _)| is_base(state, records));
    let least = others.iter().map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
    let of_base = base.first().map_or(least, |(_, cost)| *cost);
    let limit = least + BEHIND * (of_base - least).max(0.0) + LITTLE;
    let others = others.into_iter().map(|(state, cost)| (state, (cost > limit).then_some(SIFTED)));
    base.into_iter().map(|(state, _)| (state, None)).chain(others).collect()
}

/// The same of a ranking: the base, and what lies or promises to lie so near to the chosen one that it may win.
fn near(ranking: &Ranking) -> Vec<(State, Option<usize>)> {
    let limit = ranking.bic(ranking.chosen) + CLEAR;
    let fits = ranking.fits.iter().enumerate();
    let left = |index: usize| (index > 0 && index != ranking.chosen && ranking.bic(index) > limit).then_some(SIFTED);
    fits.map(|(index, fit)| (fit.state.clone(), left(index))).collect()
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
