//! From the hypotheses that the inference judged to all that a trace tells.

mod bounds;
mod damping;
mod declared;
mod doubt;
mod estimates;
mod identified;
mod left_out;
mod lines;
mod misfit;
mod next_measurement;
mod not_tested;
mod panel;

pub(crate) use declared::identify_with_effects;
pub(crate) use identified::PlateByModes;

use std::f64::consts::TAU;

use orthopanel_data::{Estimation, ImpactTest};
use orthopanel_model::Readable;

use crate::IdentifyError;
use crate::hit_strength::HitStrength;
use crate::inference::from_base;
use crate::judge::{has_no_mode, judged, rivals};
use crate::model_error::Kind;
use crate::outcome::{Candidate, EstimatedModelError, Progress, TracedError, Tracing, Verdict};
use crate::posterior::Judged;
use crate::search::Inquiry;
use crate::to_check::GAIN_OR_MASS;

use bounds::{notes_on_bound, notes_on_prior_alone};
use doubt::{check_first, doubts, notes_on_not_shown};
use estimates::{Estimates, id};
use lines::{Drawn, Lines};
use misfit::Yardstick;
use next_measurement::next_measurement;
use not_tested::not_tested;
use panel::panel;
use rayon::prelude::*;

const FEW_HITS: &str = "one hit at each of fewer than three pairs of places: how hits differ is not seen. Hit each place three times, or hit three places";

const MEASURE: &str = "misfit of the measured modes over noise and model error, rms (1: as far as these go)";

/// Force lost over the band that is drawn \[dB\].
const FORCE_DROP: f64 = 20.0;

/// What the measured modes of the records of one beam say.
///
/// # Errors
/// As [`from_base`].
pub(crate) fn answer(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    from_base(test, progress, |mut inquiry, base| {
        inquiry.hits = HitStrength::new(test, inquiry.measured().band)?;
        let all = inquiry.search(base);
        tracing_of(test, &inquiry, &all)
    })
}

fn tracing_of(test: &ImpactTest, inquiry: &Inquiry, all: &[Judged]) -> Result<Tracing, IdentifyError> {
    let measured = inquiry.measured();
    let not_finite = |what: &str| IdentifyError::NotFinite { what: what.into() };
    let none = IdentifyError::TooFewResonances { found: measured.poles.len(), needed: 2, noise_percent: None };
    let (chosen, verdict, alternatives) = judged(all, measured).ok_or(none)?;
    let base = all.iter().find(|judged| judged.names().is_empty()).unwrap_or(chosen);
    let mut doubts = doubts(inquiry, base, &all[0]);
    let is_unexplained = verdict == Verdict::Unexplained;
    doubts.retain(|doubt| doubt.is_rival || is_unexplained);
    let check = doubts.iter().filter(|_| !is_unexplained);
    let verdict = if check.clone().next().is_some() { Verdict::Ambiguous } else { verdict };
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
        bic: None,
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
    let plate = chosen.hypothesis.parts.iter().position(|part| part.replaces_structure(problem.predictor));
    let of_effects = &chosen.posterior.point.at.damping_of_effects;
    let (panel, removed) = panel(test, (measured, of_effects), &estimates, damping, plate)?;
    let near: Vec<&Judged> = if verdict == Verdict::Ambiguous { rivals(all, chosen).collect() } else { vec![] };
    let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
    let mut notes = lines.notes;
    if chosen.names().contains(&"gain") {
        notes.push(GAIN_OR_MASS.to_owned());
    }
    if lines.hits_are_few {
        notes.push(FEW_HITS.to_owned());
    }
    let without_mode = (0..measured.poles.len()).filter(|pole| has_no_mode(chosen, measured, *pole));
    notes.extend(without_mode.map(|pole| {
        let frequency = measured.poles[pole].angular_frequency / TAU;
        format!(
            "the resonance at {frequency:.1} Hz is no mode of this model: something swings there that it does not hold"
        )
    }));
    notes.extend(doubts.iter().map(|doubt| doubt.sentence.clone()));
    notes.extend(near.iter().map(|rival| standing(chosen, rival)));
    notes.extend(notes_on_not_shown(inquiry, base));
    notes.extend(notes_on_prior_alone(chosen, &estimates));
    notes.extend(notes_on_bound(&estimates, &test.pieces[measured.piece].piece));
    let next_experiment = match check.clone().next() {
        Some(doubt) => check_first(doubt),
        None => next_measurement((test, inquiry), (chosen, verdict, after.fitted), (&near, all)),
    };
    Ok(Tracing {
        verdict,
        effects: estimates.undeclared(),
        alternatives: check.map(|doubt| doubt.id).chain(alternatives).map(str::to_owned).collect(),
        error: TracedError { measure: MEASURE.to_owned(), before, after, noise_floor: 1.0 },
        model_error: Some(EstimatedModelError { frequency: size(Kind::Frequency), residue: size(Kind::Residue) }),
        candidates: all.par_iter().map(candidate).collect(),
        not_tested: not_tested(inquiry, all),
        next_experiment,
        chi_square: after.fitted.powi(2),
        panels: vec![panel],
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
    let (constants, effects) = (judged.hypothesis.constants(z), judged.hypothesis.effects(z)?);
    let of_effects = judged.posterior.point.at.damping_of_effects.clone();
    lines.drawn(test, inquiry.measured(), (&constants, &effects, &of_effects))
}

fn standing(chosen: &Judged, rival: &Judged) -> String {
    let apart = rival.log_odds - chosen.log_odds;
    let (place, odds) = if apart < 0.0 { ("behind", -apart) } else { ("ahead of", apart) };
    format!(
        "{} is {place} {} by {:.1} in the natural logarithm of the odds: these data do not part the two",
        id(rival),
        id(chosen),
        Readable(odds)
    )
}
