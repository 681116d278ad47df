//! What a plate shows across its width and a beam does not.

use orthopanel_model::{ModeRange, Ports};

use super::list_problem::ListProblem;
use crate::Identification;

/// Modes are looked for up to this part of the highest frequency measured.
const FURTHER: f64 = 1.3;
/// Twisting modes that are named, at most.
const NAMED: usize = 3;

/// Where the plate's modes that bend across or twist lie, on the widest piece.
pub(super) fn words(problem: &ListProblem, plate: &Identification, beams: &str) -> String {
    let usual = format!("hit and measure on a line across the width: a plate bends or twists there, {beams} does not");
    let width = |index: usize| problem.lists[index].setting.piece.width;
    let Some(widest) = (0..problem.lists.len()).max_by(|&a, &b| width(a).total_cmp(&width(b))) else { return usual };
    let list = &problem.lists[widest];
    let Some(fit) = plate.pieces.get(list.piece) else { return usual };
    let model = plate.panel_model(fit, list.setting.boundary, Ports { forces: vec![], responses: vec![] });
    let top = list.measured.iter().copied().fold(0.0, f64::max);
    let Ok(modes) = model.modes(ModeRange::UpTo(FURTHER * top)) else { return usual };
    let across = |count: usize| {
        let own = modes.iter().filter(move |mode| !mode.is_rigid() && mode.nodes()[1] == count);
        own.map(|mode| (mode.frequency(), mode.nodes())).collect::<Vec<_>>()
    };
    let (twisting, bending) = (across(1), across(2));
    let half = 0.5 * list.setting.piece.width;
    let place =
        format!("on piece {}, hit and measure along an edge, y = {half:.3} m, and on the centre line", fit.name);
    let of_twist = twisting.iter().take(NAMED).map(|(frequency, _)| format!("{frequency:.0}")).collect::<Vec<_>>();
    let twist = if of_twist.is_empty() {
        "no twisting mode".to_owned()
    } else {
        format!("twisting modes near {} Hz, which the edge shows", of_twist.join(", "))
    };
    let bend = match bending.first() {
        Some((frequency, [along, across])) => {
            format!(
                "a mode that bends across (nodes {along} along, {across} across) near {frequency:.0} Hz, which the centre line shows too"
            )
        }
        None => format!("no mode that bends across below {:.0} Hz", FURTHER * top),
    };
    format!("{place}: the plate has {bend}, and {twist}; {beams} has no peaks there")
}
