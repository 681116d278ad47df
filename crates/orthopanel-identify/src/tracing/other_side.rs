//! The other side of the panel: a place and its mirror image change every frequency of an even panel alike.
//!
//! What parts them is how the peaks' sizes and the lines between them change. A search that has come down on the wrong side finds
//! no way across, for each place between changes the frequencies.

use super::fit::{Fit, fit};
use super::hypothesis::{Hypothesis, is_place};
use super::record_problem::State;
use super::records_of_test::TestRecords;

/// Widening from which the other side is followed: there the constants and the damping give way to the new place.
const FROM: usize = 1;

/// Puts the best of the fits on the other side where that fits better. `declared` effects stay where the file puts them.
pub(super) fn turn_round(records: &TestRecords, fits: &mut [Fit], declared: usize) {
    let best = fits.iter_mut().filter(|fit| fit.given_up.is_none()).min_by(|a, b| a.cost.total_cmp(&b.cost));
    let Some(best) = best else { return };
    for position in declared..best.state.hypothesis.effects.len() {
        let Some(hypothesis) = mirrored(&best.state.hypothesis, position) else { continue };
        let turned = State { hypothesis, ..best.state.clone() };
        match fit(records, turned, FROM) {
            Ok(other) if other.cost < best.cost => *best = other,
            _ => {}
        }
    }
}

/// With the place of one effect on the other side; `None` where it has none that is free.
fn mirrored(hypothesis: &Hypothesis, position: usize) -> Option<Hypothesis> {
    let mut turned = hypothesis.clone();
    let on = turned.effects.get_mut(position)?;
    let at = on.free.iter().find(|free| is_place(&on.effect.parameters()[free.parameter]))?.at;
    on.values[at] = -on.values[at];
    Some(turned)
}
