//! The hypotheses of a search once more, each beside the roughness that a test by hand has.

use orthopanel_model::Piece;
use rayon::prelude::*;

use super::rest::RoughRest;
use super::rounds::{Begun, MOST_WORK, Rounds, SIFTED, parted, sifted};
use super::{RoughScales, none_yet};
use crate::IdentifyError;
use crate::outcome::{Progress, Verdict};
use crate::tracing::each_effect::Count;
use crate::tracing::fit::{LAST, PATIENCE, polish, polished_through};
use crate::tracing::hypothesis::Hypothesis;
use crate::tracing::ranking::{Ranking, Search};
use crate::tracing::reactions::motion_doubt::WIDE;
use crate::tracing::record_problem::State;
use crate::tracing::records_of_test::TestRecords;
use crate::tracing::starts::{Costed, Look, followed, followed_far};
use crate::tracing::verdict::{is_too_rough, on_bound};

/// Hypotheses of which one brings the hits together.
const LEADING: usize = 3;
/// What bringing hits to one place may leave of their scatter above noise: hits that differ by more differ by something else,
/// as a panel that warms up.
const LEFT: f64 = 0.3;

/// What a search that each effect went through alone becomes where roughness is allowed for, with the scales that all its
/// hypotheses share; `None` where the hits do not show any, or where even then nothing explains the records.
///
/// Each begins where [`tolerant`] lines put it: roughness moves no effect far. From the usual places first, without what
/// `tolerant` lines leave behind; where that names nothing, or nothing surely, once more from the places between and with all, which
/// costs twice as much.
pub(in crate::tracing) fn rough_search(
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
    for look in [Look::Usual, Look::Finer] {
        let (before, worked) = ((records.start.clone(), records.rough), records.work.lines());
        let found = looked_for(records, (piece, progress), plain, look);
        if let Some(mut ranking) = found {
            ranking.not_tested.clone_from(&plain.not_tested);
            return Some(ranking);
        }
        let spent = records.work.lines() - worked;
        // The plain search goes on as if nothing had been.
        (records.start, records.rough) = before;
        records.as_hit(WIDE, None);
        if spent > MOST_WORK {
            break;
        }
    }
    None
}

/// The same from starts of one look; `None` also where a model cannot be made, which is the plain search's to tell of.
fn looked_for(
    records: &mut TestRecords,
    (piece, progress): (Piece, &(dyn Fn(Progress) + Sync)),
    plain: &Ranking,
    look: Look,
) -> Option<Ranking> {
    records.as_hit(WIDE, Some(RoughRest::OF_PLAIN));
    let plain_states = plain.fits.iter().map(|fit| &fit.state);
    let states = tolerant(&Search { records, piece, progress }, plain_states, look);
    let declared = records.start.hypothesis.effects.len();
    let roughness = none_yet(&piece, records.problem(LAST).records.len());
    let rough = |state: &State| {
        let mut effects = state.hypothesis.effects.clone();
        effects.insert(declared, roughness.clone());
        State { hypothesis: Hypothesis { effects }, ..state.clone() }
    };
    let states: Vec<Costed> = states.iter().map(|(state, cost)| (rough(state), *cost)).collect();
    records.start = rough(&records.start);
    in_rounds(records, (piece, progress), states, look).ok()?
}

fn in_rounds(
    records: &mut TestRecords,
    (piece, progress): (Piece, &(dyn Fn(Progress) + Sync)),
    states: Vec<Costed>,
    look: Look,
) -> Result<Option<Ranking>, IdentifyError> {
    let rest = RoughRest::USUAL;
    records.rough = Some(RoughScales::USUAL);
    let scattered = records.hit_scatter();
    records.as_hit(SIFTED, Some(rest));
    // Hits can be brought together by a model whose resonances are where the test's are: one beside its roughness.
    let leading = polished_all(records, states.iter().take(LEADING));
    let Some((best, _)) = leading.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(None) };
    // Hits that fall beside each other tell how far their mean may be from the mark.
    let place = records.align_hits(&best, (SIFTED, rest))?;
    let left = records.problem(LAST).scatter_beside_reactions(&best)?.unwrap_or_else(|| records.hit_scatter());
    if left - 1.0 > LEFT * (scattered - 1.0) {
        return Ok(None);
    }
    records.rough = Some(RoughScales::USUAL.with_hits(place));
    let is_first = look == Look::Usual;
    let (near, behind) = if is_first { parted(records, &states) } else { (states.iter().collect(), vec![]) };
    let mut states = sifted(records, polished_all(records, near.into_iter()));
    states.extend(behind.into_iter().map(|(state, _)| Begun::new(state.clone(), Some(SIFTED))));
    let mut rounds = Rounds::new(records, (piece, progress), (rest, place));
    let Some(mut ranking) = rounds.settled(states)? else { return Ok(None) };
    if rounds.is_doubtful(&ranking)? {
        let revived = rounds.revived(&ranking);
        let Some(again) = rounds.settled(revived)? else { return Ok(None) };
        ranking = again;
    }
    ranking.prefer_the_simpler();
    let chosen = &ranking.fits[ranking.chosen];
    let is_sure = !is_first || ranking.chosen > 0 && !is_too_rough(chosen) && !on_bound(chosen);
    Ok((is_sure && rounds.word(&ranking)? != Verdict::Unexplained).then_some(ranking))
}

fn polished_all<'a>(records: &TestRecords, states: impl Iterator<Item = &'a Costed>) -> Vec<Costed> {
    let states: Vec<&Costed> = states.collect();
    states.into_par_iter().filter_map(|(state, _)| polish(records, state, SIFTED, PATIENCE[SIFTED]).ok()).collect()
}

/// The base and each effect beside it as far as lines tell that take roughness for noise, the best first: sharp peaks of a rough
/// test drag a plain fit off. Where the plain fit is better even so, that.
fn tolerant<'a>(search: &Search, plain: impl Iterator<Item = &'a State>, look: Look) -> Vec<Costed> {
    let records = search.records;
    let undeclared = search.undeclared();
    let count = Count::of(undeclared.len());
    let (begun, _) = search.begun_alone((&undeclared, look), &count, |starts| match look {
        Look::Usual => polished_through(records, followed(records, starts, 0)?, WIDE..=WIDE).ok(),
        _ => followed_far(records, starts, WIDE),
    });
    let mut fits: Vec<Costed> =
        begun.into_par_iter().filter_map(|begun| polished_through(records, begun, SIFTED..=SIFTED).ok()).collect();
    fits.extend(polished_through(records, (records.start.clone(), f64::INFINITY), 0..=SIFTED));
    let problem = records.problem(SIFTED);
    for state in plain {
        let Ok(at) = problem.at(state) else { continue };
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
