//! The further list that would part two hypotheses best.

use orthopanel_model::{ModelError, Place};

use super::across;
use super::further_list::{Further, further_frequencies};
use super::list_fit::ListFit;
use super::list_problem::{FrequencyList, ListProblem};
use super::report::{name, rms};

/// Masses that a tester adds, in parts of the piece's \[1\].
const ADDED: [f64; 3] = [0.05, 0.1, 0.2];
/// Places along the piece to which the sensor may move.
const PLACES: usize = 11;
/// Differences below this many times the scatter part nothing.
const SHOWN: f64 = 2.0;
/// Modes that a further list is taken to hold beyond those of the first.
const MORE: usize = 1;

/// What to measure next, in words, with the difference that the hypotheses then show over the scatter.
pub(super) fn next_experiment(
    problem: &ListProblem,
    fits: &[ListFit],
    chosen: usize,
    rivals: &[usize],
    order: &[usize],
) -> String {
    if chosen == 0 {
        return "none: the base model meets the frequencies as well as any effect does".to_owned();
    }
    let nearest = order.iter().copied().find(|&index| index != chosen && index != 0);
    let others: Vec<&ListFit> = match rivals {
        [] => nearest.iter().map(|&index| &fits[index]).collect(),
        rivals => rivals.iter().map(|&index| &fits[index]).collect(),
    };
    let Some((list, one)) = problem.lists.iter().max_by_key(|list| list.measured.len()).zip(fits.get(chosen)) else {
        return String::new();
    };
    let first = name(one, false, 0);
    let second = others.iter().map(|other| name(other, false, 0)).collect::<Vec<_>>().join(", ");
    if let Some(plate) = one.plate.as_ref().or_else(|| others.iter().find_map(|other| other.plate.as_ref())) {
        let beams = if one.plate.is_some() { second } else { first };
        return across::words(problem, plate, &beams);
    }
    let mut best: Option<(f64, String)> = None;
    let mut try_out = |words: String, place: Option<Place>, added: f64| {
        // What is nearest to the chosen one counts.
        let each = others.iter().map(|other| apart(problem, list, (one, other), place, added).unwrap_or(0.0));
        let apart = each.fold(f64::INFINITY, f64::min);
        if apart.is_finite() && best.as_ref().is_none_or(|(most, _)| apart > *most) {
            best = Some((apart, words));
        }
    };
    let (piece, sensor) = (&list.setting.piece, list.setting.record.response_at);
    let places = (0..PLACES)
        .map(|step| piece.length * (step as f64 / (PLACES - 1) as f64 - 0.5))
        .map(|x| Place { x: (x * 1e3).round() / 1e3, y: 0.0 })
        .filter(|place| piece.contains(*place).is_ok());
    let masses = ADDED.map(|part| part * piece.mass());
    if sensor.is_some() {
        for added in masses {
            try_out(format!("add {:.1} g at the sensor", 1e3 * added), sensor, added);
        }
        for place in places {
            try_out(format!("move the sensor to x = {:.3} m", place.x), Some(place), 0.0);
        }
        try_out("listen without a sensor (microphone, laser)".to_owned(), None, 0.0);
    } else {
        for place in places {
            for added in masses {
                try_out(format!("fix {:.1} g at x = {:.3} m", 1e3 * added, place.x), Some(place), added);
            }
        }
    }
    match best {
        Some((apart, words)) if apart > SHOWN => format!(
            "{words} and read the first {} frequencies again: there {first} differs from {second} by {apart:.1} times the scatter (rms)",
            list.measured.len() + MORE
        ),
        _ => format!(
            "hit the piece at several places and record it (kind = \"time-history\"): its shapes tell what frequencies do not; no added \
             mass parts the frequencies of {first} and {second} by {SHOWN} times their scatter or more"
        ),
    }
}

/// Rms relative difference of the frequencies of two hypotheses, over the scatter of the chosen one.
fn apart(
    problem: &ListProblem,
    list: &FrequencyList,
    (one, other): (&ListFit, &ListFit),
    place: Option<Place>,
    added: f64,
) -> Result<f64, ModelError> {
    let count = list.measured.len() + MORE;
    let frequencies = |fit: &ListFit| {
        let free = fit.parameters.get(..problem.constants.count()).unwrap_or_default();
        let values = problem.constants.values(free, list.piece);
        further_frequencies(&list.setting, &fit.hypothesis, &values, Further { sensor: place, added }, count)
    };
    let (first, second) = (frequencies(one)?, frequencies(other)?);
    let square: f64 = first.iter().zip(&second).map(|(a, b)| (a / b - 1.0).powi(2)).sum();
    let noise = problem.noise().map_or(0.0, |noise| rms(&noise));
    Ok((square / count as f64).sqrt() / one.scatter().max(noise).max(f64::MIN_POSITIVE))
}
