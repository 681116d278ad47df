//! From the ranking to what is said.

use faer::Mat;
use num_complex::Complex64;
use orthopanel_data::ImpactTest;
use orthopanel_model::{Estimate, Owner, PanelModel};

use super::bare_panel::bare_panel;
use super::bounds::notes_on_bound;
use super::declared_doubt::{Doubt, doubtful_numbers};
use super::error_clusters::clustered_spread;
use super::fit::{Fit, LAST, covariance};
use super::held_out::held_out;
use super::hypothesis::{Hypothesis, PLATE, Switched, WINDOW};
use super::model_error::{of_amplitude, spread_of_gradient};
use super::next_experiment::next_experiment;
use super::ranking::{Ranking, Search};
use super::record_problem::Grouping;
use super::records_of_test::TestRecords;
use super::rough::ROUGHNESS;
use super::verdict::{is_too_rough, verdict};
use super::whiteness::{independent_lines, whitened};
use super::widened_lines::{WIDENINGS, WidenedLines};
use crate::IdentifyError;
use crate::outcome::{
    Candidate, FittedError, IndependentLines, Removed, TracedEffect, TracedError, TracedParameter, Tracing, Verdict,
};
use crate::to_check::GAIN_OR_MASS;

const MEASURE: &str = "misfit of the accelerances over the noise of the hits, rms over all lines (1: noise alone)";

const UNFINISHED: &str = "the search ended at the work that it may cost before all further effects were tried: what is \
                          named fits, but has not been compared with all that might fit better";
const UNFINISHED_UNEXPLAINED: &str = "the search ended at the work that it may cost before all further effects were tried: one of \
                                      those may explain what these do not";

/// Less of the independent lines that noise has is no white residual: twelve effects of the catalogue leave within 15 % of noise's.
const COLOURED: f64 = 0.7;

const TOO_ROUGH: &str =
    "what is named leaves more roughness than a test by hand has: it may not be all that is missing";

const TOO_FEW: &str = "one hit at each of fewer than three pairs of places: nothing can be left out to judge by, and what hits scatter \
                       by is taken to be 0.1 % of the motion. Hit each place three times, or hit three places";

/// Says what a ranking of hypotheses over records means.
///
/// # Errors
/// What the model refuses.
pub(super) fn report(test: &ImpactTest, search: &Search, ranking: &Ranking) -> Result<Tracing, IdentifyError> {
    let records = search.records;
    let (word, rivals) = verdict(records, ranking)?;
    let is_unexplained = word == Verdict::Unexplained;
    // Where nothing is missing beside what is declared, its numbers are right.
    let mut doubts = if ranking.chosen > 0 || is_unexplained { doubtful_numbers(search, ranking)? } else { vec![] };
    doubts.retain(|doubt| doubt.is_rival || is_unexplained);
    let verdict = if doubts.is_empty() || is_unexplained { word } else { Verdict::Ambiguous };
    let chosen = &ranking.fits[ranking.chosen];
    let grouping = ranking.grouping(records, ranking.chosen);
    let error = |fit: &Fit, grouping: Grouping| -> Result<FittedError, IdentifyError> {
        Ok(FittedError { fitted: fit.chi_square(records).sqrt(), held_out: held_out(records, fit, grouping)?.sqrt() })
    };
    let mut order: Vec<usize> = (0..ranking.fits.len()).collect();
    order.sort_by(|&a, &b| ranking.bic(a).total_cmp(&ranking.bic(b)));
    let candidates = order.iter().map(|&index| {
        let fit = &ranking.fits[index];
        let std = deviations(search, ranking, fit)?;
        let held_out = held_out(records, fit, ranking.grouping(records, index))?.sqrt();
        let effects = traced(fit, &std, search.declared());
        Ok(Candidate {
            left_behind: fit.given_up.map(|stage| WIDENINGS[stage].decay_rate),
            ..Candidate::by_criterion(name(fit, search.declared()), ranking.bic(index), held_out, effects)
        })
    });
    let candidates = candidates.collect::<Result<Vec<_>, IdentifyError>>()?;
    let std = deviations(search, ranking, chosen)?;
    let mut panel = panel(test, search, chosen, &std)?;
    let removed = take_out(traced(chosen, &std, 0), search.declared(), &mut panel);
    let independent = independent(records, [&ranking.fits[0], chosen])?;
    let mut notes = notes(search, ranking, verdict);
    notes.extend(doubts.iter().map(|doubt| doubt.sentence.clone()));
    if !is_unexplained && independent.after < COLOURED * independent.noise {
        notes.push(not_white(&independent));
    }
    Ok(Tracing {
        verdict,
        effects: traced(chosen, &std, search.declared()),
        alternatives: doubts
            .iter()
            .filter(|_| !is_unexplained)
            .map(|doubt| doubt.id.to_owned())
            .chain(rivals.iter().map(|&index| name(&ranking.fits[index], search.declared())))
            .collect(),
        error: TracedError {
            measure: MEASURE.to_owned(),
            before: error(&ranking.fits[0], grouping)?,
            after: error(chosen, grouping)?,
            noise_floor: records.noise_floor(chosen)?.sqrt(),
            independent: Some(independent),
        },
        model_error: None,
        candidates,
        not_tested: ranking.not_tested.clone(),
        next_experiment: match doubts.first() {
            Some(doubt) if !is_unexplained => check_first(doubt),
            _ => next_experiment(test, search, ranking, verdict, &rivals),
        },
        chi_square: chosen.chi_square(records),
        panels: vec![panel],
        removed,
        accelerances: records.curves(chosen)?,
        base_accelerances: records.curves(&ranking.fits[0])?,
        notes,
    })
}

/// Weighing what is declared costs less than any hit, and no hit parts it from an effect of the panel that undoes it.
fn check_first(doubt: &Doubt) -> String {
    format!("weigh or measure what the test file declares, before any further hit: {}", doubt.sentence)
}

fn not_white(independent: &IndependentLines) -> String {
    format!(
        "what is left is small, but not white ({:.0} % independent lines, {:.0} % of noise): something small may still be missing",
        100.0 * independent.after,
        100.0 * independent.noise
    )
}

/// How white what the base and the chosen fit leave is. A window left on in the recorder fades the noise too.
fn independent(records: &TestRecords, [base, chosen]: [&Fit; 2]) -> Result<IndependentLines, IdentifyError> {
    let windows = chosen.state.hypothesis.effects.iter().filter(|on| on.effect.id() == WINDOW);
    let fading: f64 = windows.filter_map(|on| on.values.first()).map(|tau| tau.recip()).sum();
    let faded = |record: &WidenedLines| record.s.iter().map(|s| s + fading).collect();
    let lines: Vec<Vec<Complex64>> = records.problem(LAST).records.iter().map(faded).collect();
    Ok(independent_lines(&whitened(records, base)?, &whitened(records, chosen)?, &lines))
}

fn notes(search: &Search, ranking: &Ranking, verdict: Verdict) -> Vec<String> {
    let records = search.records;
    let rough = records.rough.map(|scales| scales.note());
    let chosen = &ranking.fits[ranking.chosen];
    let unfinished = if verdict == Verdict::Unexplained { UNFINISHED_UNEXPLAINED } else { UNFINISHED };
    let doubts = [
        (records.are_too_few(), TOO_FEW),
        (ranking.unfinished, unfinished),
        (ranking.chosen > 0 && is_too_rough(chosen), TOO_ROUGH),
        (has_gain(chosen, search.declared()), GAIN_OR_MASS),
    ];
    let doubts = doubts.into_iter().filter(|(is_so, _)| *is_so).map(|(_, doubt)| doubt.to_owned());
    let on_bound = notes_on_bound(&chosen.state.hypothesis, search.declared(), verdict);
    records.notes.iter().cloned().chain(rough).chain(doubts).chain(on_bound).collect()
}

fn has_gain(fit: &Fit, declared: usize) -> bool {
    fit.state.hypothesis.effects.iter().skip(declared).any(|on| on.effect.id() == "gain")
}

/// The ids of the effects that the file does not declare.
pub(super) fn name(fit: &Fit, declared: usize) -> String {
    fit.state.hypothesis.name_beyond(declared)
}

/// Standard deviation of everything that a search moved: [`covariance`], widened as the likelihood is, and what a model that is
/// wrong by a little adds, see [`spread_of_gradient`]. In a rough test residuals err together: where [`clustered_spread`] leaves
/// more than [`covariance`], that takes its place.
pub(super) fn deviations(search: &Search, ranking: &Ranking, fit: &Fit) -> Result<Vec<Option<f64>>, IdentifyError> {
    let records = search.records;
    let unit = ranking.scale.independent.recip() * fit.chi_square(records).max(1.0);
    let Some(covariance) = covariance(fit, unit) else { return Ok(vec![None; fit.size]) };
    let left_by = |spread: Mat<f64>| faer::Scale(unit.powi(-2)) * (&covariance * spread * &covariance);
    let (mut of_model, mut clustered) = (Mat::zeros(fit.size, fit.size), Mat::zeros(fit.size, fit.size));
    if fit.given_up.is_none() {
        of_model = left_by(spread_of_gradient(records, fit)?);
        if records.rough.is_some() {
            clustered = left_by(clustered_spread(records, fit)?);
        }
    }
    let hypothesis = &fit.state.hypothesis;
    let none = std::iter::repeat_n(0.0, fit.size - hypothesis.size());
    let amplitude: Vec<f64> = none.chain(of_amplitude(records, hypothesis)).collect();
    let variance = |i: usize| covariance[(i, i)].max(clustered[(i, i)]) + of_model[(i, i)] + amplitude[i];
    Ok((0..fit.size).map(|i| Some(variance(i).sqrt()).filter(|std| std.is_finite())).collect())
}

/// The effects beyond the declared ones, with the standard deviations of their parameters.
pub(super) fn traced(fit: &Fit, std: &[Option<f64>], declared: usize) -> Vec<TracedEffect> {
    let at = fit.size - fit.state.hypothesis.size();
    let mut effects = effects_of(&fit.state.hypothesis, std.get(at..).unwrap_or_default());
    effects.split_off(declared.min(effects.len()))
}

/// All effects of a hypothesis; `std` are those of its coordinates.
pub(super) fn effects_of(hypothesis: &Hypothesis, std: &[Option<f64>]) -> Vec<TracedEffect> {
    let mut rest = std;
    let mut effects = Vec::new();
    for on in &hypothesis.effects {
        let (own, later) = rest.split_at(on.free.len().min(rest.len()));
        rest = later;
        effects.push(TracedEffect { id: on.effect.id(), owner: on.effect.owner(), parameters: parameters(on, own) });
    }
    effects
}

fn parameters(on: &Switched, std: &[Option<f64>]) -> Vec<TracedParameter> {
    let mut values = on.values.iter().enumerate();
    let copies = |each: bool| if each { on.values.len() + 1 - on.effect.parameters().len() } else { 1 };
    let estimate = |(at, &value): (usize, &f64)| {
        let free = on.free.iter().position(|free| free.at == at);
        let std = free.and_then(|i| Some(std.get(i).copied().flatten()? * on.free[i].slope(value)));
        Estimate { value, std }
    };
    let parameters = on.effect.parameters().iter().map(|parameter| TracedParameter {
        name: parameter.name,
        unit: parameter.unit,
        values: values.by_ref().take(copies(parameter.each_record)).map(estimate).collect(),
    });
    parameters.collect()
}

/// The panel at a fit, without any effect.
fn panel(test: &ImpactTest, search: &Search, fit: &Fit, std: &[Option<f64>]) -> Result<PanelModel, IdentifyError> {
    let records = search.records;
    let in_band = records.in_band.min(fit.state.zetas.len());
    let places = records.problem(0).records.iter().map(|record| [Some(record.force_at), Some(record.response_at)]);
    let damping = (in_band, records.usual_log_zeta);
    Ok(bare_panel((test, search.piece), (&fit.state, std), &records.held, damping, places)?)
}

/// Puts the panel's own effects into its model, and says which of the others are taken out and why.
pub(super) fn take_out(all: Vec<TracedEffect>, declared: usize, panel: &mut PanelModel) -> Vec<Removed> {
    let mut removed = Vec::new();
    for (index, effect) in all.into_iter().enumerate() {
        if effect.id == ROUGHNESS {
            continue;
        }
        if effect.owner == Owner::Panel {
            // The plate is the structure itself.
            if effect.id != PLATE {
                panel.effects.push(effect.entry());
            }
            continue;
        }
        removed.push(Removed::of(&effect, index < declared));
    }
    removed
}
