//! `terminalsAndIcons.xml` of FMI 3.0: what belongs together at one place of the panel, so that an importer may connect
//! it at once.

use std::io;

use orthopanel_fmu::Resource;
use orthopanel_model::Place;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::ExportError;

const MOTIONS: [&str; 3] = ["acceleration", "velocity", "displacement"];

/// One terminal: name and variable of each of its members.
struct Terminal {
    name: String,
    description: String,
    members: Vec<(&'static str, String)>,
}

impl Terminal {
    /// Of a place: names of the force and of the response there.
    fn at(place: &Place, force: Option<String>, response: Option<String>) -> Self {
        let motions = response.into_iter().flat_map(|label| MOTIONS.map(|motion| (motion, label.clone())));
        let members = force.map(|label| ("force", label)).into_iter().chain(motions);
        Self {
            name: String::new(),
            description: format!("At x = {} m, y = {} m from the centre", place.x, place.y),
            members: members.map(|(member, label)| (member, format!("{member}_{label}"))).collect(),
        }
    }
}

/// The text of the file.
pub(crate) fn write(resource: &Resource) -> Result<String, ExportError> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None))).and_then(|()| {
        xml.create_element("fmiTerminalsAndIcons").with_attribute(("fmiVersion", "3.0")).write_inner_content(
            |xml| {
                xml.create_element("Terminals").write_inner_content(|xml| {
                    terminals(resource).iter().try_for_each(|terminal| one(xml, terminal))
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

/// Each force with the first response at its place that no other force has, then the responses left over. Of arrays, in which
/// no member can be named by itself, one terminal with all.
fn terminals(resource: &Resource) -> Vec<Terminal> {
    let (ports, names) = (resource.ports(), resource.names());
    let table = resource.variables();
    if !table.arrays().is_empty() {
        let members = table.arrays().iter().map(|array| (array.name, array.name.to_owned())).collect();
        let description = "All forces, and all motions of the panel, in the order of the places".into();
        return vec![Terminal { name: "places".into(), description, members }];
    }
    let mut left: Vec<usize> = (0..ports.responses.len()).collect();
    let mut list = Vec::new();
    for (force, place) in ports.forces.iter().enumerate() {
        let same = left.iter().position(|&response| ports.responses.get(response) == Some(place));
        let response = same.map(|position| left.remove(position));
        list.push(Terminal::at(place, Some(names.force(force)), response.map(|response| names.response(response))));
    }
    for response in left {
        let Some(place) = ports.responses.get(response) else { continue };
        list.push(Terminal::at(place, None, Some(names.response(response))));
    }
    list.iter_mut().zip(1..).for_each(|(terminal, number)| terminal.name = format!("place_{number}"));
    list
}

fn one(xml: &mut Writer<Vec<u8>>, terminal: &Terminal) -> io::Result<()> {
    // A bus joins what both sides have: a sensor has no force, a hammer no motion.
    let attributes =
        [("name", terminal.name.as_str()), ("matchingRule", "bus"), ("description", &terminal.description)];
    xml.create_element("Terminal").with_attributes(attributes).write_inner_content(|xml| {
        for (member, variable) in &terminal.members {
            let attributes = [("variableName", variable.as_str()), ("memberName", member), ("variableKind", "signal")];
            xml.create_element("TerminalMemberVariable").with_attributes(attributes).write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}
