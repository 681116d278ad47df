//! What natural frequencies alone say of the pieces of a test.

use faer::Mat;
use orthopanel_data::{ImpactTest, Measurement, MeasurementData};
use orthopanel_model::Owner;

use crate::IdentifyError;
use crate::declared_effects::{Declared, declared};
use crate::effect_places::has_place;
use crate::frequency_fit::{Reread, likeliest_reading};
use crate::inference::{Correct, from_base};
use crate::judge::{ODDS, TOLD};
use crate::model_error::Kind;
use crate::outcome::{Candidate, EstimatedModelError, FittedError, Progress, TracedError, Tracing, Verdict};
use crate::posterior::{Judged, Point};
use crate::search::{Inquiry, Pairs};

use super::doubt::check_first;
use super::estimates::{Estimates, id};
use super::long_lists::refuse_many;
use super::misfit::{Yardstick, noise};
use super::next_list::next_list;
use super::not_tested::not_tested;
use super::panel::panels_of_lists;
use super::{Weighed, not_finite, shared_model_error};

const MEASURE: &str = "natural frequencies, % rms; held out: each predicted from the others";
const MIRRORED: &str = "frequencies of a piece held alike at both ends are the same with an effect at x and at -x: places are given \
                        with x > 0, and a record of hits at one end tells the side";
const MIRRORED_ACROSS: &str = "frequencies of a plate held alike along front and back are the same with an effect at y and at -y: places are \
                               given with y > 0, and a record of hits off the centre line tells the side";
/// Frequencies for each unknown, one effect of one number among them: with fewer nothing can be said to lack.
const FOR_EACH: usize = 2;
/// Errors that are written out one by one, at most.
const WRITTEN: usize = 12;

/// What the lists of a test say.
///
/// # Errors
/// As [`from_base`]; [`IdentifyError::TooManyFrequencies`], [`IdentifyError::TooFewFrequencies`], and [`IdentifyError::Unsupported`] for a declared effect
/// that no frequency shows.
pub(crate) fn answer_of_lists(
    test: &ImpactTest,
    correct: Option<Correct>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Tracing, IdentifyError> {
    let (test, repeated) = &without_repeats(test);
    refuse_many(test)?;
    let read = likeliest_reading(test);
    // Pairs of effects have no say beside a reading that is clearly likelier than nothing missing.
    let pairs = Pairs(read.as_ref().is_none_or(|read| read.notes.is_empty()));
    let told = answer_as_told(test, correct, progress, pairs);
    let found = match read {
        Some(read) => {
            let base_of = |test: &ImpactTest| from_base(test, correct, &|_| {}, |_, base| Ok(base.log_odds));
            beside_reading(told, &read, base_of, || answer_as_told(&read.test, correct, progress, Pairs(true)))
        }
        None => told,
    };
    found.map(|mut tracing| {
        tracing.notes.extend(repeated.iter().cloned());
        tracing
    })
}

/// What is said of lists beside the likeliest reading of their lines: where that is likelier than any effect, it is read so, and where it is not clearly so or
/// behind, it is asked about first. `base_of` is the logarithm of the odds of a test with nothing missing.
fn beside_reading(
    told: Result<Tracing, IdentifyError>,
    read: &Reread,
    base_of: impl FnOnce(&ImpactTest) -> Result<f64, IdentifyError>,
    reread: impl FnOnce() -> Result<Tracing, IdentifyError>,
) -> Result<Tracing, IdentifyError> {
    let Ok(told) = told else { return if read.notes.is_empty() { told } else { reread() } };
    let best = told.candidates.first().map_or(f64::NEG_INFINITY, |best| best.log_evidence);
    let ahead = base_of(&read.likeliest)? + read.log_beside - best;
    if ahead < -TOLD.ln() {
        return Ok(told);
    }
    let is_read_so = !read.notes.is_empty() && ahead > 0.0;
    let mut found = if is_read_so { reread()? } else { told };
    found.notes.splice(..0, read.notes.iter().chain(&read.question).cloned());
    // What misses the lists by far, however they are read, has its own next step.
    let is_doubted = !is_read_so || read.question.is_some() || ahead < ODDS.ln();
    if let Some(first) = read.question.as_ref().or(read.notes.last()).filter(|_| is_doubted)
        && found.verdict != Verdict::Unexplained
    {
        found.verdict = Verdict::Ambiguous;
        found.next_experiment = first.clone();
    }
    Ok(found)
}

fn answer_as_told(
    test: &ImpactTest,
    correct: Option<Correct>,
    progress: &(dyn Fn(Progress) + Sync),
    pairs: Pairs,
) -> Result<Tracing, IdentifyError> {
    from_base(test, correct, progress, |inquiry, base| {
        let hidden = notes_on_hidden(test, &inquiry)?;
        let determined = base.determined();
        let found = inquiry.frequencies();
        if found <= determined {
            let names = "and one more, to judge by".to_owned();
            return Err(IdentifyError::TooFewFrequencies { found, needed: determined + 1, names });
        }
        let mut all = inquiry.search(base, pairs);
        let mut mirrored = vec![];
        for (axis, note) in [("x", MIRRORED), ("y", MIRRORED_ACROSS)] {
            let turned: Vec<(bool, Judged)> =
                all.into_iter().map(|judged| on_the_right(&inquiry, judged, axis)).collect();
            mirrored.extend(turned.iter().any(|(is_mirrored, _)| *is_mirrored).then(|| note.to_owned()));
            all = turned.into_iter().map(|(_, judged)| judged).collect();
        }
        let mut tracing = tracing_of(test, &inquiry, &all)?;
        tracing.notes.extend(mirrored);
        tracing.notes.extend(inquiry.of_lists.notes.iter().cloned());
        tracing.notes.extend(hidden);
        Ok(tracing)
    })
}

/// The test with each list once, and what was left out, a sentence each: a list that stands twice to the last digit is one measurement.
pub(crate) fn without_repeats(test: &ImpactTest) -> (ImpactTest, Vec<String>) {
    let mut once = test.clone();
    once.measurements.clear();
    let mut notes = Vec::new();
    for (number, measurement) in (1..).zip(&test.measurements) {
        let is_list = matches!(measurement.data, MeasurementData::NaturalFrequencies(_));
        let alike = |kept: &Measurement| kept.piece == measurement.piece && kept.data == measurement.data;
        if is_list && once.measurements.iter().any(alike) {
            notes.push(format!(
                "measurement {number} is the list of an earlier one to the last digit: it counts once, for a copy tells nothing"
            ));
        } else {
            once.measurements.push(measurement.clone());
        }
    }
    (once, notes)
}

/// Of declared effects that no frequency shows: a sentence on each whose numbers the file gives.
///
/// # Errors
/// [`IdentifyError::Unsupported`] for one whose numbers are to be found.
pub(super) fn notes_on_hidden(test: &ImpactTest, inquiry: &Inquiry) -> Result<Vec<String>, IdentifyError> {
    let mut notes = Vec::new();
    for told in declared(test, inquiry.predictor().piece(), 1)? {
        let id = told.effect.id();
        let why = match inquiry.hidden_in_lists(told.effect) {
            Some(_) if has_place(told.effect) => continue,
            // A core acts, though nothing of it could be found.
            Some(_)
                if told.effect.owner() != Owner::Channel
                    && is_told(&told)
                    && inquiry.acts(told.effect).is_ok_and(|acts| !acts.is_empty()) =>
            {
                continue;
            }
            Some(why) => why,
            None => continue,
        };
        if !is_told(&told) {
            return Err(IdentifyError::Unsupported(format!(
                "effect {id:?}: nothing of it can be found from these natural frequencies: {why}; or leave the effect out"
            )));
        }
        notes.push(format!("the declared {id} has no influence on these data: {why}"));
    }
    Ok(notes)
}

/// Whether the file gives all numbers of an effect.
fn is_told(of: &Declared) -> bool {
    of.values.iter().zip(of.effect.parameters()).all(|(value, of)| value.is_some() || of.held_at.is_some())
}

fn tracing_of(test: &ImpactTest, inquiry: &Inquiry, all: &[Judged]) -> Result<Tracing, IdentifyError> {
    let weighed = Weighed::of(inquiry, all)?;
    let Weighed { chosen, base, .. } = weighed;
    // That nothing is missing must not lean on priors.
    let unknowns = base.hypothesis.unknowns() + 1;
    let too_few = weighed.verdict == Verdict::NothingMissing && inquiry.frequencies() < FOR_EACH * unknowns;
    // Of a plate read in another way the effect may be elsewhere.
    let is_open = weighed.verdict == Verdict::Explained && inquiry.of_lists.is_open;
    let verdict = if too_few || is_open { Verdict::Ambiguous } else { weighed.verdict };
    let error = |judged: &Judged| percent(inquiry, judged);
    let (before, after) = (error(base), error(chosen));
    let before = before.ok_or_else(|| not_finite("error of the base model"))?;
    let after = after.ok_or_else(|| not_finite("error of the model with the effects"))?;
    let problem = inquiry.problem(&chosen.hypothesis);
    let yardstick = Yardstick::of(&problem, &chosen.posterior);
    let yardstick = yardstick.ok_or_else(|| not_finite("misfit of the frequencies"))?;
    let candidate = |judged: &Judged| Candidate {
        id: id(judged),
        log_evidence: judged.log_odds,
        held_out: error(judged).map_or(f64::NAN, |error| error.held_out),
        effects: Estimates::of(judged).undeclared(),
    };
    let estimates = Estimates::of(chosen);
    let (panels, removed) = panels_of_lists(test, inquiry, chosen, &estimates);
    let model_error = chosen.posterior.log_sizes[Kind::Frequency as usize].exp();
    let notes = weighed.notes(inquiry, test, &estimates);
    let question = inquiry.of_lists.question.clone().filter(|_| verdict != Verdict::NothingMissing);
    let next_experiment = match (weighed.check().map(check_first).or(question), verdict) {
        (Some(first), _) => first,
        (None, Verdict::Unexplained) => what_to_check(test, inquiry, chosen),
        (None, Verdict::Ambiguous) if too_few => more_frequencies(inquiry, base),
        (None, Verdict::NothingMissing) => {
            "none: the base model meets the frequencies as well as any effect does".to_owned()
        }
        _ => next_list(test, inquiry, chosen, &weighed.nearest(all)),
    };
    Ok(Tracing {
        verdict,
        effects: estimates.undeclared(),
        alternatives: if too_few { tried(all) } else { weighed.alternatives() },
        error: TracedError {
            measure: MEASURE.to_owned(),
            before,
            after,
            noise_floor: 100.0 * noise(inquiry).hypot(model_error),
        },
        model_error: Some(EstimatedModelError { frequency: model_error, residue: None }),
        candidates: all.iter().map(candidate).collect(),
        not_tested: not_tested(inquiry, all),
        detectable: None,
        shared_model_error: shared_model_error(inquiry, chosen),
        next_experiment,
        chi_square: yardstick.fitted(&problem, &chosen.posterior.point).powi(2),
        panels,
        removed,
        accelerances: vec![],
        base_accelerances: vec![],
        notes,
    })
}

/// Every effect that was tried, once.
fn tried(all: &[Judged]) -> Vec<String> {
    let mut names: Vec<&str> = all.iter().flat_map(Judged::names).collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter().map(str::to_owned).collect()
}

/// Rms error of all frequencies, and of each as the others foretell it under the hypothesis' own noise and model error \[%\]. A frequency that the
/// others do not foretell, as that of a resonator, is none of them.
pub(super) fn percent(inquiry: &Inquiry, judged: &Judged) -> Option<FittedError> {
    let problem = inquiry.problem(&judged.hypothesis);
    let point = &judged.posterior.point;
    let rms = |missed: &[f64]| {
        let square: f64 = missed.iter().map(|missed| (-missed).exp_m1().powi(2)).sum();
        100.0 * (square / missed.len().max(1) as f64).sqrt()
    };
    let covariance = problem.errors(&point.at).covariance(inquiry.stacked.noise(), &judged.posterior.log_sizes);
    let left_out = Yardstick::of(&problem, &judged.posterior)?.left_out(&problem, point)?;
    let is_foretold =
        |(place, (_, variance)): &(usize, (f64, f64))| covariance[(*place, *place)] > OF_OTHERS * variance;
    let missed = |(_, (missed, _)): (usize, (f64, f64))| missed;
    let mut foretold: Vec<f64> = left_out.iter().copied().enumerate().filter(is_foretold).map(missed).collect();
    if foretold.is_empty() {
        foretold = left_out.into_iter().enumerate().map(missed).collect();
    }
    Some(FittedError { fitted: rms(&problem.missed(&point.at)), held_out: rms(&foretold) })
}

/// Part of the variance of a frequency as its others foretell it that is noise and model error: with less, it alone tells itself.
const OF_OTHERS: f64 = 0.01;

/// A hypothesis with its first place at x > 0, or y > 0, where the frequencies are the same there; and whether they are.
fn on_the_right(inquiry: &Inquiry, mut judged: Judged, axis: &str) -> (bool, Judged) {
    let places = judged.hypothesis.places(axis);
    let Some(&first) = places.first() else { return (false, judged) };
    let problem = inquiry.problem(&judged.hypothesis);
    let mut z = judged.posterior.point.z.clone();
    places.iter().for_each(|&place| z[place] = -z[place]);
    let Some(there) = problem.unjudged(z) else { return (false, judged) };
    let here = &judged.posterior.point;
    let is_mirrored = there.at.values.iter().zip(&here.at.values).all(|(a, b)| (a - b).abs() < ALIKE);
    if is_mirrored && here.z[first] < 0.0 {
        let turned = |i: usize| if places.contains(&i) { -1.0 } else { 1.0 };
        let own = &judged.posterior.covariance;
        judged.posterior.covariance =
            Mat::from_fn(own.nrows(), own.ncols(), |i, j| turned(i) * turned(j) * own[(i, j)]);
        judged.posterior.point = Point { misfit: here.misfit, cost: here.cost, ..there };
    }
    (is_mirrored, judged)
}

/// Relative difference of frequencies that are the same.
const ALIKE: f64 = 1e-8;

/// What to do where nothing of the catalogue meets the lists.
fn what_to_check(test: &ImpactTest, inquiry: &Inquiry, judged: &Judged) -> String {
    let held = if test.constants.is_empty() { "" } else { " and the constants held" };
    let names = if inquiry.stacked.is_of_plates() {
        "the shapes (nodal lines across x and across y of each mode)"
    } else {
        "the numbering (flexible modes from 1, none left out or read twice)"
    };
    format!(
        "before another measurement check the sizes and units (m, kg/m2){held}, the boundary, and {names}: {}. If all that is right, hit the piece and record it (kind = \"time-history\"): \
         records tell what frequencies alone do not",
        where_it_misses(test, inquiry, judged)
    )
}

/// How large the miss is, in which mode it is largest, and mode by mode.
fn where_it_misses(test: &ImpactTest, inquiry: &Inquiry, judged: &Judged) -> String {
    let of_piece = |piece: usize| match test.pieces.get(piece) {
        Some(named) if test.pieces.len() > 1 => format!("piece {} ", named.name),
        _ => String::new(),
    };
    let mut largest = (0.0_f64, 0, 0);
    let mut each = Vec::new();
    for (block, at) in inquiry.stacked.blocks.iter().zip(&judged.posterior.point.at.blocks) {
        let poles = &block.comparison().measured.poles;
        let errors: Vec<f64> = poles
            .iter()
            .zip(&at.values)
            .map(|(pole, model)| 100.0 * (model.exp() / pole.angular_frequency - 1.0))
            .collect();
        for (pole, &error) in errors.iter().enumerate() {
            if error.abs() > largest.0.abs() || largest.1 == 0 {
                largest = (error, block.comparison().measured.number_in_order(pole) + 1, block.piece);
            }
        }
        let written: Vec<String> = errors.iter().take(WRITTEN).map(|error| format!("{error:+.2}")).collect();
        let more = if errors.len() > WRITTEN { ", ..." } else { "" };
        each.push(format!("{}{}{more} %", of_piece(block.piece), written.join(", ")));
    }
    let (error, mode, piece) = largest;
    format!(
        "the model misses the frequencies by {:.2} % rms; most in {}mode {mode} ({error:+.2} %, model above measured is +); mode by mode {}",
        percent(inquiry, judged).map_or(f64::NAN, |error| error.fitted),
        of_piece(piece),
        each.join("; "),
    )
}

/// What is missing where too few were measured for anything to be found missing.
fn more_frequencies(inquiry: &Inquiry, base: &Judged) -> String {
    let (found, constants) = (inquiry.frequencies(), base.hypothesis.free_constants());
    let open = base.hypothesis.unknowns() - constants;
    let needed = FOR_EACH * (constants + open + 1);
    let (beside, or) = match open {
        0 => (String::new(), ""),
        _ => (format!(", {open} numbers of declared effects"), ", or say the numbers of declared effects"),
    };
    format!(
        "read at least {} natural frequencies: {found} for {constants} constants{beside} and one effect are too few to judge by; or \
         hold a constant that you know under [constants]{or}",
        needed.max(found + 1),
    )
}
