//! What only FMI 3.0 says: variables in elements of their type, and names by their value reference.

use std::io;

use orthopanel_fmu::{Array, FMI3_CO_SIMULATION, FMI3_MODEL_EXCHANGE, Variable, VariableTable};

use super::description::{Description, Unknown};
use super::elements::{Xml, common_attributes, dependencies, empty, unknown, value_attributes};

pub(super) const INTERFACES: [(&str, &[(&str, &str)]); 2] =
    [("ModelExchange", FMI3_MODEL_EXCHANGE), ("CoSimulation", FMI3_CO_SIMULATION)];

fn variable(xml: &mut Xml, variable: &Variable, table: &VariableTable) -> io::Result<()> {
    let seen = |reference: u32| table.seen(reference);
    let mut attributes = common_attributes(variable, seen(variable.reference));
    attributes.extend(value_attributes(variable, variable.derivative_of.map(|state| seen(state).to_string())));
    empty(xml, if variable.unit.is_some() { "Float64" } else { "Boolean" }, &attributes)
}

/// An array in place of the variables that it holds, which are alike but for their place.
fn array(xml: &mut Xml, array: &Array, first: &Variable, table: &VariableTable) -> io::Result<()> {
    let mut attributes = common_attributes(first, table.seen(first.reference));
    attributes.extend(value_attributes(first, None));
    let size = array.references.len();
    for (name, value) in &mut attributes {
        match *name {
            "name" => *value = array.name.into(),
            "description" => value.clone_from(&array.description),
            "start" => *value = vec![value.as_str(); size].join(" "),
            _ => {}
        }
    }
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element("Float64")
        .with_attributes(attributes)
        .write_inner_content(|xml| empty(xml, "Dimension", &[("start", size.to_string())]))?;
    Ok(())
}

pub(super) fn variables(xml: &mut Xml, table: &VariableTable) -> io::Result<()> {
    table.variables().iter().try_for_each(|one| match table.array_of(one.reference) {
        None => variable(xml, one, table),
        Some(whole) if whole.references.start == one.reference => array(xml, whole, one, table),
        Some(_) => Ok(()),
    })
}

pub(super) fn structure(xml: &mut Xml, description: &Description) -> io::Result<()> {
    let table = &description.variables;
    // An array depends on what any of its elements does.
    let mut element = |element: &str, variable: &Variable, initial| {
        let elements = table
            .array_of(variable.reference)
            .map_or(variable.reference..variable.reference + 1, |array| array.references.clone());
        let all = elements.filter_map(|reference| table.get(reference));
        let mut on: Vec<_> =
            all.flat_map(|one| dependencies(one, initial)).map(|on| (table.seen(on.reference), on.factor)).collect();
        on.sort_unstable();
        on.dedup();
        let on: Vec<_> = on.into_iter().map(|(reference, factor)| (reference.to_string(), factor)).collect();
        unknown(xml, element, ("valueReference", table.seen(variable.reference).to_string()), &on)
    };
    let stands = |reference: u32| table.array_of(reference).is_none_or(|array| array.references.start == reference);
    let unknowns: Vec<_> = description.unknowns().filter(|(_, one)| stands(one.reference)).collect();
    for &(kind, variable) in &unknowns {
        match kind {
            Unknown::Output => element("Output", variable, false)?,
            Unknown::Derivative => element("ContinuousStateDerivative", variable, false)?,
        }
    }
    // All of them are calculated from forces and states, at the start as later.
    unknowns.iter().try_for_each(|(_, variable)| element("InitialUnknown", variable, true))
}
