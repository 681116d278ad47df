//! The frame that holds the edges: its accelerations go in, the panel's motions are absolute, and the frame's reactions come out.
//!
//! The equations stand in `orthopanel_model`'s `uniform_loads`. The frame's own motion $b_r$ is a further coordinate that its acceleration
//! alone drives, $\ddot b_r$, scaled as a mode of the whole panel's inertia: so displacements, velocities and accelerations at every port,
//! and what mounts follow, are absolute without more. A mount's force reaches the frame as any other: the panel gets
//! $-k(w-u)-c(\dot w-v)$ there.

use orthopanel_model::{ModelError, RigidMotion};

use super::{Layout, Load, MovedBy, Output, Setting, Signal};

#[cold]
pub(super) fn join(setting: &Setting, layout: &mut Layout) -> Result<(), ModelError> {
    if !setting.connections.base_acceleration {
        return Ok(());
    }
    let motions = setting.model.rigid_motions();
    let rows = motions.iter().map(|&motion| setting.model.inertia_row(motion, setting.flexible));
    let rows = rows.collect::<Result<Vec<_>, _>>()?;
    // Before the frame's own inputs, which push nothing but what the momentum holds.
    let mut pushes: Vec<_> = motions.iter().map(|&motion| layout.resultants(motion)).collect();
    for (terms, motion) in pushes.iter_mut().zip(motions) {
        for spring in &layout.springs {
            let arm = motion.deflection(spring.at);
            terms.extend([
                (Signal::Displacement(spring.response), -spring.stiffness * arm),
                (Signal::Velocity(spring.response), -spring.damping * arm),
                (Signal::Input(spring.displacement), spring.stiffness * arm),
                (Signal::Input(spring.velocity), spring.damping * arm),
            ]);
        }
    }
    for (&motion, row) in motions.iter().zip(&rows) {
        let (name, unit, what) = match motion {
            RigidMotion::AlongZ => {
                ("base_acceleration", "m/s2", "Acceleration of the frame that holds the edges, along +z")
            }
            RigidMotion::AboutX => (
                "base_angular_acceleration_x",
                "rad/s2",
                "Angular acceleration of the frame about the x axis through the centre",
            ),
            RigidMotion::AboutY => (
                "base_angular_acceleration_y",
                "rad/s2",
                "Angular acceleration of the frame about the y axis through the centre",
            ),
        };
        let text =
            described!("{what}. Held over each step, or linear, as forces are; motions of the panel are absolute");
        layout.input(name.into(), unit, text, Load::Frame(motion, row.clone().scaled(-1.0)));
        layout.frame.push((motion, row.of_rigid(motion)));
    }
    for ((&motion, row), mut terms) in motions.iter().zip(rows).zip(pushes) {
        let momentum = layout.response(row);
        terms.push((Signal::Acceleration(momentum), -1.0));
        let (name, unit, what) = match motion {
            RigidMotion::AlongZ => ("frame_force", "N", "Force of the panel on the frame, along +z"),
            RigidMotion::AboutX => {
                ("frame_moment_x", "N.m", "Moment of the panel on the frame about the x axis through the centre")
            }
            RigidMotion::AboutY => {
                ("frame_moment_y", "N.m", "Moment of the panel on the frame about the y axis through the centre")
            }
        };
        layout.outputs.push(Output {
            name: name.into(),
            unit,
            description: described!("{what}"),
            terms,
            moved_by: MovedBy::Loads,
        });
    }
    Ok(())
}
