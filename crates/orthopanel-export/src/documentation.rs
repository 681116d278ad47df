//! `documentation/index.html`: what the FMU holds, for the one who is handed it.

use std::fmt::Write as _;

use orthopanel_fmu::{GENERATOR, Resource};

use crate::{FmiVersion, FmuOptions};

/// The page: variables with their places, modes, and how the force is held.
pub(crate) fn write(resource: &Resource, options: &FmuOptions) -> String {
    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>");
    page += &escaped(&options.name);
    page += "</title></head>\n<body>\n<h1>";
    page += &escaped(&options.name);
    page += "</h1>\n<p>";
    page += &escaped(&options.description);
    page += "</p>\n<h2>Variables</h2>\n<table>\n<tr><th>name</th><th>unit</th><th>kind</th><th>what</th></tr>\n";
    for variable in resource.variables().variables() {
        let unit = variable.quantity.unit().unwrap_or("");
        let (name, kind) = (&variable.name, variable.quantity.causality());
        let what = escaped(&variable.description);
        // Writing to a String has nothing to fail on, here and below.
        let _ = writeln!(page, "<tr><td>{name}</td><td>{unit}</td><td>{kind}</td><td>{what}</td></tr>");
    }
    page += "</table>\n<h2>Force over a step</h2>\n<p>";
    page += HELD;
    if options.version == FmiVersion::Fmi2 {
        page += BY_DERIVATIVES;
    }
    page += LINEAR;
    page += "</p>\n<h2>Modes</h2>\n<p>";
    page += MODES;
    page += "</p>\n<table>\n<tr><th>frequency [Hz]</th><th>damping ratio</th></tr>\n";
    for mode in resource.model().modes() {
        let frequency = mode.angular_frequency / std::f64::consts::TAU;
        let _ = writeln!(page, "<tr><td>{frequency:.3}</td><td>{}</td></tr>", mode.damping_ratio);
    }
    let _ = write!(page, "</table>\n<p>Written by {GENERATOR}.</p>\n</body>\n</html>\n");
    page
}

const HELD: &str = "The force is held at the value set before the step, over the whole step.";
const BY_DERIVATIVES: &str = " If the importer gives the first derivative of a force \
     (fmi2SetRealInputDerivatives), the force of the next step runs at that rate from the value set.";
const LINEAR: &str = " If the parameter force_linear is true, the force of a step runs linearly from its value at the \
     end of the last step to the value now set: set the value of the step's end before the step. Each mode is then \
     advanced exactly, whatever the step.";
const MODES: &str = "Rigid modes have the frequency 0. Outputs are sums over these modes.";

fn escaped(text: &str) -> String {
    quick_xml::escape::escape(text).into_owned()
}
