//! Which word the ranking deserves, and which effects fit about as well as the chosen ones.

use super::fit::Fit;
use super::ranking::Ranking;
use super::records_of_test::TestRecords;
use super::rough::exceeds_any_test;
use crate::IdentifyError;
use crate::outcome::Verdict;

/// A rival must stay behind by this much of the scaled criterion to be out of the question.
pub(super) const CLEAR: f64 = 100.0;
/// Misfit per datum, over that of the hits' scatter, up to which nothing need be missing.
pub(super) const MET: f64 = 1.25;
/// and up to which an effect may still be said to explain the data.
pub(super) const EXPLAINED: f64 = 2.0;

/// The verdict, and the positions of the hypotheses that fit about as well as the chosen one.
///
/// # Errors
/// What the model refuses.
pub(super) fn verdict(records: &TestRecords, ranking: &Ranking) -> Result<(Verdict, Vec<usize>), IdentifyError> {
    let chosen = &ranking.fits[ranking.chosen];
    let left = records.misfit_over_floor(chosen)?;
    if ranking.chosen == 0 {
        let is_met = left <= MET && !is_too_rough(chosen);
        let word = match (is_met, records.are_too_few()) {
            (true, false) => Verdict::NothingMissing,
            (true, true) => Verdict::Ambiguous,
            (false, _) => Verdict::Unexplained,
        };
        return Ok((word, vec![]));
    }
    let rivals = rivals(ranking);
    let is_sound = !records.are_too_few() && !ranking.unfinished && !on_bound(chosen) && !is_too_rough(chosen);
    let verdict = if left > EXPLAINED {
        Verdict::Unexplained
    } else if rivals.is_empty() && is_sound {
        Verdict::Explained
    } else {
        Verdict::Ambiguous
    };
    Ok((verdict, rivals))
}

/// Hypotheses within [`CLEAR`] of the chosen one that are not the chosen one with more effects; the likeliest first.
///
/// A `local-mass` at the sensor is a `sensor-mass`: it counts as a rival, since only its place tells them apart.
fn rivals(ranking: &Ranking) -> Vec<usize> {
    let ids = |index: usize| -> Vec<&'static str> {
        ranking.fits[index].state.hypothesis.effects.iter().map(|on| on.effect.id()).collect()
    };
    let chosen = ids(ranking.chosen);
    let limit = ranking.bic(ranking.chosen) + CLEAR;
    let contains = |index: usize| chosen.iter().all(|id| ids(index).contains(id));
    let mut rivals: Vec<usize> = (1..ranking.fits.len())
        .filter(|&index| index != ranking.chosen && !contains(index) && ranking.bic(index) < limit)
        .filter(|&index| ranking.fits[index].given_up.is_none())
        // A part of the chosen hypothesis is no rival to it: it has been found wanting.
        .filter(|&index| ids(index).iter().any(|id| !chosen.contains(id)))
        .collect();
    rivals.sort_by(|&a, &b| ranking.bic(a).total_cmp(&ranking.bic(b)));
    rivals
}

/// Whether a fit needs more roughness than a test has: then that stands for something else.
pub(super) fn is_too_rough(fit: &Fit) -> bool {
    exceeds_any_test(&fit.state.hypothesis)
}

/// Whether a parameter lies on its bound: then its number is the bound's, not the data's.
pub(super) fn on_bound(fit: &Fit) -> bool {
    let hypothesis = &fit.state.hypothesis;
    hypothesis.each_free().any(|(switched, free)| free.on_bound(switched.values[free.at]))
}
