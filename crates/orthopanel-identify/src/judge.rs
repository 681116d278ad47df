//! What is said of a test: one threshold, in odds.

use orthopanel_model::catalogue;

use crate::measured::{MeasuredModes, Pole};
use crate::model_error::Kind;
use crate::outcome::Verdict;
use crate::posterior::Judged;
use crate::stacked::Stacked;

/// Odds from which a hypothesis is clearly ahead: an effect is named at these odds against the best hypothesis without it. Very strong evidence
/// begins at 150 (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995); here sizes of model error are held where they are most probable, and evidence that
/// was worth 20 to 150 stood for false effects about as often as for right ones on made panels as real ones are (docs/decisions/inference.md).
pub(crate) const ODDS: f64 = 1000.0;
/// Odds from which a hypothesis that is ahead of nothing missing is told: positive evidence begins at 3 (Kass and Raftery, as above).
pub(crate) const TOLD: f64 = 3.0;
/// Largest model errors that real panels have: of the logarithm of a frequency, and of a residue along its phase.
const MOST_FREQUENCY: f64 = 1e-2;
pub(crate) const MOST_RESIDUE: f64 = 3e-2;
/// The same where a list does not tell its noise, which then is part of it: how well its frequencies were read.
const MOST_READ: f64 = 2e-2;

/// Largest deviation of the logarithm of a frequency from a sound model.
pub(crate) fn most_frequency(stacked: &Stacked) -> f64 {
    let measured = || stacked.blocks.iter().map(|block| block.comparison().measured);
    let are_lists = measured().all(|of| of.records.is_empty());
    let is_untold = measured().any(|of| of.covariance.norm_max() == 0.0);
    if are_lists && is_untold { MOST_READ } else { MOST_FREQUENCY }
}

/// The poles, with their pieces, that tower over what all others do there, and are no mode of a hypothesis. Cords that nobody told may do so as long as
/// they stiffen the first flexible mode by no more than a model may miss, $\tfrac12(\omega/\omega_1)^2$.
pub(crate) fn without_mode(judged: &Judged, stacked: &Stacked) -> Vec<(usize, Pole)> {
    let mut found = Vec::new();
    for (number, block) in stacked.recorded() {
        let (at, measured) = (&judged.posterior.point.at.blocks[number], block.comparison().measured);
        let first = at.flexible.first().copied().unwrap_or(0.0);
        let stands_out = |pole: &usize| {
            let is_alone = at.partners.first().is_some_and(|record| record[*pole].is_none());
            let stiffening = 0.5 * (measured.poles[*pole].angular_frequency / first).powi(2);
            is_alone && stiffening > MOST_FREQUENCY && measured.prominence(*pole) > 1.0
        };
        let poles = (0..measured.poles.len()).filter(stands_out);
        found.extend(poles.map(|pole| (block.piece, measured.poles[pole])));
    }
    found
}

/// What was measured where poles and noise do not make the records: the modes that they show may be met by a model, the rest of the records is
/// explained by none, except where the hypothesis holds what is not linear.
pub(crate) fn not_modal<'a>(judged: &Judged, stacked: &'a Stacked) -> Option<&'a MeasuredModes> {
    if judged.hypothesis.parts.iter().any(|part| part.effect.linearised().is_some()) {
        return None;
    }
    stacked.recorded().map(|(_, block)| block.comparison().measured).find(|measured| measured.is_not_modal())
}

/// Of hypotheses in order, the likeliest first, the simplest that is not clearly behind; the verdict; and where that is ambiguous the hypotheses that
/// are not clearly behind and lack one of its effects, or of nothing missing those that are ahead of it, the likeliest first.
pub(crate) fn judged<'a>(all: &'a [Judged], stacked: &Stacked) -> Option<(&'a Judged, Verdict, Vec<&'a Judged>)> {
    let best = all.first()?;
    let near = || all.iter().filter(|judged| best.log_odds - judged.log_odds < ODDS.ln());
    let chosen = near().min_by_key(|judged| judged.names().len())?;
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    let misses_most = size(Kind::Frequency) > most_frequency(stacked) || size(Kind::Residue) > MOST_RESIDUE;
    if misses_most || !without_mode(chosen, stacked).is_empty() || not_modal(chosen, stacked).is_some() {
        return Some((chosen, Verdict::Unexplained, vec![]));
    }
    let names = chosen.names();
    let has_all = |judged: &Judged| names.iter().all(|name| judged.names().contains(name));
    let (rivals, without): (Vec<&Judged>, Verdict) = if names.is_empty() {
        // Likelier than nothing missing, but not clearly: none is named, and nothing missing is not said either.
        let from = chosen.log_odds + TOLD.ln();
        (all.iter().take_while(|judged| judged.log_odds > from).collect(), Verdict::NothingMissing)
    } else {
        (near().filter(|judged| !has_all(judged)).collect(), Verdict::Explained)
    };
    let verdict = if rivals.is_empty() { without } else { Verdict::Ambiguous };
    Some((chosen, verdict, rivals))
}

/// Of an effect that lacks: one of the catalogue does, in each of so many ways alike.
pub(crate) fn log_prior(ways: usize) -> f64 {
    -((ways * catalogue().len()) as f64).ln()
}
