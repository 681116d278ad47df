//! Where the base model begins, and ends, when the test file leaves numbers of its effects open.

use orthopanel_model::Piece;
use rayon::prelude::*;

use super::{Costed, Look, followed, grid};
use crate::IdentifyError;
use crate::tracing::core_modes::{CORE, CoreModes};
use crate::tracing::fit::{Fit, fit, promise, settle};
use crate::tracing::hypothesis::Switched;
use crate::tracing::record_problem::State;
use crate::tracing::records_of_test::TestRecords;
use crate::tracing::valley::lead_on;

/// The base model at its minimum.
///
/// Open numbers of declared effects are searched as closely as those of the effects that are tried beside them: a base that stopped
/// short of its minimum would leave something for another effect to explain.
///
/// # Errors
/// What the model refuses.
pub(in crate::tracing) fn base_fit(records: &TestRecords) -> Result<Fit, IdentifyError> {
    let base = fit(records, records.start.clone(), 0)?;
    if records.start.hypothesis.size() == 0 {
        return Ok(base);
    }
    let mut led = (base.state, base.cost);
    lead_on(records, &mut led);
    settle(records, led.0, None)
}

/// The start with each declared effect that is open at the best of its starts, one effect after the other.
pub(in crate::tracing) fn begun_where_declared(records: &TestRecords, piece: &Piece) -> State {
    let mut begun = records.start.clone();
    for index in 0..begun.hypothesis.effects.len() {
        let starts = starts_of(records, &begun, index, piece);
        if let Some((state, _)) = followed(records, &starts, 0) {
            begun = state;
        }
    }
    begun
}

/// A state with one of its effects at each of its starts, as it stands too, the most promising on the widest lines first; none where
/// nothing of it is open.
fn starts_of(records: &TestRecords, begun: &State, index: usize, piece: &Piece) -> Vec<Costed> {
    let on = &begun.hypothesis.effects[index];
    if on.free.is_empty() {
        return vec![];
    }
    let problem = records.problem(0);
    let mut without = begun.clone();
    without.hypothesis.effects.remove(index);
    let core = if on.effect.id() == CORE { CoreModes::of(&problem, &without) } else { None };
    let at = |values: Vec<f64>| {
        let mut state = begun.clone();
        state.hypothesis.effects[index] = moved(on, &values);
        // What a core stiffens and takes of energy is in the constants and the damping already.
        match &core {
            Some(modes) => modes.begun(&problem, state, records.band),
            None => state,
        }
    };
    let tried = grid(on.effect, piece, (problem.records.len(), records.band), Look::Usual);
    let costed = |state: State| {
        let promised = promise(&problem.at(&state).ok()?);
        Some((state, promised))
    };
    let mut starts: Vec<Costed> =
        tried.into_par_iter().map(at).chain(rayon::iter::once(begun.clone())).filter_map(costed).collect();
    starts.sort_by(|a, b| a.1.total_cmp(&b.1));
    starts
}

/// An effect with its open numbers at these values, one a parameter.
fn moved(on: &Switched, values: &[f64]) -> Switched {
    let mut moved = on.clone();
    for free in &on.free {
        if let Some(&value) = values.get(free.parameter) {
            moved.values[free.at] = value.clamp(free.range.0, free.range.1);
        }
    }
    moved
}
