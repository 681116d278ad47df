//! `modelDescription.xml`: elements in the order of the standard's schema, one file for each version.

mod description;
mod elements;
mod fmi2;
mod fmi3;

use std::io;

use orthopanel_fmu::{GENERATOR, LOG_CATEGORIES, Resource, UNITS, Unit, VariableTable};
use orthopanel_model::printable;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::{ExportError, FmiVersion, FmuOptions};
use description::Description;
pub(crate) use description::Interfaces;
use elements::{Xml, empty};

/// The text of the file.
pub(crate) fn write(resource: &Resource, options: &FmuOptions, token: &str) -> Result<String, ExportError> {
    let interfaces = match options.version {
        FmiVersion::Fmi2 => fmi2::INTERFACES.to_vec(),
        FmiVersion::Fmi3 => fmi3::INTERFACES.to_vec(),
    };
    write_with(resource.variables(), (interfaces, &[]), (options, token, experiment(resource)))
}

/// The same of these variables and interfaces; `files` are the sources of the co-simulation, which FMI 2.0 lists here.
pub(crate) fn write_with(
    variables: VariableTable,
    (interfaces, files): (Interfaces, &[&str]),
    (options, token, experiment): (&FmuOptions, &str, (f64, f64)),
) -> Result<String, ExportError> {
    let description = Description { options, token, variables, interfaces, experiment };
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = xml
        .write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))
        .and_then(|()| root(&mut xml, &description, files));
    written.map_err(|error| ExportError::Assemble(error.to_string()))?;
    let text = String::from_utf8(xml.into_inner()).map_err(|error| ExportError::Assemble(error.to_string()))?;
    Ok(text + "\n")
}

/// All elements; the versions differ in attributes, in how a variable is written and in the model structure.
fn root(xml: &mut Xml, description: &Description, files: &[&str]) -> io::Result<()> {
    let (version, token, last) = match description.options.version {
        FmiVersion::Fmi2 => ("2.0", "guid", Some(("numberOfEventIndicators", "0"))),
        FmiVersion::Fmi3 => ("3.0", "instantiationToken", None),
    };
    let (name, told) = (printable(&description.options.name), printable(&description.options.description));
    let attributes = [
        ("fmiVersion", version),
        ("modelName", &*name),
        (token, description.token),
        ("description", &*told),
        ("generationTool", GENERATOR),
        ("variableNamingConvention", "flat"),
    ];
    xml.create_element("fmiModelDescription").with_attributes(attributes.into_iter().chain(last)).write_inner_content(
        |xml| {
            for (element, flags) in &description.interfaces {
                let attributes = [("modelIdentifier", &*name)].into_iter().chain(flags.iter().copied());
                let element = xml.create_element(*element).with_attributes(attributes);
                if files.is_empty() {
                    element.write_empty()?;
                } else {
                    element.write_inner_content(|xml| sources(xml, files))?;
                }
            }
            units(xml, &description.variables)?;
            log_categories(xml)?;
            default_experiment(xml, description.experiment)?;
            match description.options.version {
                FmiVersion::Fmi2 => {
                    let variables = description.variables.variables();
                    xml.create_element("ModelVariables")
                        .write_inner_content(|xml| variables.iter().try_for_each(|v| fmi2::variable(xml, v)))?;
                    xml.create_element("ModelStructure")
                        .write_inner_content(|xml| fmi2::structure(xml, description))?;
                }
                FmiVersion::Fmi3 => {
                    xml.create_element("ModelVariables")
                        .write_inner_content(|xml| fmi3::variables(xml, &description.variables))?;
                    xml.create_element("ModelStructure")
                        .write_inner_content(|xml| fmi3::structure(xml, description))?;
                }
            }
            Ok(())
        },
    )?;
    Ok(())
}

fn sources(xml: &mut Xml, files: &[&str]) -> io::Result<()> {
    xml.create_element("SourceFiles").write_inner_content(|xml| {
        files
            .iter()
            .try_for_each(|file| xml.create_element("File").with_attribute(("name", *file)).write_empty().map(drop))
    })?;
    Ok(())
}

/// A step of at most a twentieth of the shortest period (1, 2 or 5 times a power of ten), and a thousand steps.
pub(crate) fn experiment(resource: &Resource) -> (f64, f64) {
    let highest = resource.model().modes().iter().map(|mode| mode.angular_frequency).fold(0.0, f64::max);
    let period = if highest > 0.0 { std::f64::consts::TAU / highest } else { 1.0 };
    // Kept to sizes that print as numbers, should a frequency be next to zero or beyond all sense.
    let most = period.clamp(1e-9, 1e9) / 20.0;
    let exponent = most.log10().floor() as i32;
    let mantissa = [5, 2, 1].into_iter().find(|&digit| decimal(digit, exponent) <= most).unwrap_or(1);
    (decimal(mantissa, exponent), decimal(mantissa, exponent.saturating_add(3)))
}

/// The number that reads `digit`e`exponent`, so that it is printed as short as it reads.
fn decimal(digit: u8, exponent: i32) -> f64 {
    format!("{digit}e{exponent}").parse().unwrap_or(f64::from(digit))
}

/// Units that only an FMU with a variable in them defines; all others stand in each.
const OF_CONNECTIONS: [&str; 6] = ["N/m", "N.s/m", "N.m", "rad", "rad/s", "rad/s2"];

fn units(xml: &mut Xml, variables: &VariableTable) -> io::Result<()> {
    let used = |unit: &Unit| variables.variables().iter().any(|variable| variable.unit == Some(unit.name));
    let defined = UNITS.into_iter().filter(|unit| !OF_CONNECTIONS.contains(&unit.name) || used(unit));
    xml.create_element("UnitDefinitions").write_inner_content(|xml| {
        for unit in defined {
            let element = xml.create_element("Unit").with_attribute(("name", unit.name));
            if unit.exponents.is_empty() {
                element.write_empty()?;
                continue;
            }
            element.write_inner_content(|xml| {
                let exponents = unit.exponents.iter().map(|&(base, power)| (base, power.to_string()));
                empty(xml, "BaseUnit", &exponents.collect::<Vec<_>>())?;
                unit.display.map_or(Ok(()), |(name, factor)| {
                    empty(xml, "DisplayUnit", &[("name", name.into()), ("factor", format!("{factor:e}"))])
                })
            })?;
        }
        Ok(())
    })?;
    Ok(())
}

fn log_categories(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("LogCategories").write_inner_content(|xml| {
        for (name, description) in LOG_CATEGORIES {
            let attributes = [("name", name), ("description", description)];
            xml.create_element("Category").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Of an integrator in model exchange, beside the nominals of the states.
const TOLERANCE: &str = "1e-6";

fn default_experiment(xml: &mut Xml, (step, stop): (f64, f64)) -> io::Result<()> {
    let (step, stop) = (step.to_string(), stop.to_string());
    let attributes =
        [("startTime", "0"), ("stopTime", stop.as_str()), ("tolerance", TOLERANCE), ("stepSize", step.as_str())];
    xml.create_element("DefaultExperiment").with_attributes(attributes).write_empty()?;
    Ok(())
}
