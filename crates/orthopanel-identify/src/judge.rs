//! What is said of a test: one threshold, in odds.

use crate::measured::MeasuredModes;
use crate::model_error::Kind;
use crate::outcome::Verdict;
use crate::posterior::Judged;
use crate::stacked::Stacked;

/// Odds from which a hypothesis is clearly ahead: an effect is named at these odds against the best hypothesis without it. Very strong evidence
/// begins at 150 (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995); here sizes of model error are held where they are most probable, and evidence that
/// was worth 20 to 150 stood for false effects about as often as for right ones on made panels as real ones are (docs/decisions/inference.md).
pub(crate) const ODDS: f64 = 1000.0;
/// Odds from which a hypothesis that is ahead of nothing missing is told: positive evidence begins at 3 (Kass and Raftery, as above).
const TOLD: f64 = 3.0;
/// Largest model errors that real panels have: of the logarithm of a frequency, and of a residue along its phase.
const MOST_FREQUENCY: f64 = 1e-2;
const MOST_RESIDUE: f64 = 3e-2;
/// The same where a list does not tell its noise, which then is part of it: how well its frequencies were read.
const MOST_READ: f64 = 2e-2;

/// Largest deviation of the logarithm of a frequency from a sound model.
pub(crate) fn most_frequency(stacked: &Stacked) -> f64 {
    let measured = || stacked.blocks.iter().map(|block| block.comparison().measured);
    let are_lists = measured().all(|of| of.records.is_empty());
    let is_untold = measured().any(|of| of.covariance.norm_max() == 0.0);
    if are_lists && is_untold { MOST_READ } else { MOST_FREQUENCY }
}

/// Whether a pole towers over what all others do there, and is no mode of a hypothesis. Cords that nobody told may do so as long as they stiffen the
/// first flexible mode by no more than a model may miss, $\tfrac12(\omega/\omega_1)^2$.
pub(crate) fn has_no_mode(judged: &Judged, measured: &MeasuredModes, pole: usize) -> bool {
    let at = judged.posterior.point.at.first();
    let first = at.flexible.first().copied().unwrap_or(0.0);
    let is_alone = at.partners.first().is_some_and(|record| record[pole].is_none());
    let stiffening = 0.5 * (measured.poles[pole].angular_frequency / first).powi(2);
    is_alone && stiffening > MOST_FREQUENCY && measured.prominence(pole) > 1.0
}

/// Of hypotheses in order, the likeliest first, the simplest that is not clearly behind; the verdict; and the rivals where that is ambiguous.
pub(crate) fn judged<'a>(all: &'a [Judged], stacked: &Stacked) -> Option<(&'a Judged, Verdict, Vec<&'static str>)> {
    let best = all.first()?;
    let near = || all.iter().filter(|judged| best.log_odds - judged.log_odds < ODDS.ln());
    let chosen = near().min_by_key(|judged| judged.names().len())?;
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    let measured = stacked.first().comparison().measured;
    let misses_most = size(Kind::Frequency) > most_frequency(stacked) || size(Kind::Residue) > MOST_RESIDUE;
    if misses_most || (0..measured.poles.len()).any(|pole| has_no_mode(chosen, measured, pole)) {
        return Some((chosen, Verdict::Unexplained, vec![]));
    }
    let names = chosen.names();
    let mut rivals: Vec<&'static str> = match names.is_empty() {
        // Likelier than nothing missing, but not clearly: none is named, and nothing missing is not said either.
        true => ahead(all, chosen).flat_map(Judged::names).collect(),
        false => rivals(all, chosen).flat_map(Judged::names).collect(),
    };
    rivals.retain(|name| !names.contains(name));
    rivals.sort_unstable();
    rivals.dedup();
    let verdict = match (names.is_empty(), rivals.is_empty()) {
        (true, true) => Verdict::NothingMissing,
        (false, true) => Verdict::Explained,
        (_, false) => Verdict::Ambiguous,
    };
    Some((chosen, verdict, rivals))
}

/// The hypotheses that positive evidence puts ahead of nothing missing, the likeliest first.
pub(crate) fn ahead<'a>(all: &'a [Judged], base: &Judged) -> impl Iterator<Item = &'a Judged> {
    let from = base.log_odds + TOLD.ln();
    all.iter().take_while(move |judged| judged.log_odds > from)
}

/// The hypotheses that are not clearly behind and lack one of the chosen effects, the likeliest first.
pub(crate) fn rivals<'a>(all: &'a [Judged], chosen: &Judged) -> impl Iterator<Item = &'a Judged> {
    let best = all.first().map_or(f64::NEG_INFINITY, |judged| judged.log_odds);
    let names = chosen.names();
    let has_all = move |judged: &Judged| names.iter().all(|name| judged.names().contains(name));
    all.iter().filter(move |judged| best - judged.log_odds < ODDS.ln() && !has_all(judged))
}
