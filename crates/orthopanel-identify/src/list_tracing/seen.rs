//! Which effects, and which of their parameters, move the frequencies of a list at all.

use orthopanel_model::{Effect, Owner};

use super::hypothesis::{Hypothesis, Switched};
use super::list_problem::ListProblem;
use crate::IdentifyError;

/// Relative move of a frequency below which it is rounding.
const MOVED: f64 = 1e-9;
/// Points of a parameter's range, as parts of it, at which a move is looked for.
const TRIED: [f64; 4] = [0.38, 0.62, 0.76, 0.24];

/// Why no list of natural frequencies can show an effect; `None` where one can.
pub(super) fn never_shows(effect: &dyn Effect) -> Option<&'static str> {
    match effect.id() {
        "viscoelastic-core" => Some(
            "a core whose stiffness rises with frequency looks in frequencies alone like other constants; its losses show it, \
             in how damping goes from mode to mode: record hits (kind = \"time-history\" or \"accelerance\")",
        ),
        "cubic-stiffness" => Some(
            "what depends on the strength of a hit shows in records of hits of several strengths (kind = \"time-history\")",
        ),
        _ if effect.owner() == Owner::Channel => {
            Some("no natural frequency moves with what the measuring chain adds or with where hammer and sensor stand")
        }
        _ => None,
    }
}

fn why(problem: &ListProblem, effect: &dyn Effect) -> &'static str {
    let no_sensor = problem.lists.iter().all(|list| list.setting.record.response_at.is_none());
    match never_shows(effect) {
        Some(reason) => reason,
        None if effect.id() == "sensor-mass" && no_sensor => {
            "a sensor loads the panel where it sits: give its place, response_at = [x, y], in the measurement"
        }
        None => "it moves none of these frequencies",
    }
}

/// Leaves the parameters that move nothing at their values.
///
/// # Errors
/// Why an effect moves nothing at all; and what the model refuses at every value.
pub(super) fn only_seen(
    problem: &ListProblem,
    constants: &[f64],
    mut hypothesis: Hypothesis,
) -> Result<(Hypothesis, Vec<String>), IdentifyError> {
    let mut notes = Vec::new();
    for index in 0..hypothesis.effects.len() {
        let on = hypothesis.effects[index].clone();
        let unseen = |why: &str| {
            let id = on.effect.id();
            IdentifyError::Unsupported(format!(
                "effect {id:?}: nothing of it can be found from these natural frequencies: {why}; or leave the effect out"
            ))
        };
        // The chain's effects are harmless here; of the others what cannot show cannot be reckoned with either.
        if let Some(reason) = never_shows(on.effect).filter(|_| on.effect.owner() != Owner::Channel) {
            return Err(unseen(reason));
        }
        if on.free.is_empty() {
            if !shows(problem, constants, &hypothesis, index)? {
                let (id, why) = (on.effect.id(), why(problem, on.effect));
                notes.push(format!("the declared {id} has no influence on these data: {why}"));
            }
            continue;
        }
        let seen = seen(problem, constants, &hypothesis, index)?;
        if !seen.contains(&true) {
            return Err(unseen(why(problem, on.effect)));
        }
        let mut seen = seen.into_iter();
        hypothesis.effects[index].free.retain(|_| seen.next().unwrap_or(true));
        let kept = &hypothesis.effects[index].free;
        for free in on.free.iter().filter(|free| !kept.contains(free)) {
            let parameter = &on.effect.parameters()[free.at];
            notes.push(format!(
                "{} of {} does not move these frequencies: held at {:.3e} {}",
                parameter.name,
                on.effect.id(),
                on.values[free.at],
                parameter.unit
            ));
        }
    }
    Ok((hypothesis, notes))
}

/// Whether an effect at its values makes any difference.
fn shows(
    problem: &ListProblem,
    constants: &[f64],
    hypothesis: &Hypothesis,
    index: usize,
) -> Result<bool, IdentifyError> {
    if hypothesis.effects[index].effect.owner() == Owner::Channel {
        return Ok(false);
    }
    let mut without = hypothesis.clone();
    without.effects.remove(index);
    let at = |of: &Hypothesis| problem.residuals(&[constants, &of.coordinates()].concat(), of);
    let (with, without) = (at(hypothesis)?, at(&without)?);
    Ok(differ(&with, &without))
}

fn differ(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).any(|(a, b)| (a - b).abs() > MOVED)
}

/// Which free parameters of an effect move a frequency, from where it stands or from elsewhere in their ranges: from a place in the
/// middle, or at a mass of nothing, a move may do nothing.
fn seen(
    problem: &ListProblem,
    constants: &[f64],
    hypothesis: &Hypothesis,
    index: usize,
) -> Result<Vec<bool>, IdentifyError> {
    let free = hypothesis.effects[index].free.clone();
    let mut seen = vec![false; free.len()];
    if hypothesis.effects[index].effect.owner() == Owner::Channel {
        return Ok(seen);
    }
    let residuals = |on: Switched| {
        let mut at = hypothesis.clone();
        at.effects[index] = on;
        problem.residuals(&[constants, &at.coordinates()].concat(), &at)
    };
    let placed = |on: &mut Switched, which: usize, part: f64| {
        let (low, high) = free[which].bounds();
        on.values[free[which].at] = free[which].value(low + part * (high - low));
    };
    let mut starts = vec![hypothesis.effects[index].clone()];
    for turn in 0..TRIED.len() {
        let mut on = starts[0].clone();
        for which in 0..free.len() {
            placed(&mut on, which, TRIED[(turn + which) % TRIED.len()]);
        }
        starts.push(on);
    }
    let mut first_error = None;
    let mut any = false;
    for start in starts {
        let here = match residuals(start.clone()) {
            Ok(here) => here,
            Err(error) => {
                first_error = first_error.or(Some(error));
                continue;
            }
        };
        any = true;
        for which in (0..free.len()).filter(|&which| !seen[which]).collect::<Vec<_>>() {
            seen[which] = TRIED.iter().any(|&part| {
                let mut on = start.clone();
                placed(&mut on, which, part);
                residuals(on).is_ok_and(|there| differ(&here, &there))
            });
        }
        if !seen.contains(&false) {
            break;
        }
    }
    match first_error {
        Some(error) if !any => Err(error.into()),
        _ => Ok(seen),
    }
}

/// Why an undeclared effect cannot be tested, where it cannot.
pub(super) fn not_seen(
    problem: &ListProblem,
    constants: &[f64],
    declared: &Hypothesis,
    switched: Switched,
) -> Result<Result<Switched, &'static str>, IdentifyError> {
    if let Some(reason) = never_shows(switched.effect) {
        return Ok(Err(reason));
    }
    let index = declared.effects.len();
    let more = declared.and(switched);
    let seen = seen(problem, constants, &more, index)?;
    let Some(mut on) = more.effects.into_iter().next_back() else { return Ok(Err("")) };
    if !seen.contains(&true) {
        return Ok(Err(why(problem, on.effect)));
    }
    let mut each = seen.into_iter();
    on.free.retain(|_| each.next().unwrap_or(true));
    Ok(Ok(on))
}
