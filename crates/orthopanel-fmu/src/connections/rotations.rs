//! Couples at the force ports, and rotations at the response ports.
//!
//! A couple acts as a bracket brings it in, by two forces a thickness $t$ apart, $\pm M/t$, and a rotation is the slope between the same two
//! places, $\theta_x = [w(y+t/2) - w(y-t/2)]/t$ and $\theta_y = -[w(x+t/2) - w(x-t/2)]/t$: so power in is the couple times the rate of the
//! rotation, and reciprocity holds. On a plate a couple at a mere point would turn it without bound. At an edge the pair moves onto the
//! panel. A beam turns about y alone.

use orthopanel_model::{DeflectionRow, ModelError, Piece, Place, RigidMotion};

use super::{Layout, Load, MovedBy, Output, Setting, Signal};

/// The slope of a rotation about this axis.
#[cold]
fn row(piece: &Piece, place: Place, motion: RigidMotion) -> DeflectionRow {
    let thickness = piece.thickness;
    let pair = |at: f64, size: f64| {
        let half = 0.5 * thickness.min(size);
        let at = at.clamp(half - 0.5 * size, 0.5 * size - half);
        [at - half, at + half]
    };
    let terms = if motion == RigidMotion::AboutX {
        let [low, high] = pair(place.y, piece.width);
        let weight = 1.0 / (high - low);
        vec![(Place { y: high, ..place }, weight), (Place { y: low, ..place }, -weight)]
    } else {
        let [low, high] = pair(place.x, piece.length);
        let weight = 1.0 / (high - low);
        vec![(Place { x: high, ..place }, -weight), (Place { x: low, ..place }, weight)]
    };
    DeflectionRow { terms, resonators: vec![] }
}

#[cold]
pub(super) fn join(setting: &Setting, layout: &mut Layout) -> Result<(), ModelError> {
    if !setting.connections.rotations {
        return Ok(());
    }
    let (piece, ports, names) = (&setting.model.piece, &setting.model.ports, setting.names);
    let axes = setting.model.rigid_motions().iter().filter(|motion| **motion != RigidMotion::AlongZ);
    let axes: Vec<(RigidMotion, &str)> =
        axes.map(|&motion| (motion, if motion == RigidMotion::AboutX { "x" } else { "y" })).collect();
    let at =
        |place: &Place, axis: &str| format!("about +{axis} at x = {} m, y = {} m from the centre", place.x, place.y);
    for (port, place) in ports.forces.iter().enumerate() {
        for &(motion, axis) in &axes {
            let text = described!(
                "Couple {}, by two forces a thickness apart. Held over each step, or linear, as forces are",
                at(place, axis)
            );
            let name = format!("moment_{axis}_{}", names.force(port));
            layout.input(name, "N.m", text, Load::Works(row(piece, *place, motion)));
        }
    }
    for (port, place) in ports.responses.iter().enumerate() {
        for &(motion, axis) in &axes {
            let response = layout.response(row(piece, *place, motion));
            let kinds = [
                ("rotation", "rad", "rotation", Signal::Displacement(response)),
                ("angular_velocity", "rad/s", "rate of rotation", Signal::Velocity(response)),
            ];
            for (word, unit, what, signal) in kinds {
                layout.outputs.push(Output {
                    name: format!("{word}_{axis}_{}", names.response(port)),
                    unit,
                    description: described!(
                        "The panel's {what} {}, between two places a thickness apart",
                        at(place, axis)
                    ),
                    terms: vec![(signal, 1.0)],
                    moved_by: MovedBy::Response(port),
                });
            }
        }
    }
    Ok(())
}
