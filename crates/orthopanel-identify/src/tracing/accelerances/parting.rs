//! The further measurement that would part the hypotheses best, by the resonances that they foretell.

use orthopanel_model::Place;

use super::problem::AccelerancesFit;
use super::report::name;
use super::search::{Found, Search};
use crate::tracing::further_list::{Further, further_frequencies};

/// Masses that a tester adds, in parts of the piece's \[1\].
const ADDED: [f64; 2] = [1e-3, 1e-2];
/// Places along the piece to which the sensor may move.
const PLACES: usize = 11;
/// Differences below this many standard deviations part nothing.
const SHOWN: f64 = 2.0;

/// What to measure next, in words, with the difference that the hypotheses then show over the scatter of the resonances.
pub(super) fn next_experiment(search: &Search, found: &Found) -> String {
    let chosen = &found.fits[found.chosen];
    if found.chosen == 0 {
        return "none: no effect pays for its parameters".to_owned();
    }
    let rivals: Vec<&AccelerancesFit> = found.rivals.iter().map(|&index| &found.fits[index]).collect();
    if rivals.is_empty() {
        return "none: no other effect comes near".to_owned();
    }
    let first = name(search, chosen);
    let others = rivals.iter().map(|rival| name(search, rival)).collect::<Vec<_>>().join(", ");
    let mut best: Option<(f64, String)> = None;
    for (words, further) in proposals(search) {
        // What is nearest to the chosen one counts.
        let apart = rivals.iter().map(|rival| apart(search, [chosen, rival], further).unwrap_or(0.0));
        let apart = apart.fold(f64::INFINITY, f64::min);
        if best.as_ref().is_none_or(|(most, _)| apart > *most) {
            best = Some((apart, words));
        }
    }
    match best {
        Some((apart, words)) if apart > SHOWN => format!(
            "{words} and read the resonances again: there {first} differs from {others} by {apart:.1} times their scatter (rms)"
        ),
        _ => format!("hit at places between those of this test: {first} and {others} foretell the same resonances"),
    }
}

fn proposals(search: &Search) -> Vec<(String, Further)> {
    let sensor = search.problem.resonances.first().map(|resonance| resonance.response_at);
    let mut proposals = Vec::new();
    for part in ADDED {
        let added = part * search.piece.mass();
        proposals.push((format!("add {:.1} g at the sensor", 1e3 * added), Further { sensor, added }));
    }
    for step in 0..PLACES {
        let x = search.piece.length * (step as f64 / (PLACES - 1) as f64 - 0.5);
        let place = Place { x: (x * 1e3).round() / 1e3, y: 0.0 };
        if search.piece.contains(place).is_ok() && sensor != Some(place) {
            let further = Further { sensor: Some(place), added: 0.0 };
            proposals.push((format!("move the sensor to x = {:.3} m", place.x), further));
        }
    }
    proposals
}

/// Rms difference of the natural frequencies over their scatter.
fn apart(search: &Search, fits: [&AccelerancesFit; 2], further: Further) -> Option<f64> {
    let problem = &search.problem;
    let setting = problem.setup.setting(0)?;
    let count = problem.resonances.iter().map(|resonance| resonance.mode + 1).max()?;
    let records = problem.between.value.len();
    let [one, other] = fits.map(|fit| {
        let values = fit.state.constants.map(f64::exp);
        further_frequencies(&setting, (&fit.state.hypothesis, records), &values, further, count)
    });
    let (one, other) = (one.ok()?, other.ok()?);
    let parts = problem.resonances.iter().map(|resonance| {
        let (a, b) = (one.get(resonance.mode)?, other.get(resonance.mode)?);
        Some(((a / b - 1.0) / resonance.std).powi(2))
    });
    let square: f64 = parts.sum::<Option<f64>>()?;
    Some((square / problem.resonances.len() as f64).sqrt())
}
