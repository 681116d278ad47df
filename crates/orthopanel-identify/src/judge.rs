//! What is said of a test: one threshold, in odds.

use crate::model_error::Kind;
use crate::posterior::Judged;

/// Odds from which a hypothesis is clearly ahead: an effect is named at these odds against the best hypothesis without it.
pub(crate) const ODDS: f64 = 20.0;
/// Largest model errors that real panels have: of the logarithm of a frequency, and of a residue along its phase.
pub(crate) const MOST_FREQUENCY: f64 = 1e-2;
const MOST_RESIDUE: f64 = 3e-2;

/// What is found of a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finding {
    /// No effect is needed.
    NothingMissing,
    /// The effects of the simplest hypothesis that is not clearly behind another: every hypothesis without them is.
    Explained,
    /// These effects have rivals that fit alike.
    Ambiguous,
    /// The model misses more than a sound model of a real panel would, and no effect of the catalogue mends that.
    Unexplained,
}

/// Of hypotheses in order, the likeliest first, the simplest that is not clearly behind; what is found; and the rivals where that is ambiguous.
pub(crate) fn judged(all: &[Judged]) -> Option<(&Judged, Finding, Vec<&'static str>)> {
    let best = all.first()?;
    let near = || all.iter().filter(|judged| best.log_odds - judged.log_odds < ODDS.ln());
    let chosen = near().min_by_key(|judged| judged.names().len())?;
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    if size(Kind::Frequency) > MOST_FREQUENCY || size(Kind::Residue) > MOST_RESIDUE {
        return Some((chosen, Finding::Unexplained, vec![]));
    }
    let names = chosen.names();
    if names.is_empty() {
        return Some((chosen, Finding::NothingMissing, vec![]));
    }
    let mut rivals: Vec<&'static str> = rivals(all, chosen).flat_map(Judged::names).collect();
    rivals.retain(|name| !names.contains(name));
    rivals.sort_unstable();
    rivals.dedup();
    let finding = if rivals.is_empty() { Finding::Explained } else { Finding::Ambiguous };
    Some((chosen, finding, rivals))
}

/// The hypotheses that are not clearly behind and lack one of the chosen effects, the likeliest first.
pub(crate) fn rivals<'a>(all: &'a [Judged], chosen: &Judged) -> impl Iterator<Item = &'a Judged> {
    let best = all.first().map_or(f64::NEG_INFINITY, |judged| judged.log_odds);
    let names = chosen.names();
    let has_all = move |judged: &Judged| names.iter().all(|name| judged.names().contains(name));
    all.iter().filter(move |judged| best - judged.log_odds < ODDS.ln() && !has_all(judged))
}
