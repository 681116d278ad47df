//! What only FMI 2.0 says: variables in two elements each, and names by their place in the list, from 1.

use std::io;

use orthopanel_fmu::{FMI2_CO_SIMULATION, FMI2_MODEL_EXCHANGE, Variable};

use super::{Description, Unknown, Xml, common_attributes, empty, unknown, value_attributes};

pub(super) const INTERFACES: [(&str, &[(&str, &str)]); 2] =
    [("ModelExchange", FMI2_MODEL_EXCHANGE), ("CoSimulation", FMI2_CO_SIMULATION)];

pub(super) fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let attributes = common_attributes(variable);
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
                let on = if initial { &variable.initial_dependencies } else { &variable.dependencies };
                let names: Vec<String> = on.iter().map(|&reference| index(reference)).collect();
                unknown(xml, "Unknown", ("index", index(variable.reference)), &names, initial)?;
            }
            Ok(())
        })?;
    }
    Ok(())
}

/// Place in the list of variables, from 1.
fn index(reference: u32) -> String {
    (u64::from(reference) + 1).to_string()
}
