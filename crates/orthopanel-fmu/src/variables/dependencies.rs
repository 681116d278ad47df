//! What an output or a derivative of a state depends on at once. An importer that is told too much sees algebraic
//! loops where there are none.

use std::collections::HashMap;

use orthopanel_model::{ModalModel, Mode};

use super::{Quantity, Variable};

/// Fills in the dependencies of every variable, in rising order.
pub(super) fn fill(variables: &mut [Variable], model: &ModalModel) {
    let references: HashMap<_, _> = variables.iter().map(|variable| (variable.quantity, variable.reference)).collect();
    for variable in variables {
        let knowns = knowns(variable.quantity, model);
        variable.dependencies = knowns.iter().filter_map(|known| references.get(known).copied()).collect();
        variable.dependencies.sort_unstable();
        variable.dependencies.dedup();
    }
}

/// Inputs and states, some perhaps more than once.
fn knowns(quantity: Quantity, model: &ModalModel) -> Vec<Quantity> {
    let modes = model.modes().iter().enumerate();
    let seen = |response: usize| modes.filter(move |(_, mode)| is_set(&mode.at_responses, response));
    match quantity {
        Quantity::Displacement(port) => seen(port).map(|(mode, _)| Quantity::ModalPosition(mode)).collect(),
        Quantity::Velocity(port) => seen(port).map(|(mode, _)| Quantity::ModalVelocity(mode)).collect(),
        Quantity::Acceleration(port) => seen(port).flat_map(|(index, mode)| of_acceleration(index, mode)).collect(),
        Quantity::ModalPositionRate(mode) => vec![Quantity::ModalVelocity(mode)],
        Quantity::ModalVelocityRate(index) => {
            model.modes().get(index).map(|mode| of_acceleration(index, mode)).unwrap_or_default()
        }
        _ => Vec::new(),
    }
}

/// $\ddot a = \sum_k W(x_k)f_k - 2\zeta\omega\dot a - \omega^2a$: the terms that are there.
fn of_acceleration(index: usize, mode: &Mode) -> Vec<Quantity> {
    let forces = (0..mode.at_forces.len()).filter(|&port| is_set(&mode.at_forces, port)).map(Quantity::Force);
    let elastic = (mode.angular_frequency > 0.0).then_some(Quantity::ModalPosition(index));
    let damping = (mode.angular_frequency * mode.damping_ratio > 0.0).then_some(Quantity::ModalVelocity(index));
    forces.chain(elastic).chain(damping).collect()
}

fn is_set(values: &[f64], port: usize) -> bool {
    values.get(port).is_some_and(|&value| value != 0.0)
}
