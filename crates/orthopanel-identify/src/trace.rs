//! Closing the loop: the effect that the base model lacks, by name.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::StructureKind;

use crate::IdentifyError;
use crate::answer::answer;
use crate::outcome::{Progress, Tracing, Verdict};
use crate::tracing::{check_declared, trace_by_fits};

/// Names the effect that the base model of a test lacks, from its records or its natural frequencies. Effects that the test
/// file declares are part of the base model.
///
/// Hits of one beam are judged by their measured modes, as [`infer`](crate::infer) does. Lists of natural frequencies and files of
/// accelerances are fitted number by number and line by line, with each effect in turn.
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
    // The base of every trace is a beam: of a plate it would judge another model than the one that the file declares.
    if test.structure == Some(StructureKind::MindlinPlate) {
        return Err(IdentifyError::PlateNotTraced);
    }
    let hits = |data: &MeasurementData| matches!(data, MeasurementData::TimeHistory(_));
    let tracing = if test.pieces.len() == 1 && test.measurements.iter().all(|measurement| hits(&measurement.data)) {
        trace_hits(test, progress)?
    } else {
        trace_by_fits(test, progress)?
    };
    tracing.finite()
}

/// Effects that measured modes are not asked for.
const BY_LINES: [&str; 3] = ["viscoelastic-core", "width-coupling", "cubic-stiffness"];

/// By measured modes; by lines what these do not take, and where they leave something that one of [`BY_LINES`] explains.
fn trace_hits(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    check_declared(test)?;
    let by_modes = match answer(test, progress) {
        Err(IdentifyError::Unsupported(_) | IdentifyError::TooFewResonances { .. }) => {
            return trace_by_fits(test, progress);
        }
        answered => answered?,
    };
    if by_modes.verdict != Verdict::Unexplained {
        return Ok(by_modes);
    }
    let by_lines = trace_by_fits(test, progress).ok();
    let named = by_lines.filter(|by_lines| {
        let is_sure = matches!(by_lines.verdict, Verdict::Explained | Verdict::Ambiguous);
        is_sure && by_lines.effects.iter().any(|effect| BY_LINES.contains(&effect.id))
    });
    Ok(named.unwrap_or(by_modes))
}
