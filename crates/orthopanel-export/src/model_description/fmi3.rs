//! The description of FMI 3.0.

use std::io;

use orthopanel_fmu::{FMI3_CO_SIMULATION, GENERATOR, MODEL_IDENTIFIER, Quantity, Variable};

use super::{Description, Xml, default_experiment, dependencies, log_categories, units};

pub(super) fn write(xml: &mut Xml, description: &Description) -> io::Result<()> {
    let root = [
        ("fmiVersion", "3.0"),
        ("modelName", &description.options.name),
        ("instantiationToken", description.token),
        ("description", &description.options.description),
        ("generationTool", GENERATOR),
        ("variableNamingConvention", "flat"),
    ];
    xml.create_element("fmiModelDescription").with_attributes(root).write_inner_content(|xml| {
        xml.create_element("CoSimulation")
            .with_attribute(("modelIdentifier", MODEL_IDENTIFIER))
            .with_attributes(FMI3_CO_SIMULATION.iter().copied())
            .write_empty()?;
        units(xml)?;
        log_categories(xml)?;
        default_experiment(xml, description.experiment)?;
        xml.create_element("ModelVariables").write_inner_content(|xml| {
            description.variables.variables().iter().try_for_each(|variable| typed(xml, variable))
        })?;
        structure(xml, description)
    })?;
    Ok(())
}

fn typed(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let reference = variable.reference.to_string();
    let mut attributes = vec![
        ("name", variable.name.as_str()),
        ("valueReference", &reference),
        ("description", &variable.description),
        ("causality", variable.quantity.causality()),
    ];
    attributes.extend(match variable.quantity.causality() {
        "parameter" => vec![("variability", "fixed"), ("initial", "exact")],
        "output" => vec![("variability", "continuous"), ("initial", "calculated")],
        _ => vec![("variability", "continuous")],
    });
    let unit = variable.quantity.unit();
    attributes.extend(unit.map(|unit| ("unit", unit)));
    match variable.quantity {
        Quantity::Force(_) => attributes.push(("start", "0")),
        Quantity::ForceLinear => attributes.push(("start", "false")),
        _ => {}
    }
    let kind = if unit.is_some() { "Float64" } else { "Boolean" };
    xml.create_element(kind).with_attributes(attributes).write_empty()?;
    Ok(())
}

/// Outputs, and as initial unknowns the same again; FMI 3.0 names variables by their value reference.
fn structure(xml: &mut Xml, description: &Description) -> io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        for kind in ["Output", "InitialUnknown"] {
            let variables = description.variables.variables().iter();
            for variable in variables.filter(|variable| variable.quantity.causality() == "output") {
                let names: Vec<String> = variable.dependencies.iter().map(u32::to_string).collect();
                let reference = variable.reference.to_string();
                let mut element = xml.create_element(kind).with_attribute(("valueReference", reference.as_str()));
                for (name, value) in dependencies(&names) {
                    element = element.with_attribute((name, value.as_str()));
                }
                element.write_empty()?;
            }
        }
        Ok(())
    })?;
    Ok(())
}
