//! Closing the loop: the effect that the base model lacks, by name.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::StructureKind;

use crate::IdentifyError;
use crate::answer::answer;
use crate::outcome::{Progress, Tracing};
use crate::tracing::{check_declared, trace_by_fits};

/// Names the effect that the base model of a test lacks, from its records or its natural frequencies. Effects that the test
/// file declares are part of the base model.
///
/// Records are fitted line by line, lists number by number, with each effect in turn: for panels that are as their model but for that effect.
/// Of others see [`trace_by_modes`].
///
/// # Errors
/// [`IdentifyError::PlateNotTraced`] for a declared plate; records that cannot be read or show too few resonances, and tests
/// that this version cannot trace.
pub fn trace(test: &ImpactTest) -> Result<Tracing, IdentifyError> {
    trace_with(test, &|_| {})
}

/// [`trace`], telling how far it is. The callback is called from several threads.
///
/// # Errors
/// As [`trace`].
pub fn trace_with(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    check_structure(test)?;
    trace_by_fits(test, progress)?.finite()
}

/// [`trace_with`] for hits of one beam that is as real ones are: not quite its model, by an error that is estimated with the rest. Hypotheses are
/// judged by measured modes, as [`infer`](crate::infer) does.
///
/// # Errors
/// As [`trace`]; [`IdentifyError::Unsupported`] for lists, accelerances and several pieces.
pub fn trace_by_modes(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    check_structure(test)?;
    let hits = |data: &MeasurementData| matches!(data, MeasurementData::TimeHistory(_));
    if test.pieces.len() != 1 || !test.measurements.iter().all(|measurement| hits(&measurement.data)) {
        let message = "a trace by modes of anything but the hits of one piece: trace it by lines";
        return Err(IdentifyError::Unsupported(message.into()));
    }
    check_declared(test)?;
    answer(test, progress)?.finite()
}

/// The base of every trace is a beam: of a plate it would judge another model than the one that the file declares.
fn check_structure(test: &ImpactTest) -> Result<(), IdentifyError> {
    match test.structure {
        Some(StructureKind::MindlinPlate) => Err(IdentifyError::PlateNotTraced),
        _ => Ok(()),
    }
}
