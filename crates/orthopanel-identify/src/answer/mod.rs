//! From the hypotheses that the inference judged to all that a trace tells.

mod bounds;
mod damping;
mod declared;
mod doubt;
mod estimates;
mod identified;
mod left_out;
mod lines;
mod lists;
mod misfit;
mod next_list;
mod next_measurement;
mod not_tested;
mod panel;
mod weighed;

pub(crate) use declared::{identify_lists_with_effects, identify_with_effects};
pub(crate) use identified::PlateByModes;
use lists::refuse_many;
pub(crate) use lists::{answer_of_lists, without_repeats};

use orthopanel_data::{Estimation, ImpactTest};

use crate::IdentifyError;
use crate::hit_strength::HitStrength;
use crate::inference::from_base;
use crate::model_error::Kind;
use crate::outcome::{Candidate, EstimatedModelError, Progress, TracedError, Tracing};
use crate::posterior::Judged;
use crate::search::Inquiry;
use crate::to_check::GAIN_OR_MASS;

use doubt::check_first;
use estimates::{Estimates, id};
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

/// What the measured modes of the records of one beam say.
///
/// # Errors
/// As [`from_base`], and [`IdentifyError::TooManyFrequencies`] for lists beside the records.
pub(crate) fn answer(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    refuse_many(test)?;
    from_base(test, progress, |mut inquiry, base| {
        inquiry.hits = HitStrength::new(test, inquiry.measured().band)?;
        let all = inquiry.search(base);
        tracing_of(test, &inquiry, &all)
    })
}

/// What is to be known of natural frequencies beside the records of the same piece.
fn lists_beside(inquiry: &Inquiry) -> Option<String> {
    let (records, lists) = inquiry.stacked.blocks.split_first()?;
    let is_beside = !inquiry.is_of_lists() && lists.iter().any(|list| list.piece == records.piece);
    is_beside.then(|| LISTS_BESIDE.to_owned())
}

const LISTS_BESIDE: &str = "natural frequencies stand beside the records of the same piece: leave them out if they were read off these records, for \
                            they would count twice";

fn not_finite(what: &str) -> IdentifyError {
    IdentifyError::NotFinite { what: what.into() }
}

fn tracing_of(test: &ImpactTest, inquiry: &Inquiry, all: &[Judged]) -> Result<Tracing, IdentifyError> {
    let measured = inquiry.measured();
    let weighed = Weighed::of(inquiry, all)?;
    let Weighed { chosen, base, verdict, .. } = weighed;
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
    let lines = Lines::of(test, Estimation { force_drop: FORCE_DROP, ..Estimation::default() })?;
    let Drawn { curves, damping } = drawn(test, (inquiry, chosen), &lines)?;
    let base_curves =
        if std::ptr::eq(base, chosen) { curves.clone() } else { drawn(test, (inquiry, base), &lines)?.curves };
    let estimates = Estimates::of(chosen);
    let plate = chosen.hypothesis.parts.iter().position(|part| part.replaces_structure(inquiry.predictor()));
    let of_effects = &chosen.posterior.point.at.first().damping_of_effects;
    let (hit, removed) = panel(test, (measured, of_effects), (chosen, &estimates), damping, plate)?;
    let (mut panels, _) = panels_of_lists(test, inquiry, chosen, &estimates);
    panels[measured.piece] = hit;
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    let mut notes = lines.notes;
    if chosen.names().contains(&"gain") {
        notes.push(GAIN_OR_MASS.to_owned());
    }
    if lines.hits_are_few {
        notes.push(FEW_HITS.to_owned());
    }
    notes.extend(lists_beside(inquiry));
    notes.extend(weighed.notes(inquiry, test, &estimates));
    let next_experiment = match weighed.check() {
        Some(doubt) => check_first(doubt),
        None => next_measurement((test, inquiry), (chosen, verdict, after.fitted), (&weighed.near, all)),
    };
    Ok(Tracing {
        verdict,
        effects: estimates.undeclared(),
        alternatives: weighed.alternatives(),
        error: TracedError { measure: MEASURE.to_owned(), before, after, noise_floor: 1.0 },
        model_error: Some(EstimatedModelError { frequency: size(Kind::Frequency), residue: Some(size(Kind::Residue)) }),
        candidates: all.par_iter().map(candidate).collect(),
        not_tested: not_tested(inquiry, all),
        next_experiment,
        chi_square: after.fitted.powi(2),
        panels,
        removed,
        accelerances: curves,
        base_accelerances: base_curves,
        notes,
    })
}

/// The records' lines beside a hypothesis.
///
/// # Errors
/// What the model refuses.
fn drawn(test: &ImpactTest, (inquiry, judged): (&Inquiry, &Judged), lines: &Lines) -> Result<Drawn, IdentifyError> {
    let z = &judged.posterior.point.z;
    let (constants, effects) = inquiry.stacked.first().values(&judged.hypothesis, z)?;
    let of_effects = judged.posterior.point.at.first().damping_of_effects.clone();
    lines.drawn(test, inquiry.measured(), (&constants, &effects, &of_effects))
}
