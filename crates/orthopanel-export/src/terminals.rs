//! `terminalsAndIcons.xml` of FMI 3.0: what belongs together at one place of the panel, so that an importer may connect
//! it at once.

use std::io;

use orthopanel_fmu::Resource;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::ExportError;

const MOTIONS: [&str; 3] = ["acceleration", "velocity", "displacement"];

/// One terminal: numbers of the force and of the response at its place, from 1.
struct Terminal {
    force: Option<usize>,
    response: Option<usize>,
    description: String,
}

/// The text of the file.
pub(crate) fn write(resource: &Resource) -> Result<String, ExportError> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None))).and_then(|()| {
        xml.create_element("fmiTerminalsAndIcons").with_attribute(("fmiVersion", "3.0")).write_inner_content(
            |xml| {
                xml.create_element("Terminals").write_inner_content(|xml| {
                    terminals(resource)
                        .iter()
                        .enumerate()
                        .try_for_each(|(index, terminal)| one(xml, index + 1, terminal))
                })?;
                Ok(())
            },
        )?;
        Ok(())
    });
    written.map_err(|error: io::Error| ExportError::Assemble(error.to_string()))?;
    let text = String::from_utf8(xml.into_inner()).map_err(|error| ExportError::Assemble(error.to_string()))?;
    Ok(text + "\n")
}

/// Each force with the first response at its place that no other force has, then the responses left over.
fn terminals(resource: &Resource) -> Vec<Terminal> {
    let ports = resource.ports();
    let mut left: Vec<usize> = (0..ports.responses.len()).collect();
    let mut list = Vec::new();
    for (force, place) in ports.forces.iter().enumerate() {
        let same = left.iter().position(|&response| ports.responses.get(response) == Some(place));
        let response = same.map(|position| left.remove(position));
        let description = format!("At x = {} m, y = {} m from the centre", place.x, place.y);
        list.push(Terminal { force: Some(force + 1), response: response.map(|number| number + 1), description });
    }
    for response in left {
        let Some(place) = ports.responses.get(response) else { continue };
        let description = format!("At x = {} m, y = {} m from the centre", place.x, place.y);
        list.push(Terminal { force: None, response: Some(response + 1), description });
    }
    list
}

fn one(xml: &mut Writer<Vec<u8>>, number: usize, terminal: &Terminal) -> io::Result<()> {
    let name = format!("place_{number}");
    // A bus joins what both sides have: a sensor has no force, a hammer no motion.
    let attributes = [("name", name.as_str()), ("matchingRule", "bus"), ("description", &terminal.description)];
    xml.create_element("Terminal").with_attributes(attributes).write_inner_content(|xml| {
        let force = terminal.force.map(|number| ("force", number));
        let motions = terminal.response.map(|number| MOTIONS.map(|motion| (motion, number)));
        for (member, number) in force.into_iter().chain(motions.into_iter().flatten()) {
            let variable = format!("{member}_{number}");
            let attributes = [("variableName", variable.as_str()), ("memberName", member), ("variableKind", "signal")];
            xml.create_element("TerminalMemberVariable").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}
