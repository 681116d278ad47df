//! Modes that the test file may have named wrongly: a wrong name is a wrong equation, and bends all constants.

use orthopanel_data::ImpactTest;
use orthopanel_model::StructureKind;

use super::problem::FrequencyProblem;
use super::structures::SpectrumLine;
use crate::IdentifyError;
use crate::least_squares::{Ending, Linearised, Quadratic, descend};

/// A mode that misses its frequency by less is what it is called, or so near its neighbour that no list can tell.
const LARGE_MISS: f64 = 0.01;
/// Another mode is meant where it misses by less than this part.
const FAR_NEARER: f64 = 0.25;
/// Scatters \[1\] of good lines, in turn: from where wrong ones still pull to what a good model leaves.
const SCATTERS: [f64; 3] = [2e-2, 1e-2, 4e-3];

/// A sentence for each line of a plate's list that lies far from the mode it names and near another.
///
/// The constants are found again under Cauchy's error $\sum\ln(1+r^2/s^2)$, for which a line that stands out counts for
/// little, with those that rest held by what is usual: so some wrong names among more right ones do not hide behind the
/// constants that they bent.
pub(super) fn doubtful_names(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &[f64],
    at: &Linearised,
) -> Result<Vec<String>, IdentifyError> {
    let is_plate = problem.structure == StructureKind::MindlinPlate;
    if !is_plate || at.residuals.iter().all(|residual| residual.abs() < LARGE_MISS) {
        return Ok(Vec::new());
    }
    let (constants, start) = problem.constants.with_resting_freed(found);
    let more = FrequencyProblem { structure: problem.structure, constants, sets: problem.sets.clone() };
    let mut parameters = start.clone();
    for scatter in SCATTERS {
        let nearby =
            more.near(&more.predictions(&parameters)?)?.map_or_else(|| more.on(&more.sets), |sets| more.on(&sets));
        let robust = |trial: &[f64]| -> Result<Quadratic, IdentifyError> {
            Ok(cauchy(&nearby, &nearby.linearise(trial)?, trial, &start, found.len(), scatter))
        };
        let Ok((minimum, _)) = descend(robust, &parameters, &more.constants.bounds(), Ending::WITH_JUMPS) else {
            return Ok(Vec::new());
        };
        parameters = minimum.parameters;
    }
    let mut notes = Vec::new();
    for (set, predicted) in more.sets.iter().zip(more.predictions(&parameters)?) {
        let spectrum = set.modes.spectrum(&predicted.values)?;
        for ((measured, named), &nodes) in set.measured.iter().zip(&predicted.modes).zip(set.modes.nodes()) {
            let miss = |frequency: f64| (frequency / measured - 1.0).abs();
            let nearest = spectrum.iter().min_by(|a, b| miss(a.frequency).total_cmp(&miss(b.frequency)));
            let meant = |line: &&SpectrumLine| {
                let most = LARGE_MISS.min(FAR_NEARER * miss(named.frequency));
                line.nodes != nodes && miss(line.frequency) < most
            };
            let Some(line) = nearest.filter(|_| miss(named.frequency) > LARGE_MISS).filter(meant) else { continue };
            notes.push(format!(
                "piece {}, {measured} Hz named {nodes:?}: the other frequencies put that mode at {:.1} Hz, and {:?} at \
                 {:.1} Hz; look at this mode's shape again",
                test.pieces[set.piece].name, named.frequency, line.nodes, line.frequency
            ));
        }
    }
    Ok(notes)
}

/// Cauchy's error of the lines, and the usual constants' own of those from `free` on.
fn cauchy(
    problem: &FrequencyProblem,
    at: &Linearised,
    parameters: &[f64],
    usual: &[f64],
    free: usize,
    scatter: f64,
) -> Quadratic {
    let count = parameters.len();
    let mut sum = Quadratic::zero(count);
    for (i, residual) in at.residuals.iter().enumerate() {
        let ratio2 = (residual / scatter).powi(2);
        let weight = (1.0 + ratio2).sqrt().recip();
        let row: Vec<(usize, f64)> = (0..count).map(|j| (j, weight * at.jacobian[(i, j)] / scatter)).collect();
        sum.add_row(weight * residual / scatter, &row);
        sum.cost += ratio2.ln_1p() - (weight * residual / scatter).powi(2);
    }
    for j in free..count {
        let std = problem.constants.usual_std(j);
        sum.add_row((parameters[j] - usual[j]) / std, &[(j, std.recip())]);
    }
    sum.mirror();
    sum
}
