//! What is said of a test: one threshold, in odds.

use crate::model_error::Kind;
use crate::outcome::Verdict;
use crate::posterior::Judged;

/// Odds from which a hypothesis is clearly ahead: an effect is named at these odds against the best hypothesis without it. Very strong evidence
/// begins at 150 (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995); here sizes of model error are held where they are most probable, and evidence that
/// was worth 20 to 150 stood for false effects about as often as for right ones on made panels as real ones are (docs/decisions/inference.md).
pub(crate) const ODDS: f64 = 1000.0;
/// Largest model errors that real panels have: of the logarithm of a frequency, and of a residue along its phase.
pub(crate) const MOST_FREQUENCY: f64 = 1e-2;
const MOST_RESIDUE: f64 = 3e-2;

/// Of hypotheses in order, the likeliest first, the simplest that is not clearly behind; the verdict; and the rivals where that is ambiguous.
pub(crate) fn judged(all: &[Judged]) -> Option<(&Judged, Verdict, Vec<&'static str>)> {
    let best = all.first()?;
    let near = || all.iter().filter(|judged| best.log_odds - judged.log_odds < ODDS.ln());
    let chosen = near().min_by_key(|judged| judged.names().len())?;
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    if size(Kind::Frequency) > MOST_FREQUENCY || size(Kind::Residue) > MOST_RESIDUE {
        return Some((chosen, Verdict::Unexplained, vec![]));
    }
    let names = chosen.names();
    if names.is_empty() {
        return Some((chosen, Verdict::NothingMissing, vec![]));
    }
    let mut rivals: Vec<&'static str> = rivals(all, chosen).flat_map(Judged::names).collect();
    rivals.retain(|name| !names.contains(name));
    rivals.sort_unstable();
    rivals.dedup();
    let verdict = if rivals.is_empty() { Verdict::Explained } else { Verdict::Ambiguous };
    Some((chosen, verdict, rivals))
}

/// The hypotheses that are not clearly behind and lack one of the chosen effects, the likeliest first.
pub(crate) fn rivals<'a>(all: &'a [Judged], chosen: &Judged) -> impl Iterator<Item = &'a Judged> {
    let best = all.first().map_or(f64::NEG_INFINITY, |judged| judged.log_odds);
    let names = chosen.names();
    let has_all = move |judged: &Judged| names.iter().all(|name| judged.names().contains(name));
    all.iter().filter(move |judged| best - judged.log_odds < ODDS.ln() && !has_all(judged))
}
