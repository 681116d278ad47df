//! What an output or a derivative of a state depends on at once. An importer that is told too much sees algebraic
//! loops where there are none.

use std::collections::HashMap;

use orthopanel_model::{ModalModel, Mode};

use super::dependency::{Dependency, Factor};
use super::quantity::Quantity;
use super::variable::Variable;
use crate::Resource;
use crate::connections::{MovedBy, Signal, Terms};
use crate::panel::{Panel, Part};

/// Fills in the dependencies of every variable, in rising order.
pub(super) fn fill(variables: &mut [Variable], resource: &Resource) {
    let references: HashMap<_, _> = variables.iter().map(|variable| (variable.quantity, variable.reference)).collect();
    let parameter = |variable: &Variable| matches!(variable.quantity, Quantity::Parameter(_));
    let parameters: Vec<u32> = variables.iter().filter(|v| parameter(v)).map(|v| v.reference).collect();
    let parts = resource.panel().map(Panel::parts).unwrap_or_default();
    for variable in variables {
        let mut knowns = knowns(variable.quantity, resource);
        let mut initial: Vec<u32> = knowns.iter().filter_map(|(known, _)| references.get(known).copied()).collect();
        // The rate of a modal coordinate is the modal velocity, whatever the panel.
        if !knowns.is_empty() && !matches!(variable.quantity, Quantity::ModalPositionRate(_)) {
            initial.extend(&parameters);
        }
        initial.sort_unstable();
        initial.dedup();
        variable.initial_dependencies = initial;
        let moving = parts.iter().enumerate().filter(|(_, part)| moves(part, variable.quantity, resource));
        knowns.extend(moving.map(|(index, _)| (Quantity::Parameter(index), Factor::Dependent)));
        let named = |(known, factor)| references.get(&known).map(|&reference| Dependency { reference, factor });
        variable.dependencies = knowns.into_iter().filter_map(named).collect();
        variable.dependencies.sort_unstable();
        variable.dependencies.dedup();
    }
}

/// Inputs and states, some perhaps more than once.
///
/// Where the modes may be solved again, a port that now lies on a node may move away from it: then all count, and shapes at
/// ports and damping are tunable.
fn knowns(quantity: Quantity, resource: &Resource) -> Vec<(Quantity, Factor)> {
    let any = resource.panel().is_some();
    let moving = if any { Factor::Tunable } else { Factor::Fixed };
    // Nothing but its own acceleration moves the frame.
    let frame = resource.frame_motions();
    let model = resource.model();
    let modes = || model.modes().iter().enumerate();
    let seen = |response: usize| modes().filter(move |(_, mode)| any || is_set(&mode.at_responses, response));
    let accelerated = |response: usize| {
        seen(response).flat_map(|(index, mode)| {
            of_acceleration(index, mode, any && index >= frame).into_iter().chain(coupled(index, model, resource))
        })
    };
    let all = |quantities: Vec<Quantity>| quantities.into_iter().map(|known| (known, moving)).collect();
    match quantity {
        Quantity::Displacement(port) => all(seen(port).map(|(mode, _)| Quantity::ModalPosition(mode)).collect()),
        Quantity::Velocity(port) => all(seen(port).map(|(mode, _)| Quantity::ModalVelocity(mode)).collect()),
        Quantity::Acceleration(port) => all(accelerated(port).collect()),
        Quantity::Connected(output) => {
            let none = Terms::new();
            let terms = resource.outputs().get(output).map_or(&none, |output| &output.terms);
            let of = |signal: Signal| -> Vec<Quantity> {
                match signal {
                    Signal::Displacement(at) => seen(at).map(|(mode, _)| Quantity::ModalPosition(mode)).collect(),
                    Signal::Velocity(at) => seen(at).map(|(mode, _)| Quantity::ModalVelocity(mode)).collect(),
                    Signal::Acceleration(at) => accelerated(at).collect(),
                    Signal::Input(input) => vec![Quantity::Input(input)],
                }
            };
            all(terms.iter().flat_map(|(signal, _)| of(*signal)).collect())
        }
        Quantity::ModalPositionRate(mode) => vec![(Quantity::ModalVelocity(mode), Factor::Fixed)],
        Quantity::ModalVelocityRate(index) => {
            let own = model
                .modes()
                .get(index)
                .map(|mode| of_acceleration(index, mode, any && index >= frame))
                .unwrap_or_default();
            let all = own.into_iter().chain(coupled(index, model, resource));
            // The stiffness of a mode is neither its damping's matter nor a port's; a mount adds to it.
            let mounted = !model.stiffness_coupling().is_empty();
            let fixed = |known| known == Quantity::ModalPosition(index) && !mounted;
            let factor = |known| if fixed(known) { Factor::Fixed } else { moving };
            all.map(|known| (known, factor(known))).collect()
        }
        _ => Vec::new(),
    }
}

/// $\ddot a = \sum_k W(x_k)f_k - 2\zeta\omega\dot a - \omega^2a$: the terms that are there, or may come to be.
fn of_acceleration(index: usize, mode: &Mode, any: bool) -> Vec<Quantity> {
    let forces = (0..mode.at_forces.len()).filter(|&port| any || is_set(&mode.at_forces, port)).map(Quantity::Input);
    let flexible = mode.angular_frequency > 0.0;
    let elastic = flexible.then_some(Quantity::ModalPosition(index));
    let damping = (flexible && (any || mode.damping_ratio > 0.0)).then_some(Quantity::ModalVelocity(index));
    forces.chain(elastic).chain(damping).collect()
}

/// All modes, where mounts join them; else modal velocities that dampers of an effect hand on to a mode, or may where damping ratios are
/// set: each mode with effects holds several bare ones.
fn coupled(index: usize, model: &ModalModel, resource: &Resource) -> impl Iterator<Item = Quantity> {
    let panel = resource.panel();
    let size = model.modes().len();
    // Nothing but its acceleration moves the frame.
    let joined = !model.stiffness_coupling().is_empty() && index >= resource.frame_motions();
    let mounted = (0..size).filter(move |_| joined);
    let mounted = mounted.flat_map(|other| [Quantity::ModalPosition(other), Quantity::ModalVelocity(other)]);
    // Residual modes are by themselves.
    let count = size - panel.map_or(0, Panel::residual_modes);
    let flexible = model.modes().get(index).is_some_and(|mode| index < count && mode.angular_frequency > 0.0);
    let damped = !resource.free().damping_coupling().is_empty();
    let any = flexible && (damped || panel.is_some_and(Panel::has_effects));
    let others = model.modes().iter().take(count).enumerate();
    let others = others.filter(move |(_, mode)| any && mode.angular_frequency > 0.0);
    mounted.chain(others.map(|(other, _)| Quantity::ModalVelocity(other)))
}

/// Whether a quantity changes at once where this part of the panel is set while the simulation runs.
fn moves(part: &Part, quantity: Quantity, resource: &Resource) -> bool {
    let Some(panel) = resource.panel().filter(|panel| !(panel.is_beam() && part.is_along_y())) else { return false };
    let of_response = |port: usize| [Part::ResponseX(port), Part::ResponseY(port)].contains(part);
    match quantity {
        Quantity::Displacement(port) | Quantity::Velocity(port) => of_response(port),
        Quantity::Acceleration(port) => {
            of_response(port) || part.is_of_force() || part.is_damping() || part.mount().is_some()
        }
        Quantity::Connected(output) => {
            let loads = || part.is_of_force() || part.is_damping() || part.mount().is_some();
            resource.outputs().get(output).is_some_and(|output| match output.moved_by {
                MovedBy::Response(port) => of_response(port),
                MovedBy::Mount(mount) => part.mount() == Some(mount),
                MovedBy::Loads => loads(),
            })
        }
        Quantity::ModalVelocityRate(index) => {
            let modes = resource.model().modes();
            if index < resource.frame_motions() {
                return false;
            }
            let rigid = modes.iter().take_while(|mode| mode.angular_frequency == 0.0).count();
            let residual = index + panel.residual_modes() >= modes.len();
            let own = if residual { Part::ResidualDamping } else { Part::Damping(index.saturating_sub(rigid)) };
            let damps = part.is_damping() && index >= rigid;
            part.is_of_force() || part.mount().is_some() || damps && (panel.has_effects() && !residual || *part == own)
        }
        _ => false,
    }
}

fn is_set(values: &[f64], port: usize) -> bool {
    values.get(port).is_some_and(|&value| value != 0.0)
}
