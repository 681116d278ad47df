//! An SSP (System Structure and Parameterization 1.0) with one FMU: its connectors, a set of its parameters, and sets drawn from what is
//! known of the panel.
//!
//! Elements, attributes and their order are those of the standard's schema, with the prefix `ssc` for what both files share; the step of a
//! master stands in an annotation, as OMSimulator writes it.

use std::io;

use orthopanel_fmu::{GENERATOR, UNITS, Unit, Variable};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::archive::{Entry, pack};
use crate::{ExportError, Fmu};

type Xml = Writer<Vec<u8>>;

const SSD: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const SSC: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
const SSV: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";
const OMS: &str = "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd";

/// Values of parameters by their names.
pub type ParameterValues = Vec<(String, f64)>;

impl Fmu {
    /// The bytes of an SSP: the FMU as a component of a system whose connectors are the FMU's, `resources/parameters.ssv` with all its
    /// parameters as exported, and `resources/sample-1.ssv`, .. with these values in their places.
    ///
    /// # Errors
    /// [`ExportError::Assemble`], should the archive not take an entry.
    pub fn to_ssp(&self, samples: &[ParameterValues]) -> Result<Vec<u8>, ExportError> {
        let starts: ParameterValues =
            self.parameters().map(|(variable, start)| (variable.name.clone(), start)).collect();
        let structure = text(|xml| self.structure(xml))?;
        let mut files = vec![
            ("SystemStructure.ssd".to_owned(), structure.into_bytes()),
            (format!("resources/{}.fmu", self.name), self.to_bytes()?),
            ("resources/parameters.ssv".into(), self.values("parameters", &starts)?.into_bytes()),
        ];
        for (number, values) in (1..).zip(samples) {
            let value = |(name, start): &(String, f64)| {
                let drawn = values.iter().find(|(other, _)| other == name);
                (name.clone(), drawn.map_or(*start, |(_, value)| *value))
            };
            let (name, values) = (format!("sample-{number}"), starts.iter().map(value).collect::<ParameterValues>());
            let text = self.values(&name, &values)?;
            files.push((format!("resources/{name}.ssv"), text.into_bytes()));
        }
        let entries = files.iter().map(|(path, content)| Entry { path: path.clone(), content, executable: false });
        pack(&entries.collect::<Vec<_>>())
    }

    /// Those that are numbers, with their starts: an importer that sets a Boolean false may have it true (FMPy 0.3.32).
    fn parameters(&self) -> impl Iterator<Item = (&Variable, f64)> {
        let parameters = self.table.variables().iter().filter(|variable| variable.quantity.causality() == "parameter");
        let numbers = parameters.filter(|variable| variable.unit.is_some());
        numbers.filter_map(|variable| Some((variable, variable.start.as_ref()?.parse().ok()?)))
    }

    fn structure(&self, xml: &mut Xml) -> io::Result<()> {
        let name = self.name.as_str();
        let attributes = [
            ("xmlns:ssd", SSD),
            ("xmlns:ssc", SSC),
            ("xmlns:oms", OMS),
            ("name", name),
            ("version", "1.0"),
            ("generationTool", GENERATOR),
        ];
        let (step, stop) = (self.experiment.0.to_string(), self.experiment.1.to_string());
        xml.create_element("ssd:SystemStructureDescription").with_attributes(attributes).write_inner_content(
            |xml| {
                xml.create_element("ssd:System").with_attribute(("name", "system")).write_inner_content(|xml| {
                    self.connectors(xml)?;
                    xml.create_element("ssd:Elements").write_inner_content(|xml| self.component(xml))?;
                    xml.create_element("ssd:Connections").write_inner_content(|xml| self.connections(xml))?;
                    xml.create_element("ssd:Annotations").write_inner_content(|xml| master(xml, &step))?;
                    Ok(())
                })?;
                xml.create_element("ssd:Units")
                    .write_inner_content(|xml| UNITS.iter().try_for_each(|one| unit(xml, one)))?;
                let experiment = [("startTime", "0"), ("stopTime", stop.as_str())];
                xml.create_element("ssd:DefaultExperiment").with_attributes(experiment).write_inner_content(|xml| {
                    xml.create_element("ssd:Annotations").write_inner_content(|xml| results(xml, name))?;
                    Ok(())
                })?;
                Ok(())
            },
        )?;
        Ok(())
    }

    /// Inputs and outputs, array or not.
    fn signals(&self) -> impl Iterator<Item = &Variable> {
        let is_signal = |variable: &&Variable| matches!(variable.quantity.causality(), "input" | "output");
        self.table.variables().iter().filter(is_signal)
    }

    fn connectors(&self, xml: &mut Xml) -> io::Result<()> {
        xml.create_element("ssd:Connectors").write_inner_content(|xml| {
            self.signals().try_for_each(|signal| {
                let attributes = [("name", signal.name.as_str()), ("kind", signal.quantity.causality())];
                xml.create_element("ssd:Connector").with_attributes(attributes).write_inner_content(|xml| {
                    let unit = ("unit", signal.unit.unwrap_or("1"));
                    xml.create_element("ssc:Real").with_attribute(unit).write_empty().map(|_| ())
                })?;
                Ok(())
            })
        })?;
        Ok(())
    }

    fn component(&self, xml: &mut Xml) -> io::Result<()> {
        let source = format!("resources/{}.fmu", self.name);
        let attributes =
            [("name", self.name.as_str()), ("type", "application/x-fmu-sharedlibrary"), ("source", source.as_str())];
        xml.create_element("ssd:Component").with_attributes(attributes).write_inner_content(|xml| {
            self.connectors(xml)?;
            xml.create_element("ssd:ParameterBindings").write_inner_content(|xml| {
                let source = ("source", "resources/parameters.ssv");
                xml.create_element("ssd:ParameterBinding").with_attribute(source).write_empty().map(|_| ())
            })?;
            Ok(())
        })?;
        Ok(())
    }

    /// What goes into the system goes into the panel, and what comes out of this comes out of that.
    fn connections(&self, xml: &mut Xml) -> io::Result<()> {
        self.signals().try_for_each(|signal| {
            let (own, name) = (self.name.as_str(), signal.name.as_str());
            let element = if signal.quantity.causality() == "input" { "endElement" } else { "startElement" };
            let attributes = [("startConnector", name), ("endConnector", name), (element, own)];
            xml.create_element("ssd:Connection").with_attributes(attributes).write_empty().map(|_| ())
        })
    }

    fn values(&self, name: &str, values: &ParameterValues) -> Result<String, ExportError> {
        let unit_of = |name: &str| self.parameters().find(|(variable, _)| variable.name == name)?.0.unit;
        text(|xml| {
            let attributes = [("xmlns:ssv", SSV), ("xmlns:ssc", SSC), ("version", "1.0"), ("name", name)];
            xml.create_element("ssv:ParameterSet").with_attributes(attributes).write_inner_content(|xml| {
                xml.create_element("ssv:Parameters").write_inner_content(|xml| {
                    values.iter().try_for_each(|(name, value)| {
                        let parameter = xml.create_element("ssv:Parameter").with_attribute(("name", name.as_str()));
                        parameter.write_inner_content(|xml| {
                            let value = value.to_string();
                            let attributes = [("value", value.as_str()), ("unit", unit_of(name).unwrap_or("1"))];
                            xml.create_element("ssv:Real").with_attributes(attributes).write_empty().map(|_| ())
                        })?;
                        Ok(())
                    })
                })?;
                xml.create_element("ssv:Units")
                    .write_inner_content(|xml| UNITS.iter().try_for_each(|one| unit(xml, one)))?;
                Ok(())
            })?;
            Ok(())
        })
    }
}

/// A fixed step for OMSimulator's master.
fn master(xml: &mut Xml, step: &str) -> io::Result<()> {
    annotation(xml, |xml| {
        xml.create_element("oms:SimulationInformation").write_inner_content(|xml| {
            let attributes = [
                ("description", "oms-ma"),
                ("stepSize", step),
                ("absoluteTolerance", "1e-6"),
                ("relativeTolerance", "1e-6"),
            ];
            xml.create_element("oms:FixedStepMaster").with_attributes(attributes).write_empty().map(|_| ())
        })?;
        Ok(())
    })
}

/// Where OMSimulator writes results to: without it, it warns of what it calls deprecated.
fn results(xml: &mut Xml, name: &str) -> io::Result<()> {
    annotation(xml, |xml| {
        let file = format!("{name}_res.mat");
        let attributes =
            [("resultFile", file.as_str()), ("loggingInterval", "0"), ("bufferSize", "10"), ("signalFilter", "")];
        xml.create_element("oms:SimulationInformation").with_attributes(attributes).write_empty().map(|_| ())
    })
}

/// OMSimulator's own.
fn annotation(xml: &mut Xml, content: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<()> {
    let kind = ("type", "org.openmodelica");
    xml.create_element("ssc:Annotation").with_attribute(kind).write_inner_content(|xml| {
        xml.create_element("oms:Annotations").write_inner_content(content)?;
        Ok(())
    })?;
    Ok(())
}

/// A unit; those whose exponents the standard cannot say have none.
fn unit(xml: &mut Xml, Unit { name, exponents, .. }: &Unit) -> io::Result<()> {
    xml.create_element("ssc:Unit").with_attribute(("name", *name)).write_inner_content(|xml| {
        let exponents: Vec<(&str, String)> = exponents.iter().map(|&(base, power)| (base, power.to_string())).collect();
        let attributes = exponents.iter().map(|(base, power)| (*base, power.as_str()));
        xml.create_element("ssc:BaseUnit").with_attributes(attributes).write_empty().map(|_| ())
    })?;
    Ok(())
}

fn text(write: impl FnOnce(&mut Xml) -> io::Result<()>) -> Result<String, ExportError> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let declaration = Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None));
    let written = xml.write_event(declaration).and_then(|()| write(&mut xml));
    written.map_err(|error| ExportError::Assemble(error.to_string()))?;
    let text = String::from_utf8(xml.into_inner()).map_err(|error| ExportError::Assemble(error.to_string()))?;
    Ok(text + "\n")
}
