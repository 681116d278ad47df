//! `modelDescription.xml` of an FMU: its text is judged before it is parsed, and what it claims before it is believed.

use std::collections::HashMap;

use fmi_rs::SHARED_LIBRARY_EXTENSION;
use fmi_rs::model_description::{fmi2 as description2, fmi3 as description3};
use orthopanel_model::is_identifier;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use roxmltree::{Document, ParsingOptions};

use super::instance::{References, Variable};
use super::{fmi2, fmi3};
use crate::fmu_refusal::{FmuRefusal, limited, shown};

/// Bytes of the file.
pub(super) const MOST_BYTES: u64 = 64 << 20;
/// Bytes of one tag, text or comment.
const LONGEST_PIECE: usize = 1 << 20;
/// Elements and attributes together.
const MOST_PARTS: usize = 1_000_000;
const MOST_ATTRIBUTES: usize = 64;
const DEEPEST: usize = 32;
const MOST_VARIABLES: usize = 50_000;

/// The description of an FMU of a version that can be run.
pub(super) enum Description {
    Fmi2(Box<description2::ModelDescription>),
    Fmi3(Box<description3::ModelDescription>),
}

impl Description {
    pub(super) fn parse(content: &[u8]) -> Result<Self, FmuRefusal> {
        let text = str::from_utf8(content).map_err(|error| FmuRefusal::Description(format!("no UTF-8: {error}")))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        within_limits(text)?;
        // Beside each element there may be a text.
        let nodes_limit = 4 * MOST_PARTS as u32;
        let options = ParsingOptions { allow_dtd: false, nodes_limit, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options).map_err(broken)?;
        let root = document.root_element();
        let version = root.attribute("fmiVersion").filter(|_| root.has_tag_name("fmiModelDescription"));
        let version = version.ok_or_else(|| broken("no element fmiModelDescription with an fmiVersion"))?;
        let description = match version {
            "2.0" => Self::Fmi2(Box::new(description2::ModelDescription::from_node(&root).map_err(broken)?)),
            _ if version.starts_with("3.") => {
                Self::Fmi3(Box::new(description3::ModelDescription::from_node(&root).map_err(broken)?))
            }
            _ => return Err(FmuRefusal::Version(shown(version))),
        };
        let variables = match &description {
            Self::Fmi2(description) => description.modelVariables.len(),
            Self::Fmi3(description) => description.modelVariables.len(),
        };
        limited("a list", variables, MOST_VARIABLES, "variables")?;
        Ok(description)
    }

    /// Path in the archive of the library for co-simulation on this platform.
    pub(super) fn library(&self) -> Result<String, FmuRefusal> {
        let (platform, co_simulation, model_exchange) = match self {
            Self::Fmi2(description) => (
                fmi_rs::fmi2::PLATFORM,
                description.coSimulation.as_ref().map(|kind| &kind.modelIdentifier),
                description.modelExchange.as_ref().map(|kind| &kind.modelIdentifier),
            ),
            Self::Fmi3(description) => (
                fmi_rs::fmi3::native::PLATFORM_TUPLE,
                description.coSimulation.as_ref().map(|kind| &kind.modelIdentifier),
                description.modelExchange.as_ref().map(|kind| &kind.modelIdentifier),
            ),
        };
        if let Some(wrong) = co_simulation.into_iter().chain(model_exchange).find(|name| !is_identifier(name)) {
            return Err(FmuRefusal::Identifier(format!("{:?}", shown(wrong))));
        }
        let identifier = co_simulation.ok_or_else(|| FmuRefusal::Foreign("it has no co-simulation".into()))?;
        Ok(format!("binaries/{platform}/{identifier}{SHARED_LIBRARY_EXTENSION}"))
    }

    pub(super) fn references(&self) -> Result<References, FmuRefusal> {
        let variables: HashMap<&str, Variable> = match self {
            Self::Fmi2(description) => fmi2::variables(description),
            Self::Fmi3(description) => fmi3::variables(description),
        };
        References::find(&variables)
    }
}

/// Whether a parser that keeps the whole tree, and compares the attributes of an element with each other, may read the text.
fn within_limits(text: &str) -> Result<(), FmuRefusal> {
    let mut reader = Reader::from_str(text);
    let (mut parts, mut depth) = (0, 0_usize);
    let attributes = |element: &BytesStart| element.attributes().with_checks(false).take(MOST_ATTRIBUTES + 1).count();
    loop {
        let event = reader.read_event().map_err(broken)?;
        if matches!(event, Event::DocType(_)) {
            return Err(FmuRefusal::DocumentType);
        }
        limited("a piece of modelDescription.xml", event.len(), LONGEST_PIECE, "bytes")?;
        match &event {
            Event::Start(element) | Event::Empty(element) => {
                let attributes = attributes(element);
                limited("an element of modelDescription.xml", attributes, MOST_ATTRIBUTES, "attributes")?;
                parts += 1 + attributes;
                limited("a modelDescription.xml", parts, MOST_PARTS, "elements and attributes")?;
                depth += usize::from(matches!(event, Event::Start(_)));
                limited("a modelDescription.xml", depth, DEEPEST, "levels")?;
            }
            Event::End(_) => depth = depth.saturating_sub(1),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

fn broken(error: impl std::fmt::Display) -> FmuRefusal {
    FmuRefusal::Description(shown(&error.to_string()))
}
