//! The description of FMI 2.0.

use std::io;

use orthopanel_fmu::{FMI2_CO_SIMULATION, GENERATOR, MODEL_IDENTIFIER, Quantity, Variable};

use super::{Description, Xml, default_experiment, dependencies, log_categories, units};

pub(super) fn write(xml: &mut Xml, description: &Description) -> io::Result<()> {
    let root = [
        ("fmiVersion", "2.0"),
        ("modelName", &description.options.name),
        ("guid", description.token),
        ("description", &description.options.description),
        ("generationTool", GENERATOR),
        ("variableNamingConvention", "flat"),
        ("numberOfEventIndicators", "0"),
    ];
    xml.create_element("fmiModelDescription").with_attributes(root).write_inner_content(|xml| {
        xml.create_element("CoSimulation")
            .with_attribute(("modelIdentifier", MODEL_IDENTIFIER))
            .with_attributes(FMI2_CO_SIMULATION.iter().copied())
            .write_empty()?;
        units(xml)?;
        log_categories(xml)?;
        default_experiment(xml, description.experiment)?;
        xml.create_element("ModelVariables").write_inner_content(|xml| {
            description.variables.variables().iter().try_for_each(|variable| scalar(xml, variable))
        })?;
        structure(xml, description)
    })?;
    Ok(())
}

fn scalar(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
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
    xml.create_element("ScalarVariable").with_attributes(attributes).write_inner_content(|xml| {
        let element = match variable.quantity.unit() {
            Some(unit) => xml.create_element("Real").with_attribute(("unit", unit)),
            None => xml.create_element("Boolean").with_attribute(("start", "false")),
        };
        let starts = matches!(variable.quantity, Quantity::Force(_));
        let element = if starts { element.with_attribute(("start", "0")) } else { element };
        element.write_empty().map(drop)
    })?;
    Ok(())
}

/// Outputs, and as initial unknowns the same again; FMI 2.0 names variables by their place in the list, from 1.
fn structure(xml: &mut Xml, description: &Description) -> io::Result<()> {
    let index = |reference: u32| (u64::from(reference) + 1).to_string();
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        for list in ["Outputs", "InitialUnknowns"] {
            xml.create_element(list).write_inner_content(|xml| {
                let variables = description.variables.variables().iter();
                for variable in variables.filter(|variable| variable.quantity.causality() == "output") {
                    let names: Vec<String> = variable.dependencies.iter().map(|&reference| index(reference)).collect();
                    let mut element =
                        xml.create_element("Unknown").with_attribute(("index", index(variable.reference).as_str()));
                    for (name, value) in dependencies(&names) {
                        element = element.with_attribute((name, value.as_str()));
                    }
                    element.write_empty()?;
                }
                Ok(())
            })?;
        }
        Ok(())
    })?;
    Ok(())
}
