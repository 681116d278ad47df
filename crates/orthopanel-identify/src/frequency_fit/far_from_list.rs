//! A list that no plate meets: what was found is refused, with the lines to look at.

use orthopanel_data::{ImpactTest, MeasurementData};

use super::minimum::Minimum;
use super::other_starts::cost;
use super::problem::FrequencyProblem;
use crate::IdentifyError;
use crate::structures::{self, Shown};

/// Relative error, rms, at which constants are none: the name of a mode is wrong, or a size. What a plate lacks is a few per
/// cent.
const FAR: f64 = 0.1;
/// The same of a list without shapes, which a single mode of torsion among them bends.
const FAR_WITHOUT_SHAPES: f64 = 0.05;

fn error_percent(problem: &FrequencyProblem, found: &Minimum) -> f64 {
    100.0 * (cost(problem, found) / problem.count().max(1) as f64).sqrt()
}

/// Refuses a list without shapes that no plate has as bending modes alone.
pub(super) fn refuse_other_than_bending(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &Minimum,
) -> Result<(), IdentifyError> {
    let error_percent = error_percent(problem, found);
    match read_as_bending(test) {
        Some(names) if error_percent > 100.0 * FAR_WITHOUT_SHAPES => {
            Err(IdentifyError::FarFromList { error_percent, names })
        }
        _ => Ok(()),
    }
}

/// Refuses a plate far from its list; `doubts` are sentences on lines with another name.
pub(super) fn refuse_far_from_list(
    test: &ImpactTest,
    problem: &FrequencyProblem,
    found: &Minimum,
    doubts: &[String],
) -> Result<(), IdentifyError> {
    let error_percent = error_percent(problem, found);
    if error_percent <= 100.0 * FAR {
        return Ok(());
    }
    let limit = found.predictions.iter().find_map(|at| problem.structure.near_limit(&problem.constants, &at.values));
    let names = match (limit, doubts) {
        (Some(limit), _) => limit,
        (None, []) => {
            format!("{}; look at its shape again, and at the sizes of the piece", worst_line(test, problem, found))
        }
        (None, doubts) => doubts.join("; "),
    };
    Err(IdentifyError::FarFromList { error_percent, names })
}

/// How a list of a plate without `shape` was read; `None` where every list has one.
pub(super) fn read_as_bending(test: &ImpactTest) -> Option<String> {
    let shapeless = test.measurements.iter().find(|measurement| match &measurement.data {
        MeasurementData::NaturalFrequencies(data) => data.shape.is_empty(),
        _ => false,
    })?;
    (structures::of_test(test).shown() == Shown::InPart).then(|| {
        format!(
            "the list of piece {} has no `shape`, so it was read as bending modes in rising order ([2, 0], [3, 0], ... of a free \
             plate); with torsion or transverse modes among them give shape = [[nodes_x, nodes_y], ...], a pair a frequency",
            test.pieces[shapeless.piece].name
        )
    })
}

/// The line that is missed most.
fn worst_line(test: &ImpactTest, problem: &FrequencyProblem, found: &Minimum) -> String {
    let lines = problem.sets.iter().zip(&found.predictions).flat_map(|(set, at)| {
        let lines = set.measured.iter().zip(set.modes.nodes()).zip(&at.modes);
        lines.map(|((measured, nodes), mode)| (set.piece, *measured, *nodes, mode.frequency))
    });
    let miss = |line: &(usize, f64, [usize; 2], f64)| (line.3 / line.1).ln().abs();
    let worst = lines.max_by(|a, b| miss(a).total_cmp(&miss(b)));
    worst.map_or(String::new(), |(piece, measured, nodes, model)| {
        format!(
            "piece {}, {measured} Hz named {nodes:?} lies furthest from its mode, at {model:.1} Hz",
            test.pieces[piece].name
        )
    })
}
