//! What an output or a derivative of a state depends on at once. An importer that is told too much sees algebraic
//! loops where there are none.

use std::collections::HashMap;

use orthopanel_model::{ModalModel, Mode};

use super::{Quantity, Variable};
use crate::Resource;

/// Fills in the dependencies of every variable, in rising order.
pub(super) fn fill(variables: &mut [Variable], resource: &Resource) {
    let references: HashMap<_, _> = variables.iter().map(|variable| (variable.quantity, variable.reference)).collect();
    let parameter = |variable: &Variable| matches!(variable.quantity, Quantity::Parameter(_));
    let parameters: Vec<u32> = variables.iter().filter(|v| parameter(v)).map(|v| v.reference).collect();
    for variable in variables {
        let knowns = knowns(variable.quantity, resource);
        variable.dependencies = knowns.iter().filter_map(|known| references.get(known).copied()).collect();
        variable.dependencies.sort_unstable();
        variable.dependencies.dedup();
        variable.initial_dependencies.clone_from(&variable.dependencies);
        // The rate of a modal coordinate is the modal velocity, whatever the panel.
        if !knowns.is_empty() && !matches!(variable.quantity, Quantity::ModalPositionRate(_)) {
            variable.initial_dependencies.extend(&parameters);
        }
    }
}

/// Inputs and states, some perhaps more than once.
///
/// Where the modes may be solved again, a port that now lies on a node may move away from it: then all count.
fn knowns(quantity: Quantity, resource: &Resource) -> Vec<Quantity> {
    let any = resource.panel().is_some();
    let model = resource.model();
    let modes = model.modes().iter().enumerate();
    let seen = |response: usize| modes.filter(move |(_, mode)| any || is_set(&mode.at_responses, response));
    match quantity {
        Quantity::Displacement(port) => {
            let direct = resource.static_remainder().get(port).into_iter().flatten().enumerate();
            let direct = direct.filter(|&(_, &value)| value != 0.0).map(|(force, _)| Quantity::Force(force));
            seen(port).map(|(mode, _)| Quantity::ModalPosition(mode)).chain(direct).collect()
        }
        Quantity::Velocity(port) => seen(port).map(|(mode, _)| Quantity::ModalVelocity(mode)).collect(),
        Quantity::Acceleration(port) => {
            let of_modes = seen(port)
                .flat_map(|(index, mode)| of_acceleration(index, mode, any).into_iter().chain(coupled(index, model)));
            of_modes.collect()
        }
        Quantity::ModalPositionRate(mode) => vec![Quantity::ModalVelocity(mode)],
        Quantity::ModalVelocityRate(index) => {
            let own = model.modes().get(index).map(|mode| of_acceleration(index, mode, any)).unwrap_or_default();
            own.into_iter().chain(coupled(index, model)).collect()
        }
        _ => Vec::new(),
    }
}

/// $\ddot a = \sum_k W(x_k)f_k - 2\zeta\omega\dot a - \omega^2a$: the terms that are there, or may come to be.
fn of_acceleration(index: usize, mode: &Mode, any: bool) -> Vec<Quantity> {
    let forces = (0..mode.at_forces.len()).filter(|&port| any || is_set(&mode.at_forces, port)).map(Quantity::Force);
    let flexible = mode.angular_frequency > 0.0;
    let elastic = flexible.then_some(Quantity::ModalPosition(index));
    let damping = (flexible && (any || mode.damping_ratio > 0.0)).then_some(Quantity::ModalVelocity(index));
    forces.chain(elastic).chain(damping).collect()
}

/// Modal velocities that dampers of an effect hand on to a mode. Only where the panel is there are such effects, and their
/// parameters are none of the FMU's: a coupling that is zero stays so, but for rounding.
fn coupled(index: usize, model: &ModalModel) -> impl Iterator<Item = Quantity> {
    let flexible = model.modes().get(index).is_some_and(|mode| mode.angular_frequency > 0.0);
    let any = flexible && !model.damping_coupling().is_empty();
    let others = model.modes().iter().enumerate().filter(move |(_, mode)| any && mode.angular_frequency > 0.0);
    others.map(|(other, _)| Quantity::ModalVelocity(other))
}

fn is_set(values: &[f64], port: usize) -> bool {
    values.get(port).is_some_and(|&value| value != 0.0)
}
