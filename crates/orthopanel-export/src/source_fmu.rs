//! An FMU of C99 sources: fixed parameters, co-simulation, for targets that no library is built for.
//!
//! The C is that of `sources/`, the numbers are written for each model. It takes the runtime's own steps, so that both give the same
//! numbers but for the order of sums.

use std::fmt::Write as _;

use orthopanel_fmu::{Quantity, Resource, VariableTable, content_token};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::archive::{Entry, pack};
use crate::{ExportError, FmiVersion, Fmu, model_description};

const FMI2_CO_SIMULATION: &[(&str, &str)] = &[
    ("canHandleVariableCommunicationStepSize", "true"),
    ("canInterpolateInputs", "false"),
    ("maxOutputDerivativeOrder", "0"),
    ("canRunAsynchronuously", "false"),
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canNotUseMemoryManagementFunctions", "true"),
    ("canGetAndSetFMUstate", "false"),
    ("canSerializeFMUstate", "false"),
    ("providesDirectionalDerivative", "false"),
];
const FMI3_CO_SIMULATION: &[(&str, &str)] = &[
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canGetAndSetFMUState", "false"),
    ("canSerializeFMUState", "false"),
    ("providesDirectionalDerivatives", "false"),
    ("providesAdjointDerivatives", "false"),
    ("canHandleVariableCommunicationStepSize", "true"),
    ("maxOutputDerivativeOrder", "0"),
    ("hasEventMode", "false"),
];
const PANEL_H: &str = include_str!("../sources/panel.h");
const PANEL_C: &str = include_str!("../sources/panel.c");
const FMI2_C: &str = include_str!("../sources/fmi2.c");
const FMI3_C: &str = include_str!("../sources/fmi3.c");

impl Fmu {
    /// Bytes of an FMU of the same inputs and outputs that is to be compiled: C99 with no library but libm, one block of memory an instance.
    /// Its parameters are fixed as exported, and arrays are variables each.
    ///
    /// # Errors
    /// [`ExportError::Assemble`], should the archive not take an entry.
    pub fn to_source_bytes(&self) -> Result<Vec<u8>, ExportError> {
        let (resource, options) = (&self.resource_in_scalars, &self.options);
        let table = resource.variables().without_states();
        let model = numbers(resource, &table);
        let token = content_token(format!("{model}{PANEL_C}{PANEL_H}").as_bytes());
        let (interface, entries) = match options.version {
            FmiVersion::Fmi2 => (("CoSimulation", FMI2_CO_SIMULATION), ("fmi2.c", FMI2_C)),
            FmiVersion::Fmi3 => (("CoSimulation", FMI3_CO_SIMULATION), ("fmi3.c", FMI3_C)),
        };
        let files = [entries.0];
        // FMI 3.0 lists them in a file of their own.
        let listed = if options.version == FmiVersion::Fmi2 { &files[..] } else { &[] };
        let written = (options, token.as_str(), self.experiment);
        let description = model_description::write_with(table, (vec![interface], listed), written)?;
        let build = build_description(&options.name, &files)?;
        let model = header(resource, &token) + &model + "\n#endif\n";
        let text = |path: &str, content| Entry { path: path.into(), content, executable: false };
        let mut archive = vec![
            text("modelDescription.xml", description.as_bytes()),
            text("documentation/index.html", PAGE.as_bytes()),
            text("documentation/Reference.csv", self.reference.table.as_bytes()),
            text("documentation/Reference.opt", self.reference.settings.as_bytes()),
            text("sources/panel.h", PANEL_H.as_bytes()),
            text("sources/panel.c", PANEL_C.as_bytes()),
            text("sources/model.h", model.as_bytes()),
        ];
        let entries = (format!("sources/{}", entries.0), entries.1);
        archive.push(text(&entries.0, entries.1.as_bytes()));
        if options.version == FmiVersion::Fmi3 {
            archive.push(text("sources/buildDescription.xml", build.as_bytes()));
        }
        pack(&archive)
    }
}

const PAGE: &str = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Source FMU</title></head><body>
<h1>Source FMU</h1>\n<p>The panel as C99 in sources/, for co-simulation. It needs no library but libm and takes one block of memory an \
instance, when it is instantiated. A new size of step costs the coefficients of all modes, and of coupled modes (mounts, dampers of effects) \
a matrix exponential: on a target in real time take the first step before the run. Parameters are fixed as exported. Inputs are held at \
the values set over each step, but for bases under mounts, which go on at their velocities; with force_linear they run linearly to these. <a href=\"Reference.csv\">Reference.csv</a> has a run to check a compiler \
by.</p>\n</body></html>\n";

/// The start of `model.h`: sizes and types.
fn header(resource: &Resource, token: &str) -> String {
    let model = resource.model();
    let coupled = i32::from(!(model.damping_coupling().is_empty() && model.stiffness_coupling().is_empty()));
    let table = resource.variables().without_states();
    format!(
        "/* Written for one model. */\n#ifndef MODEL_H\n#define MODEL_H\n\n#include <stddef.h>\n\n#define TOKEN \"{token}\"\n\
         #define MODES {}\n#define INPUTS {}\n#define RESPONSES {}\n#define VARIABLES {}u\n#define COUPLED {coupled}\n#define BASES {}\n\n\
         /* An input, by its place in `first`, or an output, the sum of some terms. */\n\
         typedef struct {{ int is_input; size_t first, count; }} Variable;\n\
         /* Of a response: 0 acceleration, 1 velocity, 2 displacement; 3 is an input. */\n\
         typedef struct {{ int kind; size_t index; double weight; }} Term;\n\n\
",
        model.modes().len().max(1),
        model.force_count(),
        model.response_count(),
        table.variables().len() - BEFORE,
        resource.bases().len()
    )
}

/// `time` and `force_linear`.
const BEFORE: usize = 2;

type Tables = (Vec<(bool, usize, usize)>, Vec<(u8, usize, f64)>);

/// Inputs and outputs behind `force_linear`: is it an input, its place or first term, and how many; and all terms.
fn tables(resource: &Resource, table: &VariableTable) -> Tables {
    let (mut rows, mut terms) = (Vec::new(), Vec::new());
    for variable in table.variables().iter().skip(BEFORE) {
        let own = match variable.quantity {
            Quantity::Input(input) => {
                rows.push((true, input, 0));
                continue;
            }
            Quantity::Acceleration(port) => vec![(0, port, 1.0)],
            Quantity::Velocity(port) => vec![(1, port, 1.0)],
            Quantity::Displacement(port) => vec![(2, port, 1.0)],
            Quantity::Connected(output) => resource.connected_terms(output),
            _ => vec![],
        };
        rows.push((false, terms.len(), own.len()));
        terms.extend(own);
    }
    (rows, terms)
}

/// The rest of it: the numbers.
fn numbers(resource: &Resource, table: &VariableTable) -> String {
    let model = resource.model();
    // Without a mode there is one that nothing moves and nothing sees.
    let silent = orthopanel_model::Mode {
        angular_frequency: 0.0,
        damping_ratio: 0.0,
        at_forces: vec![0.0; model.force_count()],
        at_responses: vec![0.0; model.response_count()],
    };
    let modes = if model.modes().is_empty() { std::slice::from_ref(&silent) } else { model.modes() };
    let mut text = String::new();
    let row = |values: &[f64]| values.iter().map(|value| format!("{value:e}")).collect::<Vec<_>>().join(", ");
    let list = |of: &dyn Fn(&orthopanel_model::Mode) -> f64| row(&modes.iter().map(of).collect::<Vec<f64>>());
    let rows =
        |rows: Vec<&[f64]>| rows.into_iter().map(|own| format!("    {{{}}}", row(own))).collect::<Vec<_>>().join(",\n");
    // Writing to a String has nothing to fail on.
    let _ = writeln!(text, "static const double OMEGA[MODES] = {{{}}};", list(&|mode| mode.angular_frequency));
    let _ = writeln!(text, "static const double ZETA[MODES] = {{{}}};", list(&|mode| mode.damping_ratio));
    let inputs = rows(modes.iter().map(|mode| mode.at_forces.as_slice()).collect());
    let responses = rows(modes.iter().map(|mode| mode.at_responses.as_slice()).collect());
    let _ = writeln!(text, "static const double AT_INPUTS[MODES][INPUTS] = {{\n{inputs}\n}};");
    let _ = writeln!(text, "static const double AT_RESPONSES[MODES][RESPONSES] = {{\n{responses}\n}};");
    let couplings = [("DAMPING", model.damping_coupling()), ("STIFFNESS", model.stiffness_coupling())];
    if couplings.iter().any(|(_, coupling)| !coupling.is_empty()) {
        let none = vec![0.0; modes.len()];
        for (name, coupling) in couplings {
            let own = (0..modes.len()).map(|mode| coupling.get(mode).map_or(none.as_slice(), Vec::as_slice));
            let _ = writeln!(text, "static const double {name}[MODES][MODES] = {{\n{}\n}};", rows(own.collect()));
        }
    }
    let bases = resource.bases().into_iter();
    let bases =
        bases.map(|[displacement, velocity]| format!("{{{displacement}, {velocity}}}")).collect::<Vec<_>>().join(", ");
    let _ = writeln!(
        text,
        "/* Inputs: displacement and velocity of the base under each mount. */\n#if BASES > 0\nstatic const size_t BASE[BASES][2] = {{{bases}}};\n#endif"
    );
    let (variables, terms) = tables(resource, table);
    let of_variable =
        |&(is_input, first, count): &(bool, usize, usize)| format!("    {{{}, {first}, {count}}}", i32::from(is_input));
    let of_term = |&(kind, index, weight): &(u8, usize, f64)| format!("    {{{kind}, {index}, {weight:e}}}");
    let variables = variables.iter().map(of_variable).collect::<Vec<_>>().join(",\n");
    let count = terms.len();
    let terms = terms.iter().map(of_term).collect::<Vec<_>>().join(",\n");
    let _ = writeln!(text, "static const Variable TABLE[VARIABLES] = {{\n{variables}\n}};");
    let _ = writeln!(text, "static const Term TERMS[{count}] = {{\n{terms}\n}};");
    text
}

/// `buildDescription.xml` of FMI 3.0.
fn build_description(name: &str, files: &[&str]) -> Result<String, ExportError> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None))).and_then(|()| {
        xml.create_element("fmiBuildDescription").with_attribute(("fmiVersion", "3.0")).write_inner_content(|xml| {
            let configuration = xml.create_element("BuildConfiguration").with_attribute(("modelIdentifier", name));
            configuration.write_inner_content(|xml| {
                xml.create_element("SourceFileSet").with_attribute(("language", "C99")).write_inner_content(|xml| {
                    files.iter().try_for_each(|file| {
                        xml.create_element("SourceFile").with_attribute(("name", *file)).write_empty().map(drop)
                    })
                })?;
                xml.create_element("Library").with_attributes([("name", "m"), ("external", "true")]).write_empty()?;
                Ok(())
            })?;
            Ok(())
        })?;
        Ok(())
    });
    written.map_err(|error: std::io::Error| ExportError::Assemble(error.to_string()))?;
    String::from_utf8(xml.into_inner())
        .map(|text| text + "\n")
        .map_err(|error| ExportError::Assemble(error.to_string()))
}
