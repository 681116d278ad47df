//! What the fits of accelerances mean.

use orthopanel_data::ImpactTest;
use orthopanel_model::{PanelModel, Readable};

use super::parting::next_experiment;
use super::problem::AccelerancesFit;
use super::search::{Found, Search};
use crate::IdentifyError;
use crate::outcome::{Candidate, FittedError, TracedEffect, TracedError, Tracing, Verdict};
use crate::tracing::bare_panel::bare_panel;
use crate::tracing::bounds;
use crate::tracing::record_problem::total;
use crate::tracing::report::{effects_of, take_out};

/// An effect that leaves more than this of either error explains little.
const LEFT: f64 = 0.6;
/// A factor on all records that is further from one is named as an effect.
const CALIBRATED: f64 = 1.3;
/// Resonances missed by more than so many of their standard deviations, rms, lack something.
const MISSED: f64 = 3.0;
/// Of the motion between the resonances so much may be missed \[1\] where nothing is missing, or effects explain the rest: 9 % of it a real free beam's gains and
/// hammer offsets make, which are then named.
const MISSED_BETWEEN: f64 = 0.3;

/// `free_scale` says whether the last effect of the base is the factor on all records that no file declares.
pub(super) fn report(
    test: &ImpactTest,
    search: &Search,
    found: &Found,
    free_scale: bool,
) -> Result<Tracing, IdentifyError> {
    let problem = &search.problem;
    let (base, chosen) = (&found.fits[0], &found.fits[found.chosen]);
    let mut order: Vec<usize> = (0..found.fits.len()).collect();
    order.sort_by(|&a, &b| search.bic(&found.fits[a]).total_cmp(&search.bic(&found.fits[b])));
    let percent = |square: f64| 100.0 * square.sqrt();
    let error = |fit: &AccelerancesFit| -> Result<FittedError, IdentifyError> {
        Ok(FittedError { fitted: percent(fit.missed), held_out: percent(search.held_out(fit)?) })
    };
    let candidate = |&index: &usize| -> Result<Candidate, IdentifyError> {
        let fit = &found.fits[index];
        let effects = traced(fit, &deviations(search, fit)?).split_off(search.declared);
        Ok(Candidate::by_criterion(name(search, fit), search.bic(fit), percent(search.held_out(fit)?), effects))
    };
    let std = deviations(search, chosen)?;
    let mut effects = traced(chosen, &std);
    let mut panel = panel(test, search, chosen, &std)?;
    let mut removed = take_out(effects.clone(), search.declared, &mut panel);
    let mut notes = vec![said_of_frequencies(search, base, chosen)?];
    if let Some((low, high)) = problem.between.band() {
        notes.push(format!(
            "errors are those of the lines between the resonances, {low:.0} to {high:.0} Hz, over the rms of all records there"
        ));
    }
    let [without, with] = [problem.part_missed(&base.state)?, problem.part_missed(&chosen.state)?];
    notes.push(format!(
        "as one number for all these lines and places together, where the loudest weigh most, {:.1} % of the motion is missed \
         without effects and {:.1} % with them",
        Readable(100.0 * without),
        Readable(100.0 * with)
    ));
    let scale = effects.get(search.declared.saturating_sub(1)).filter(|_| free_scale);
    let on_bound = bounds::on_bound(&chosen.state.hypothesis, search.declared, &test.pieces[0].piece, &[]);
    let verdict = verdict(search, found, on_bound.is_some());
    // No sensor is off by so much: what `identify` refuses for it is told by its name, where it explains the records.
    let mut is_told = false;
    if let Some(scale) = scale {
        let value = scale.parameters.first().and_then(|parameter| parameter.values.first());
        notes.push(format!(
            "all records together are {:.3} times what mass and constants make of them: their calibration, or the mass",
            value.map_or(1.0, |value| value.value)
        ));
        let is_far = value.is_some_and(|value| value.value.ln().abs() > CALIBRATED.ln());
        is_told = is_far && verdict != Verdict::Unexplained;
        if let Some(at) = removed.iter().position(|removed| removed.id == scale.id && !is_told) {
            removed.remove(at);
        }
    }
    let floor = problem.between.noise_floor();
    notes.extend(on_bound.as_deref().map(bounds::note));
    let verdict = match verdict {
        Verdict::NothingMissing if is_told => Verdict::Explained,
        other => other,
    };
    let next_experiment = match verdict {
        Verdict::Unexplained => format!(
            "before another measurement check the places of hammer and sensor, the unit of the acceleration, the sizes, the \
             mass and the boundary: {:.1} % of the motion between the resonances is missed",
            percent(chosen.missed)
        ),
        _ => next_experiment(search, found),
    };
    Ok(Tracing {
        verdict,
        effects: effects.split_off(search.declared - usize::from(is_told)),
        alternatives: found.rivals.iter().map(|&index| name(search, &found.fits[index])).collect(),
        error: TracedError {
            measure: "misfit between the resonances, % rms of the motion of all places there".to_owned(),
            before: error(base)?,
            after: error(chosen)?,
            noise_floor: 100.0 * floor,
            independent: None,
        },
        model_error: None,
        candidates: order.iter().map(candidate).collect::<Result<_, _>>()?,
        not_tested: found.not_tested.clone(),
        next_experiment,
        chi_square: chosen.missed / floor.max(f64::MIN_POSITIVE).powi(2),
        panels: vec![panel],
        removed,
        accelerances: chosen.state.curves(&search.accelerances, &problem.setup, search.band)?,
        base_accelerances: base.state.curves(&search.accelerances, &problem.setup, search.band)?,
        notes,
    })
}

/// A fit with a number on its bound is no explanation: the bound tells that number.
fn verdict(search: &Search, found: &Found, is_on_bound: bool) -> Verdict {
    let (base, chosen) = (&found.fits[0], &found.fits[found.chosen]);
    let count = search.problem.resonances.len().max(1) as f64;
    let meets_resonances = chosen.resonances / count <= MISSED * MISSED;
    // However much better than the base: a wrong length made up for by a rotary inertia meets the resonances, and misses all between them.
    if chosen.missed > MISSED_BETWEEN * MISSED_BETWEEN {
        return Verdict::Unexplained;
    }
    if found.chosen == 0 {
        return if meets_resonances { Verdict::NothingMissing } else { Verdict::Unexplained };
    }
    if !found.rivals.is_empty() {
        return Verdict::Ambiguous;
    }
    // A wrong effect may halve what is missed of the motion, and leave the resonances where no noise puts them.
    let better = chosen.missed < LEFT * LEFT * base.missed || chosen.resonances < LEFT * LEFT * base.resonances;
    match (better && meets_resonances, is_on_bound) {
        (true, false) => Verdict::Explained,
        (true, true) => Verdict::Ambiguous,
        (false, _) => Verdict::Unexplained,
    }
}

/// The ids of the effects beyond the base.
pub(super) fn name(search: &Search, fit: &AccelerancesFit) -> String {
    fit.state.hypothesis.name_beyond(search.declared)
}

fn said_of_frequencies(
    search: &Search,
    base: &AccelerancesFit,
    chosen: &AccelerancesFit,
) -> Result<String, IdentifyError> {
    let problem = &search.problem;
    let count = problem.resonances.len().max(1) as f64;
    let rms = |errors: Vec<f64>| 100.0 * (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt();
    let spread = rms(problem.resonances.iter().map(|resonance| resonance.std).collect());
    let (before, after) = (rms(problem.frequency_errors(&base.state)?), rms(problem.frequency_errors(&chosen.state)?));
    Ok(format!(
        "{count} natural frequencies: error {before:.4} % rms without effects, {after:.4} % with them; the records' own \
         frequencies scatter by {spread:.4} %"
    ))
}

/// Standard deviation of everything that a search moved.
pub(super) fn deviations(search: &Search, fit: &AccelerancesFit) -> Result<Vec<Option<f64>>, IdentifyError> {
    let covariance = total(&search.problem.by_gap(fit)?).covariance();
    let std = |i: usize| covariance.as_ref().map(|matrix| matrix[(i, i)].sqrt()).filter(|std| std.is_finite());
    Ok((0..fit.size).map(std).collect())
}

/// All effects, those of the base first.
fn traced(fit: &AccelerancesFit, std: &[Option<f64>]) -> Vec<TracedEffect> {
    let at = fit.size - fit.state.hypothesis.size();
    effects_of(&fit.state.hypothesis, std.get(at..).unwrap_or_default())
}

fn panel(
    test: &ImpactTest,
    search: &Search,
    fit: &AccelerancesFit,
    std: &[Option<f64>],
) -> Result<PanelModel, IdentifyError> {
    let problem = &search.problem;
    let settings = (0..problem.between.value.len()).filter_map(|index| problem.setup.setting(index));
    let places = settings.map(|setting| [setting.record.force_at, setting.record.response_at]);
    let damping = (fit.state.zetas.len(), problem.usual_log_zeta);
    Ok(bare_panel((test, search.piece), (&fit.state, std), &problem.held, damping, places)?)
}
