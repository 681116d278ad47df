//! From the minimum to what is reported.

use orthopanel_data::ImpactTest;

use super::doubtful_names::neighbours_met_better;
use super::lone_lines::lone_lines;
use super::noise::rounding_variance;
use super::noise::{BEYOND_CHANCE, Noise, USUAL_SCATTER};
use super::own_constants::own_constant_that_helps;
use super::problem::{FrequencyProblem, SetPrediction};
use super::uncertainty::{residual_variance, uncertainty};
use crate::free_constants::FreeConstants;
use crate::least_squares::Linearised;
use crate::structures::Shown;
use crate::{Identification, IdentifiedConstant, IdentifyError, ModeFit, NotIdentified, PieceFit};

pub(super) fn report(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &[f64],
    predictions: &[SetPrediction],
    (not_identified, mut notes): (Vec<NotIdentified>, Vec<String>),
) -> Result<Identification, IdentifyError> {
    let at = problem.linearised(predictions, &problem.constants);
    let uncertainty = uncertainty(problem, predictions, found, &at);
    notes.extend(assumed_scatter(problem, &at));
    notes.extend(other_modes(test, problem, predictions)?);
    if notes.is_empty() {
        notes.extend(large_miss(test, problem, found, predictions, &at));
    }
    if notes.is_empty() {
        notes = lone_lines(test, problem, &at);
    }
    Ok(Identification {
        question: None,
        common_gain: None,
        structure: problem.structure.kind(),
        constants: identified_constants(
            test,
            &problem.constants,
            found,
            &uncertainty.std.iter().copied().map(Some).collect::<Vec<_>>(),
        ),
        not_identified,
        correlations: uncertainty.correlations,
        pieces: piece_fits(test, problem, predictions)?,
        frequency_rms_percent: 100.0 * (at.quadratic().cost / problem.count() as f64).sqrt(),
        left_one_out_percent: uncertainty.left_one_out_percent,
        accelerance_rms_percent: None,
        chi_square: None,
        accelerances: Vec::new(),
        effects: Vec::new(),
        notes,
    })
}

/// What is said where a plate misses its frequencies by far more than these scatter.
fn large_miss(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &[f64],
    predictions: &[SetPrediction],
    at: &Linearised,
) -> Option<String> {
    let rms = (at.quadratic().cost / problem.count().max(1) as f64).sqrt();
    let scatter = Noise::stated(problem).variance.sqrt();
    if problem.structure.shown() == Shown::Wholly || rms <= BEYOND_CHANCE * scatter {
        return None;
    }
    let told = if rounding_variance(problem) > 0.0 { "the bins stated" } else { "the usual scatter" };
    let may_be = own_constant_that_helps(test, problem, found, predictions)
        .or_else(|| neighbours_met_better(test, problem, at.quadratic().cost))
        .unwrap_or_else(|| "a mode may be named wrongly, or the plate lacks something".to_owned());
    Some(format!(
        "the plate misses the frequencies by {:.2} % rms, {:.0} times {told} ({:.2} %), from other starts too: {may_be}; its \
         constants are in doubt",
        100.0 * rms,
        rms / scatter,
        100.0 * scatter
    ))
}

/// A mode with a smaller share of the nodal lines by which it is told is another one.
const LEAST_SHARE: f64 = 0.1;

/// A sentence for each line that is met by a mode of other nodal lines, for none of its own is near.
fn other_modes(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    predictions: &[SetPrediction],
) -> Result<Vec<String>, IdentifyError> {
    let mut notes = Vec::new();
    for (set, predicted) in problem.sets.iter().zip(predictions) {
        let lines = set.measured.iter().zip(set.modes.nodes()).zip(&predicted.modes);
        for ((measured, nodes), mode) in lines.filter(|(_, mode)| mode.share < LEAST_SHARE) {
            let spectrum = set.modes.spectrum(&predicted.values)?;
            let apart = |frequency: f64| (frequency - mode.frequency).abs();
            let met = spectrum.iter().min_by(|a, b| apart(a.frequency).total_cmp(&apart(b.frequency)));
            notes.push(format!(
                "piece {}, {measured} Hz named {nodes:?}: no mode near it has these nodal lines, it is held against one{}; look at \
                 this mode's shape again, its constants are in doubt",
                test.pieces[set.piece].name,
                met.map_or(String::new(), |line| format!(" with {:?}", line.nodes)),
            ));
        }
    }
    Ok(notes)
}

/// What is said where nothing tells how far the frequencies scatter.
fn assumed_scatter(problem: &FrequencyProblem, at: &Linearised) -> Option<String> {
    let is_in_part = problem.structure.shown() == Shown::InPart;
    (is_in_part && problem.constants.count() > 0 && residual_variance(problem, at) == 0.0).then(|| {
        format!(
            "no frequency is left over to tell how far they scatter: standard deviations take {} % of each; state the \
             bins (resolution) or measure more modes",
            100.0 * USUAL_SCATTER
        )
    })
}

/// Every constant in the structure's order, those of single pieces behind the shared one.
///
/// `std` has the standard deviation of each parameter, as far as the data tell it.
pub(crate) fn identified_constants(
    test: &ImpactTest,
    constants: &FreeConstants,
    found: &[f64],
    std: &[Option<f64>],
) -> Vec<IdentifiedConstant> {
    let mut list = Vec::new();
    for (index, constant) in constants.constants.iter().enumerate() {
        let entry = |piece: Option<usize>, value: f64, std: Option<f64>, held: bool| IdentifiedConstant {
            name: constant.name,
            unit: constant.unit,
            value,
            std,
            held,
            piece: piece.map(|piece| test.pieces[piece].name.clone()),
        };
        let free = constants.free.iter().enumerate().filter(|(_, free)| free.constant == index);
        let before = list.len();
        for (parameter, free) in free {
            let value = constants.value(parameter, found[parameter]);
            let std = std.get(parameter).copied().flatten().map(|std| std * constants.slope(index, value));
            list.push(entry(free.piece, value, std, false));
        }
        if list.len() == before {
            list.push(entry(None, constants.values(found, 0)[index], None, true));
        }
    }
    list
}

fn piece_fits(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    predictions: &[SetPrediction],
) -> Result<Vec<PieceFit>, IdentifyError> {
    let mut fits: Vec<PieceFit> = test.pieces.iter().map(PieceFit::of).collect();
    for (set, predicted) in problem.sets.iter().zip(predictions) {
        let frequencies: Vec<f64> = predicted.modes.iter().map(|mode| mode.frequency).collect();
        let numbers = set.modes.numbers(&predicted.values, &frequencies)?;
        for (index, (((&measured, model), mode), &nodes)) in
            set.measured.iter().zip(frequencies).zip(numbers).zip(set.modes.nodes()).enumerate()
        {
            let measured_std = set.rounding.get(index).copied();
            fits[set.piece].modes.push(ModeFit { mode, nodes, measured, measured_std, model, damping: None });
        }
    }
    Ok(fits)
}
