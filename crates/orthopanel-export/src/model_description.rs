//! `modelDescription.xml`: elements in the order of the standard's schema, one file for each version.

mod fmi2;
mod fmi3;

use std::io;

use orthopanel_fmu::{LOG_CATEGORIES, Resource, UNITS, VariableTable};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::{ExportError, FmiVersion, FmuOptions};

type Xml = Writer<Vec<u8>>;

/// What the XML says.
struct Description<'a> {
    options: &'a FmuOptions,
    token: &'a str,
    variables: VariableTable,
    /// Step size and stop time that suit the model \[s\].
    experiment: (f64, f64),
}

/// The text of the file.
pub(crate) fn write(resource: &Resource, options: &FmuOptions, token: &str) -> Result<String, ExportError> {
    let description = Description { options, token, variables: resource.variables(), experiment: experiment(resource) };
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written =
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None))).and_then(|()| match options.version {
            FmiVersion::Fmi2 => fmi2::write(&mut xml, &description),
            FmiVersion::Fmi3 => fmi3::write(&mut xml, &description),
        });
    written.map_err(|error| ExportError::Assemble(error.to_string()))?;
    let text = String::from_utf8(xml.into_inner()).map_err(|error| ExportError::Assemble(error.to_string()))?;
    Ok(text + "\n")
}

/// A step of at most a twentieth of the shortest period (1, 2 or 5 times a power of ten), and a thousand steps.
fn experiment(resource: &Resource) -> (f64, f64) {
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

fn units(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("UnitDefinitions").write_inner_content(|xml| {
        for unit in UNITS {
            xml.create_element("Unit").with_attribute(("name", unit.name)).write_inner_content(|xml| {
                let exponents = unit.exponents.iter().map(|&(base, power)| (base, power.to_string()));
                let mut element = xml.create_element("BaseUnit");
                for (base, power) in exponents {
                    element = element.with_attribute((base, power.as_str()));
                }
                element.write_empty().map(drop)
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

fn default_experiment(xml: &mut Xml, (step, stop): (f64, f64)) -> io::Result<()> {
    let (step, stop) = (step.to_string(), stop.to_string());
    let attributes = [("startTime", "0"), ("stopTime", stop.as_str()), ("stepSize", step.as_str())];
    xml.create_element("DefaultExperiment").with_attributes(attributes).write_empty()?;
    Ok(())
}

/// `dependencies` and `dependenciesKind`: an output without entries says that it depends on nothing.
fn dependencies(names: &[String]) -> Vec<(&'static str, String)> {
    let mut attributes = vec![("dependencies", names.join(" "))];
    if !names.is_empty() {
        attributes.push(("dependenciesKind", vec!["dependent"; names.len()].join(" ")));
    }
    attributes
}
