//! From the hypotheses that the inference judged to all that a trace tells.

mod bounds;
mod damping;
mod declared;
mod doubt;
mod estimates;
mod factor;
mod identified;
mod left_out;
mod lines;
mod lists;
mod long_lists;
mod misfit;
mod next_list;
mod next_measurement;
mod not_tested;
mod panel;
mod too_few_places;
mod weighed;

pub(crate) use declared::{identify_lists_with_effects, identify_with_effects};
pub(crate) use identified::PlateByModes;
pub(crate) use lists::{answer_of_lists, without_repeats};
use long_lists::refuse_many;

use orthopanel_data::{Estimation, ImpactTest};
use orthopanel_model::StructureKind;

use crate::hit_strength::HitStrength;
use crate::inference::{Correct, from_base};
use crate::model_error::Kind;
use crate::outcome::{Candidate, EstimatedModelError, Progress, Removed, SharedModelError, TracedError, Tracing};
use crate::place_readings::untold;
use crate::posterior::Judged;
use crate::search::{Inquiry, Pairs};
use crate::stacked::Block;
use crate::{AcceleranceFit, IdentifyError};

use doubt::check_first;
use estimates::{Estimates, id};
use factor::Factor;
use lines::{Drawn, Lines};
use misfit::Yardstick;
use next_measurement::next_measurement;
use not_tested::not_tested;
use panel::{panel, panels_of_lists};
use rayon::prelude::*;
use weighed::Weighed;

const FEW_HITS: &str = "one hit at each of fewer than three pairs of places: how hits differ is not seen. Hit each place three times, or hit three places";

const MEASURE: &str = "misfit of the measured modes over noise and model error, rms (1: as far as these go)";

/// Force lost over the band that is drawn \[dB\].
const FORCE_DROP: f64 = 20.0;

/// What the measured modes of records say, and of lists beside them.
///
/// # Errors
/// As [`from_base`], and [`IdentifyError::TooManyFrequencies`] for lists beside the records.
pub(crate) fn answer(
    test: &ImpactTest,
    correct: Option<Correct>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Tracing, IdentifyError> {
    refuse_many(test)?;
    from_base(test, correct, progress, |mut inquiry, base| {
        if !inquiry.stacked.is_of_several_pieces() {
            inquiry.hits = HitStrength::new(test, inquiry.measured().band)?;
        }
        let all = inquiry.search(base, Pairs(false));
        tracing_of(test, &inquiry, &all)
    })
}

/// What is to be known of natural frequencies beside the records of the same piece.
fn lists_beside(inquiry: &Inquiry) -> Option<String> {
    let lists = || inquiry.stacked.blocks.iter().filter(|block| block.comparison().measured.records.is_empty());
    let is_beside = inquiry.stacked.hit().any(|(_, hit)| lists().any(|list| list.piece == hit.piece));
    is_beside.then(|| LISTS_BESIDE.to_owned())
}

const LISTS_BESIDE: &str = "natural frequencies stand beside the records of the same piece: leave them out if they were read off these records, for \
                            they would count twice";

fn not_finite(what: &str) -> IdentifyError {
    IdentifyError::NotFinite { what: what.into() }
}

fn tracing_of(test: &ImpactTest, inquiry: &Inquiry, all: &[Judged]) -> Result<Tracing, IdentifyError> {
    let mut weighed = Weighed::of(inquiry, all)?;
    let Weighed { chosen, base, .. } = weighed;
    let lines = Lines::of(test, Estimation { force_drop: FORCE_DROP, ..Estimation::default() })?;
    let of_chosen = drawn(test, (inquiry, chosen), &lines)?;
    let curves = curves_of(&of_chosen);
    let factor = Factor::of(test, inquiry, &mut weighed, &curves);
    let verdict = weighed.verdict;
    let problem = inquiry.problem(&chosen.hypothesis);
    let yardstick = Yardstick::of(&problem, &chosen.posterior);
    let yardstick = yardstick.ok_or_else(|| not_finite("covariance of the measured modes"))?;
    let after = yardstick.error(&problem, &chosen.posterior.point);
    let after = after.ok_or_else(|| not_finite("error of the model with the effects"))?;
    let before = if std::ptr::eq(base, chosen) {
        after
    } else {
        let nearest = yardstick.nearest(&inquiry.problem(&base.hypothesis), base);
        nearest.ok_or_else(|| not_finite("error of the base model"))?
    };
    let candidate = |judged: &Judged| Candidate {
        id: id(judged),
        log_evidence: judged.log_odds,
        held_out: if std::ptr::eq(judged, base) {
            before.held_out
        } else {
            let error = yardstick.error(&inquiry.problem(&judged.hypothesis), &judged.posterior.point);
            error.map_or(f64::NAN, |error| error.held_out)
        },
        effects: Estimates::of(judged).undeclared(),
    };
    let of_base = if std::ptr::eq(base, chosen) { None } else { Some(drawn(test, (inquiry, base), &lines)?) };
    let base_curves = of_base.as_deref().map_or_else(|| curves.clone(), curves_of);
    let estimates = Estimates::of(chosen);
    let plate = chosen.hypothesis.parts.iter().position(|part| part.replaces_structure(inquiry.predictor()));
    let (mut panels, mut removed) = panels_of_lists(test, inquiry, chosen, &estimates);
    for ((number, hit), Drawn { damping, .. }) in inquiry.stacked.hit().zip(of_chosen) {
        let of_effects = &chosen.posterior.point.at.blocks[number].damping_of_effects;
        let measured = hit.comparison().measured;
        panels[hit.piece] = panel(test, (measured, of_effects), (chosen, &estimates), damping, plate)?;
    }
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    let mut notes: Vec<String> = factor.iter().map(|factor| factor.sentence.clone()).collect();
    notes.extend(lines.notes);
    if lines.hits_are_few {
        notes.push(FEW_HITS.to_owned());
    }
    notes.extend(untold(test));
    notes.extend(lists_beside(inquiry));
    notes.extend(weighed.notes(inquiry, test, &estimates));
    let clear = factor.as_ref().and_then(|factor| factor.next.clone());
    let next_experiment = match (clear, weighed.check()) {
        (Some(clear), _) => clear,
        (None, Some(doubt)) => check_first(doubt),
        (None, None) => next_measurement((test, inquiry), (chosen, verdict, after.fitted), (&weighed.near, all)),
    };
    let mut effects = estimates.undeclared();
    if let Some(gain) = factor.and_then(|factor| factor.effect) {
        removed.push(Removed::of(&gain, false));
        effects.push(gain);
    }
    Ok(Tracing {
        verdict,
        effects,
        alternatives: weighed.alternatives(),
        error: TracedError { measure: MEASURE.to_owned(), before, after, noise_floor: 1.0 },
        model_error: Some(EstimatedModelError { frequency: size(Kind::Frequency), residue: Some(size(Kind::Residue)) }),
        candidates: all.par_iter().map(candidate).collect(),
        not_tested: not_tested(inquiry, all),
        detectable: inquiry.detectable(chosen),
        shared_model_error: shared_model_error(inquiry, chosen),
        next_experiment,
        chi_square: after.fitted.powi(2),
        panels,
        removed,
        accelerances: curves,
        base_accelerances: base_curves,
        notes,
    })
}

/// The lines of each piece that was hit beside a hypothesis.
///
/// # Errors
/// What the model refuses.
fn drawn(
    test: &ImpactTest,
    (inquiry, judged): (&Inquiry, &Judged),
    lines: &Lines,
) -> Result<Vec<Drawn>, IdentifyError> {
    let of_hit = |(number, hit): (usize, &Block)| {
        let (constants, effects) = hit.values(&judged.hypothesis, &judged.posterior.point.z)?;
        if hit.predictor.structure == StructureKind::MindlinPlate {
            return lines.drawn_by_modes(hit, (&constants, &effects));
        }
        let of_effects = &judged.posterior.point.at.blocks[number].damping_of_effects;
        lines.drawn(test, hit.comparison().measured, (&constants, &effects, of_effects))
    };
    inquiry.stacked.hit().map(of_hit).collect()
}

fn shared_model_error(inquiry: &Inquiry, chosen: &Judged) -> Option<SharedModelError> {
    let comparison = inquiry.stacked.first().comparison();
    Some(inquiry.shared_error.as_ref()?.beside(comparison, &chosen.posterior.point.at))
}

fn curves_of(drawn: &[Drawn]) -> Vec<AcceleranceFit> {
    drawn.iter().flat_map(|drawn| drawn.curves.iter().cloned()).collect()
}
