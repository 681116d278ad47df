//! What only FMI 3.0 says: variables in elements of their type, and names by their value reference.

use std::io;

use orthopanel_fmu::{FMI3_CO_SIMULATION, FMI3_MODEL_EXCHANGE, Variable};

use super::{Description, Unknown, Xml, common_attributes, empty, unknown, value_attributes};

pub(super) const INTERFACES: [(&str, &[(&str, &str)]); 2] =
    [("ModelExchange", FMI3_MODEL_EXCHANGE), ("CoSimulation", FMI3_CO_SIMULATION)];

pub(super) fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let mut attributes = common_attributes(variable);
    attributes.extend(value_attributes(variable, variable.derivative_of.map(|state| state.to_string())));
    empty(xml, if variable.unit.is_some() { "Float64" } else { "Boolean" }, &attributes)
}

pub(super) fn structure(xml: &mut Xml, description: &Description) -> io::Result<()> {
    let mut element = |element: &str, variable: &Variable, initial| {
        let on = if initial { &variable.initial_dependencies } else { &variable.dependencies };
        let names: Vec<String> = on.iter().map(u32::to_string).collect();
        unknown(xml, element, ("valueReference", variable.reference.to_string()), &names, initial)
    };
    for (kind, variable) in description.unknowns() {
        match kind {
            Unknown::Output => element("Output", variable, false)?,
            Unknown::Derivative => element("ContinuousStateDerivative", variable, false)?,
        }
    }
    // All of them are calculated from forces and states, at the start as later.
    description.unknowns().try_for_each(|(_, variable)| element("InitialUnknown", variable, true))
}
