//! What only FMI 2.0 says: variables in two elements each, and names by their place in the list, from 1.

use std::io;

use orthopanel_fmu::{FMI2_CO_SIMULATION, FMI2_MODEL_EXCHANGE, Variable};

use super::description::{Description, Unknown};
use super::elements::{Xml, common_attributes, dependencies, empty, unknown, value_attributes};

pub(super) const INTERFACES: [(&str, &[(&str, &str)]); 2] =
    [("ModelExchange", FMI2_MODEL_EXCHANGE), ("CoSimulation", FMI2_CO_SIMULATION)];

pub(super) fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let attributes = common_attributes(variable, variable.reference);
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element("ScalarVariable").with_attributes(attributes).write_inner_content(|xml| {
        let kind = if variable.unit.is_some() { "Real" } else { "Boolean" };
        empty(xml, kind, &value_attributes(variable, variable.derivative_of.map(index)))
    })?;
    Ok(())
}

pub(super) fn structure(xml: &mut Xml, description: &Description) -> io::Result<()> {
    let lists = [
        ("Outputs", Some(Unknown::Output)),
        ("Derivatives", Some(Unknown::Derivative)),
        // All of them are calculated from forces and states, at the start as later.
        ("InitialUnknowns", None),
    ];
    for (list, only) in lists {
        let unknowns = description.unknowns().filter(|(kind, _)| only.is_none_or(|only| only == *kind));
        let variables: Vec<&Variable> = unknowns.map(|(_, variable)| variable).collect();
        if variables.is_empty() {
            continue;
        }
        xml.create_element(list).write_inner_content(|xml| {
            for variable in variables {
                let initial = only.is_none();
                let mut on = dependencies(variable, initial);
                // Once initialization has ended, FMI 2.0 counts no parameter among what an unknown may depend on (2.2.8).
                on.retain(|on| initial || description.causality(on.reference) != Some("parameter"));
                let on: Vec<_> = on.into_iter().map(|on| (index(on.reference), on.factor)).collect();
                unknown(xml, "Unknown", ("index", index(variable.reference)), &on)?;
            }
            Ok(())
        })?;
    }
    Ok(())
}

/// Place in the list of variables, from 1: as references are.
fn index(reference: u32) -> String {
    reference.to_string()
}
