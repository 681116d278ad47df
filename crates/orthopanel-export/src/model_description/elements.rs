//! Elements and attributes that both versions write alike.

use std::io;

use orthopanel_fmu::{Dependency, Factor, UNITS, Variable};
use quick_xml::Writer;

pub(super) type Xml = Writer<Vec<u8>>;

/// What both versions say of a variable in the same words; `reference` is by which importers know it.
pub(super) fn common_attributes(variable: &Variable, reference: u32) -> Vec<(&'static str, String)> {
    let quantity = variable.quantity;
    let mut attributes = vec![
        ("name", variable.name.clone()),
        ("valueReference", reference.to_string()),
        ("description", variable.description.clone()),
        ("causality", quantity.causality().into()),
        ("variability", variable.variability().into()),
    ];
    attributes.extend(quantity.initial().map(|initial| ("initial", initial.into())));
    attributes
}

/// Unit, nominal and start value of a variable, and of which state it is the derivative (`state` names that).
pub(super) fn value_attributes(variable: &Variable, state: Option<String>) -> Vec<(&'static str, String)> {
    let texts = [
        ("unit", variable.unit.map(String::from)),
        ("displayUnit", variable.unit.and_then(display_unit)),
        ("nominal", variable.nominal.map(|nominal| format!("{nominal:e}"))),
        ("start", variable.start.clone()),
        ("derivative", state),
    ];
    texts.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
}

fn display_unit(name: &str) -> Option<String> {
    UNITS.iter().find(|unit| unit.name == name)?.display.map(|(shown, _)| shown.into())
}

/// An element without content.
pub(super) fn empty(xml: &mut Xml, element: &str, attributes: &[(&str, String)]) -> io::Result<()> {
    let attributes = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(element).with_attributes(attributes).write_empty()?;
    Ok(())
}

/// An unknown of the model structure: `id` names it, `on` what it depends on, each with the kind; where there is none, on nothing.
pub(super) fn unknown(xml: &mut Xml, element: &str, id: (&str, String), on: &[(String, Factor)]) -> io::Result<()> {
    let names: Vec<&str> = on.iter().map(|(name, _)| name.as_str()).collect();
    let kinds: Vec<&str> = on.iter().map(|(_, factor)| factor.name()).collect();
    let mut attributes = vec![id, ("dependencies", names.join(" "))];
    if !on.is_empty() {
        attributes.push(("dependenciesKind", kinds.join(" ")));
    }
    empty(xml, element, &attributes)
}

/// What an unknown depends on. While the FMU is initialized, the standard has no more to say of a dependency than that it is there.
pub(super) fn dependencies(variable: &Variable, initial: bool) -> Vec<Dependency> {
    let whole = |&reference: &u32| Dependency { reference, factor: Factor::Dependent };
    if initial { variable.initial_dependencies.iter().map(whole).collect() } else { variable.dependencies.clone() }
}
