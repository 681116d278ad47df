//! From the minimum to what is reported.

use std::f64::consts::TAU;

use faer::{Mat, Scale};
use num_complex::Complex64;
use orthopanel_data::ImpactTest;
use orthopanel_model::Estimate;

use super::band::refuse_low_band;
use super::contradiction::contradiction;
use super::misfit::{noise_percent, record_misfit_percent};
use super::problem::{AcceleranceProblem, FAR_FROM_NOISE};
use super::start::Start;
use super::told_damping::{DAMPING_UNSEEN, is_told};
use super::undeclared_window;
use super::whole_covariance::Weighed;
use crate::free_constants::Rest;
use crate::frequency_fit::identified_constants;
use crate::least_squares::Minimum;
use crate::structures::Shown;
use crate::{AcceleranceFit, Correlation, HiddenMode, Identification, IdentifyError, ModeFit, NotIdentified, PieceFit};

/// Each parameter takes one off a sum of squares of mere noise, whatever the model; what takes off no more than so many times
/// that has seen nothing else.
const MORE_THAN_CHANCE: f64 = 20.0;
/// A constant is seen where its standard deviation is below this part of what is usual.
const SEEN: f64 = 0.5;

/// What a minimum of the likelihood says.
pub(super) fn outcome(
    test: &ImpactTest,
    start: Start,
    problem: &mut AcceleranceProblem,
    minimum: Minimum,
) -> Result<Identification, IdentifyError> {
    refuse_mere_noise(problem, &minimum)?;
    let mut weighed = problem.weigh_whole(minimum)?;
    let chi_square = weighed.chi_square;
    let widened = if problem.noise_is_known() { chi_square.max(1.0) } else { chi_square };
    weighed.covariance = weighed.covariance.map(|matrix| matrix * Scale(widened));
    let mut notes = start.recorded.notes.clone();
    if problem.noise_is_to_learn() {
        notes.push(
            "one hit at a place tells no scatter: noise and standard deviations are from how the misfit of neighbouring lines \
             scatters"
                .to_owned(),
        );
    }
    stated(test, start, problem, weighed, notes)
}

/// What a minimum of eq. 23 says, with what the noise does to it.
pub(super) fn outcome_of_papers_error(
    test: &ImpactTest,
    start: Start,
    problem: &mut AcceleranceProblem,
    minimum: Minimum,
    covariance: Option<Mat<f64>>,
) -> Result<Identification, IdentifyError> {
    refuse_mere_noise(problem, &minimum)?;
    let chi_square = problem.chi_square(minimum.at.cost);
    let notes = start.recorded.notes.clone();
    stated(test, start, problem, Weighed { minimum, covariance, chi_square }, notes)
}

fn refuse_mere_noise(problem: &AcceleranceProblem, minimum: &Minimum) -> Result<(), IdentifyError> {
    let chance = MORE_THAN_CHANCE * problem.size() as f64;
    if problem.noise_is_known() && problem.cost_of_nothing() - minimum.at.cost < chance {
        let needed = problem.constants.count();
        let noise_percent = noise_percent(problem.records());
        return Err(IdentifyError::TooFewResonances { found: 0, needed, noise_percent });
    }
    Ok(())
}

fn stated(
    test: &ImpactTest,
    mut start: Start,
    problem: &mut AcceleranceProblem,
    weighed: Weighed,
    notes: Vec<String>,
) -> Result<Identification, IdentifyError> {
    let Weighed { minimum: Minimum { parameters, .. }, covariance, chi_square } = weighed;
    let std = |i: usize| covariance.as_ref().map(|matrix| matrix[(i, i)].sqrt());
    let log_std: Vec<Option<f64>> = (0..problem.size()).map(std).collect();
    let correlations = covariance.as_ref().map(|matrix| problem.constants.correlations(matrix)).unwrap_or_default();
    let chi_square = problem.noise_is_known().then_some(chi_square);
    let mut found = Found { parameters, log_std, correlations, chi_square };
    if !problem.usual.is_empty() {
        start.fit.not_identified = rest_unseen(problem, &mut found, covariance.as_ref());
    }
    report(test, &start, problem, found, notes)
}

/// Lets those constants rest of which the records tell no more than what is usual, at the values found.
fn rest_unseen(
    problem: &mut AcceleranceProblem,
    found: &mut Found,
    covariance: Option<&Mat<f64>>,
) -> Vec<NotIdentified> {
    let constants = problem.constants.clone();
    let mut reports = Vec::new();
    // From the last, so that the places of those before stay.
    for usual in problem.usual.drain(..).rev() {
        let std = found.log_std[usual.parameter].unwrap_or(f64::INFINITY);
        if std < SEEN * usual.std {
            continue;
        }
        let at = found.parameters[usual.parameter];
        let unseen = constants.not_identified(usual.parameter, at, std.min(usual.std), covariance);
        problem.constants.rest(constants.free[usual.parameter].constant, Rest::Held(unseen.held_at));
        reports.push(unseen);
        found.parameters.remove(usual.parameter);
        found.log_std.remove(usual.parameter);
    }
    let resting: Vec<&str> = reports.iter().map(|unseen| unseen.name).collect();
    found.correlations.retain(|pair| !resting.contains(&pair.first) && !resting.contains(&pair.second));
    reports
}

/// Parameters and what is known of them.
struct Found {
    parameters: Vec<f64>,
    log_std: Vec<Option<f64>>,
    correlations: Vec<Correlation>,
    chi_square: Option<f64>,
}

/// Constants from the frequencies of the resonances, damping from each resonance by itself; `parameters` fill in for
/// what no resonance shows.
pub(super) fn from_poles(
    test: &ImpactTest,
    start: Start,
    problem: &mut AcceleranceProblem,
    parameters: &[f64],
) -> Result<Identification, IdentifyError> {
    let start = match start.recorded.structure.shown() {
        Shown::Wholly => start.grouped()?,
        Shown::InPart => start,
    };
    let mut found = Found {
        parameters: parameters.to_vec(),
        log_std: vec![None; problem.size()],
        correlations: Vec::new(),
        chi_square: None,
    };
    found.correlations = take_from_poles(&start, problem, &mut found.parameters, &mut found.log_std);
    let at = problem.linearise(&found.parameters)?;
    if problem.noise_is_known() {
        found.chi_square = Some(at.cost / problem.data());
    }
    let lines = problem.lines(&found.parameters)?;
    let mut notes = start.recorded.notes.clone();
    notes.push(why_from_poles(&start, problem, &lines).to_owned());
    report(test, &start, problem, found, notes)
}

/// Why constants and damping are those of the resonances.
///
/// A resonance $\delta$ half widths beside its place changes no line by more than that part of it, so a greater misfit in half
/// of a record's lines is not the resonances'.
fn why_from_poles(start: &Start, problem: &AcceleranceProblem, lines: &[Vec<Complex64>]) -> &'static str {
    let records = problem.records().zip(lines);
    let most = records.map(|(record, model)| record_misfit_percent(record, model)).fold(0.0, f64::max);
    let between = start.resonances_meet() && most > 100.0 * start.half_widths_beside();
    if between {
        "the model's resonances meet those of the records, but the lines between them are missed by far more than their \
         noise, as where a place, a gain or a delay is a wrong one or the model lacks an effect (orthopanel trace looks for \
         it): constants are from the frequencies of the resonances, damping from each resonance by itself"
    } else {
        "the model's resonances lie beside those of the records by more than their width or their noise: constants are \
         from the frequencies of the resonances, damping from each resonance by itself"
    }
}

fn report(
    test: &ImpactTest,
    start: &Start,
    problem: &mut AcceleranceProblem,
    found: Found,
    mut notes: Vec<String>,
) -> Result<Identification, IdentifyError> {
    let Found { parameters, log_std, correlations, chi_square } = found;
    problem.constants.refuse_bounds(&parameters)?;
    let lines = problem.lines(&parameters)?;
    let is_in_part = start.recorded.structure.shown() == Shown::InPart;
    let untaken = start.untaken_resonances();
    notes.extend(contradiction(test, problem, &parameters, &lines, &untaken)?);
    if let Some(chi_square) = chi_square.filter(|of| *of > FAR_FROM_NOISE && is_in_part && !untaken.is_empty()) {
        return Err(IdentifyError::UntakenResonances { chi_square, resonances: untaken });
    }
    if is_in_part {
        notes.extend(note_of_untaken(&untaken));
    }
    refuse_low_band(start.recorded, &problem.constants, &parameters)?;
    let (fits, accelerance_rms_percent) = accelerance_fits(problem, lines);
    let pieces = piece_fits(test, start, problem, &parameters, &log_std)?;
    notes.extend(pieces.iter().filter_map(without_resonance));
    let question = undeclared_window::asked(start, problem, &parameters, &pieces)?;
    notes.extend(question.clone());
    let errors = pieces.iter().flat_map(|piece| &piece.modes).map(|mode| mode.error_percent().powi(2));
    // The sum of nothing is minus zero.
    let errors = errors.fold(0.0, std::ops::Add::add);
    let count = pieces.iter().map(|piece| piece.modes.len()).sum::<usize>().max(1);
    Ok(Identification {
        structure: start.recorded.structure.kind(),
        constants: identified_constants(test, &problem.constants, &parameters, &log_std),
        not_identified: start.fit.not_identified.clone(),
        correlations,
        frequency_rms_percent: (errors / count as f64).sqrt(),
        left_one_out_percent: None,
        accelerance_rms_percent: Some(accelerance_rms_percent),
        chi_square,
        accelerances: fits,
        effects: Vec::new(),
        question,
        common_gain: None,
        notes,
        pieces,
    })
}

/// Puts the constants of the poles' frequencies, and the poles' damping, in place of the fit's; the correlations of the
/// constants.
fn take_from_poles(
    start: &Start,
    problem: &AcceleranceProblem,
    parameters: &mut [f64],
    log_std: &mut [Option<f64>],
) -> Vec<Correlation> {
    let fit = &start.fit;
    let free = fit.parameters.len();
    parameters[..free].copy_from_slice(&fit.parameters);
    let covariance = fit.at.covariance();
    let beyond = start.matching.count().saturating_sub(free);
    let scatter = (beyond > 0).then(|| fit.at.cost / beyond as f64);
    for (index, std) in log_std.iter_mut().enumerate().take(free) {
        *std = covariance.as_ref().zip(scatter).map(|(matrix, scatter)| (scatter * matrix[(index, index)]).sqrt());
    }
    for (index, (poles, matched)) in start.poles.iter().zip(&start.matching.modes).enumerate() {
        let offset = problem.zeta_offset(index);
        for (pole, mode) in poles.iter().zip(matched) {
            if let Some(mode) = mode.filter(|&mode| mode < problem.pieces[index].free_zetas) {
                parameters[offset + mode] = pole.zeta.ln();
                log_std[offset + mode] = Some(pole.log_zeta_std);
            }
        }
    }
    covariance.map(|matrix| problem.constants.correlations(&matrix)).unwrap_or_default()
}

/// Measured and calculated accelerance of every record, and the rms of their difference \[% of the rms measured\].
fn accelerance_fits(problem: &AcceleranceProblem, lines: Vec<Vec<Complex64>>) -> (Vec<AcceleranceFit>, f64) {
    let mut lines = lines.into_iter();
    let mut fits: Vec<AcceleranceFit> = Vec::new();
    for piece in &problem.pieces {
        for (record, model) in piece.records.iter().zip(lines.by_ref()) {
            fits.push(AcceleranceFit {
                piece: piece.piece,
                force_at: record.force_at,
                response_at: record.response_at,
                decay_rate: record.decay_rate,
                frequency: record.frequency.clone(),
                measured: record.value.clone(),
                model,
                variance: record.variance_known.then(|| record.variance.clone()),
            });
        }
    }
    let pairs = || fits.iter().flat_map(|fit| fit.model.iter().zip(&fit.measured));
    let missed: f64 = pairs().map(|(model, measured)| (model - measured).norm_sqr()).sum();
    let total: f64 = pairs().map(|(_, measured)| measured.norm_sqr()).sum();
    (fits, 100.0 * (missed / total).sqrt())
}

fn note_of_untaken(resonances: &[f64]) -> Option<String> {
    let told: Vec<String> = resonances.iter().map(|frequency| format!("{frequency:.1} Hz")).collect();
    (!told.is_empty()).then(|| format!("resonances that no mode of the model took: {}", told.join(", ")))
}

/// Modes in the band without a resonance of their own, and which of them have no damping of their own either.
fn without_resonance(fit: &PieceFit) -> Option<String> {
    let numbers = |modes: &mut dyn Iterator<Item = &HiddenMode>| {
        modes.map(|hidden| hidden.mode.to_string()).collect::<Vec<_>>().join(", ")
    };
    let [told, untold] =
        [true, false].map(|told| numbers(&mut fit.hidden.iter().filter(|hidden| hidden.damping.is_some() == told)));
    let mut says = Vec::new();
    if !told.is_empty() {
        says.push(format!("damping of mode {told} is from the lines of all records together"));
    }
    if !untold.is_empty() {
        says.push(format!("damping of mode {untold} is not told, the model has a usual one"));
    }
    (!says.is_empty()).then(|| format!("modes in the band without a resonance of their own: {}", says.join("; ")))
}

/// The modes that the records show, and the damping of all modes inside the band.
fn piece_fits(
    test: &ImpactTest,
    start: &Start,
    problem: &AcceleranceProblem,
    parameters: &[f64],
    log_std: &[Option<f64>],
) -> Result<Vec<PieceFit>, IdentifyError> {
    let mut fits = Vec::new();
    for (index, named) in test.pieces.iter().enumerate() {
        let mut fit = PieceFit::of(named);
        let own = start.recorded.pieces.iter().position(|piece| piece.index == index);
        if let Some(own) = own {
            let piece = &problem.pieces[own];
            let offset = problem.zeta_offset(own);
            let structure = &start.recorded.poles[own].structure;
            let limit = 1.3 * start.recorded.poles[own].band;
            let seen = structure.modes_below(&problem.values(parameters, own), limit, &[])?;
            let in_doubt = piece.records.iter().map(|record| record.decay_rate_in_doubt).fold(0.0, f64::max);
            let log_std = |mode: usize| {
                let own = log_std[offset + mode]?;
                let decay = parameters[offset + mode].exp() * TAU * seen.get(mode).map_or(0.0, |mode| mode.frequency);
                Some(if in_doubt > 0.0 { own.hypot(in_doubt / decay) } else { own })
            };
            let estimate = |mode: usize| {
                let value = parameters[offset + mode].exp();
                Estimate { value, std: log_std(mode).map(|std| std * value) }
            };
            fit.damping = (0..piece.in_band).map(estimate).collect();
            for (pole, mode) in start.poles[own].iter().zip(&start.matching.modes[own]) {
                let Some((mode, found)) = mode.and_then(|mode| Some((mode, seen.get(mode)?))) else { continue };
                let told = mode < piece.free_zetas && log_std(mode).is_none_or(|std| std < DAMPING_UNSEEN);
                let damping = told.then(|| estimate(mode));
                fit.modes.push(ModeFit {
                    mode: mode + 1,
                    nodes: found.nodes,
                    measured: pole.frequency,
                    measured_std: Some(pole.frequency_std()).filter(|std| std.is_finite()),
                    model: found.frequency,
                    damping,
                });
            }
            let matched = &start.matching.modes[own];
            let without = seen.iter().zip(&fit.damping).enumerate().filter(|(mode, _)| !matched.contains(&Some(*mode)));
            fit.hidden = without
                .map(|(mode, (found, damping))| HiddenMode {
                    mode: mode + 1,
                    nodes: found.nodes,
                    model: found.frequency,
                    damping: Some(*damping).filter(is_told),
                })
                .collect();
        }
        fits.push(fit);
    }
    Ok(fits)
}
