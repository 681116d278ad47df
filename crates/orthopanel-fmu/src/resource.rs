//! The one resource of an FMU: `resources/panel.json`, modes and ports, so that exporting needs no compiler.

use std::fmt::Write as _;
use std::path::Path;

use orthopanel_model::{CoreFit, ModalModel, ModalStepper, Mode, ModeRange, ModelError, PanelModel, Ports};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::connections::{Connections, Input, Layout, Output, Signal, value};
use crate::panel::{Panel, Solution};
use crate::{FmuError, PortNames, Residual};

/// The file's name in `resources/`.
pub const RESOURCE_FILE: &str = "panel.json";

/// What the file says it is; a library reads one schema alone.
pub const RESOURCE_SCHEMA: &str = "orthopanel.fmu/6";

/// Program and version, as FMUs name the tool that made them.
pub const GENERATOR: &str = concat!("orthopanel ", env!("CARGO_PKG_VERSION"));

/// Modes of a resource at most, internal variables of a core counted: a panel has a thousand and a few ([`ModeRange::MOST`]). Whoever
/// writes a file may claim any number, and each takes memory and a part of every step.
const MOST_MODES: usize = 10_000;

/// What an FMU holds: the modes, and the places of its ports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Resource {
    schema: String,
    /// Program and version that wrote it: part of the token, since another version may order variables otherwise.
    generator: String,
    ports: Ports,
    names: PortNames,
    /// Without the mounts.
    model: ModalModel,
    /// The panel itself, where modes may be solved again.
    panel: Option<Panel>,
    /// Whether importers see all forces as one array, and likewise each kind of output (FMI 3.0).
    arrays: bool,
    /// What joins the panel to its surroundings, as exported.
    #[serde(skip)]
    layout: Option<Layout>,
    /// The modes on the mounts, where there are some.
    #[serde(skip)]
    mounted: Option<ModalModel>,
}

impl Resource {
    /// Joins modes with the places of their ports. Nothing of the panel can be set.
    ///
    /// # Errors
    /// [`FmuError::ResourceText`] where the numbers of places and ports differ, and for more than 10,000 modes.
    pub fn new(model: ModalModel, ports: Ports) -> Result<Self, FmuError> {
        let (schema, generator) = (RESOURCE_SCHEMA.into(), GENERATOR.into());
        let names = PortNames::default();
        let (layout, mounted) = (None, None);
        Self { schema, generator, ports, names, model, panel: None, arrays: false, layout, mounted }.checked()
    }

    /// The modes of `range` of a panel, and unless `residual` is none the residual modes of its force ports, which stand for all others. Sizes,
    /// mass, constants, damping ratios and places can be set in the FMU. With it, how a viscoelastic core's modulus is fitted, where there
    /// is one.
    ///
    /// # Errors
    /// [`FmuError::Model`] where the panel has no physical meaning or cannot be solved.
    pub fn of_panel(
        panel: &PanelModel,
        range: ModeRange,
        ports: Ports,
        residual: Residual,
        connections: Connections,
    ) -> Result<(Self, Option<CoreFit>), FmuError> {
        let (panel, solution) = Panel::new(panel, range, ports.clone(), residual, connections)?;
        let Solution { free: model, core, .. } = solution;
        let (schema, generator) = (RESOURCE_SCHEMA.into(), GENERATOR.into());
        let names = PortNames::default();
        let (layout, mounted) = (None, None);
        let panel = Some(panel);
        let resource = Self { schema, generator, ports, names, model, panel, arrays: false, layout, mounted };
        Ok((resource.checked()?, core))
    }

    /// The same with ports of these names, whatever variables come of them.
    pub(crate) fn renamed(self, names: PortNames) -> Result<Self, FmuError> {
        Self { names, ..self }.checked()
    }

    /// Names of the ports.
    pub fn names(&self) -> &PortNames {
        &self.names
    }

    /// The same with all forces as one array and each kind of output as another, which FMI 3.0 alone has.
    #[must_use]
    pub fn in_arrays(self) -> Self {
        Self { arrays: true, ..self }
    }

    pub(crate) fn arrays(&self) -> bool {
        self.arrays
    }

    /// The modes, on the mounts.
    pub fn model(&self) -> &ModalModel {
        self.mounted.as_ref().unwrap_or(&self.model)
    }

    /// The modes by themselves: without the mounts.
    pub(crate) fn free(&self) -> &ModalModel {
        &self.model
    }

    /// The modes as the ports alone see them, without the mounts, the other connections and the frame's motion.
    ///
    /// # Errors
    /// None, unless the resource is none.
    pub fn panel_alone(&self) -> Result<ModalModel, ModelError> {
        let (forces, responses) = (self.ports.forces.len(), self.ports.responses.len());
        let frame = self.frame_motions();
        let some = |values: &[f64], count: usize| values.iter().take(count).copied().collect();
        let modes = self.model.modes().iter().skip(frame).map(|mode| Mode {
            at_forces: some(&mode.at_forces, forces),
            at_responses: some(&mode.at_responses, responses),
            ..*mode
        });
        let model = ModalModel::new(forces, responses, modes.collect())?;
        if self.model.damping_coupling().is_empty() {
            return Ok(model);
        }
        let coupling = self.model.damping_coupling().iter().skip(frame);
        model.with_damping_coupling(coupling.map(|row| row.iter().skip(frame).copied().collect()).collect())
    }

    /// Inputs of connections, behind the forces.
    pub(crate) fn inputs(&self) -> &[Input] {
        self.layout.as_ref().map_or(&[], |layout| &layout.inputs)
    }

    /// Outputs of connections.
    pub(crate) fn outputs(&self) -> &[Output] {
        self.layout.as_ref().map_or(&[], |layout| &layout.outputs)
    }

    /// The value of an output of a connection, as exported, of modes under these inputs.
    pub fn connected(&self, output: usize, stepper: &ModalStepper, inputs: &[f64]) -> Option<f64> {
        value(&self.outputs().get(output)?.terms, stepper, inputs)
    }

    /// Of each mount, where its base's displacement and velocity stand among the inputs.
    pub fn bases(&self) -> Vec<[usize; 2]> {
        let springs = self.layout.iter().flat_map(|layout| &layout.springs);
        springs.map(|spring| [spring.displacement, spring.velocity]).collect()
    }

    /// What an output of a connection is made of: kind (0 acceleration, 1 velocity, 2 displacement of a response, 3 an input), which of these, and
    /// its weight.
    pub fn connected_terms(&self, output: usize) -> Vec<(u8, usize, f64)> {
        let terms = self.outputs().get(output).map_or(&[][..], |output| &output.terms);
        let kind = |&(signal, weight): &(Signal, f64)| match signal {
            Signal::Acceleration(of) => (0, of, weight),
            Signal::Velocity(of) => (1, of, weight),
            Signal::Displacement(of) => (2, of, weight),
            Signal::Input(of) => (3, of, weight),
        };
        terms.iter().map(kind).collect()
    }

    /// Coordinates of the frame's own motion, before all modes.
    pub fn frame_motions(&self) -> usize {
        self.layout.as_ref().map_or(0, |layout| layout.frame.len())
    }

    /// What joins the panel to its surroundings.
    pub fn connections(&self) -> Option<&Connections> {
        self.panel.as_ref().map(Panel::connections)
    }

    /// Flexible modes that are kept; of a panel with a core its own, without the internal variables.
    pub fn flexible_modes(&self) -> usize {
        self.panel.as_ref().map_or_else(|| self.model.flexible().count(), Panel::flexible_modes)
    }

    /// Places of forces and responses.
    pub fn ports(&self) -> &Ports {
        &self.ports
    }

    /// Residual modes of the force ports, behind all others.
    pub fn residual_modes(&self) -> usize {
        self.panel.as_ref().map_or(0, Panel::residual_modes)
    }

    /// The panel, where its modes may be solved again.
    pub(crate) fn panel(&self) -> Option<&Panel> {
        self.panel.as_ref()
    }

    /// Text of the file; the same content gives the same text.
    pub fn to_json(&self) -> String {
        // Every field is a plain number, text or list: serialisation has nothing to fail on.
        serde_json::to_string(self).unwrap_or_default() + "\n"
    }

    /// Reads the resource from the folder `resources`, if it is the one that `token` belongs to.
    ///
    /// # Errors
    /// [`FmuError::ResourceMissing`], [`FmuError::Token`], [`FmuError::ResourceText`].
    #[cold]
    pub fn read(resources: &Path, token: &str) -> Result<Self, FmuError> {
        let path = resources.join(RESOURCE_FILE);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(source) => return Err(FmuError::ResourceMissing { path, source }),
        };
        let found = content_token(&bytes);
        if token != found {
            return Err(FmuError::Token { path, given: token.into(), found });
        }
        let resource: Self =
            serde_json::from_slice(&bytes).map_err(|error| FmuError::ResourceText(error.to_string()))?;
        resource.checked()
    }

    #[cold]
    fn checked(self) -> Result<Self, FmuError> {
        if self.schema != RESOURCE_SCHEMA {
            let message = format!("schema = {:?}: this library reads {RESOURCE_SCHEMA:?}", self.schema);
            return Err(FmuError::ResourceText(message));
        }
        self.names.check()?;
        let modes = self.model.modes().len();
        if modes > MOST_MODES {
            let message = format!("{modes} modes: a panel has {MOST_MODES} at most");
            return Err(FmuError::ResourceText(message));
        }
        let model = self.model.checked()?;
        if let Some(panel) = &self.panel {
            panel.check_resource(&model, &self.ports)?;
        }
        let layout = self.panel.as_ref().map(|panel| panel.layout(&self.names)).transpose()?;
        let of_ports = (self.ports.forces.len(), self.ports.responses.len());
        let places = layout.as_ref().map_or(of_ports, Layout::counts);
        let counts = (model.force_count(), model.response_count());
        if places != counts {
            return Err(FmuError::ResourceText(format!(
                "places of {} inputs and {} responses for a model of {} and {}",
                places.0, places.1, counts.0, counts.1
            )));
        }
        let springs = layout.as_ref().filter(|layout| !layout.springs.is_empty());
        let mounted = springs.map(|layout| layout.mounted(&model)).transpose()?;
        Ok(Self { model, layout, mounted, ..self })
    }
}

/// The FMI 2 `guid` and FMI 3 `instantiationToken` of a resource's text: the start of its SHA-256, written as a GUID.
///
/// The content is its own token: a damaged or exchanged file is noticed before anything is read from it.
pub fn content_token(resource: &[u8]) -> String {
    let mut token = String::from("{");
    for (index, byte) in Sha256::digest(resource).iter().take(16).enumerate() {
        if matches!(index, 4 | 6 | 8 | 10) {
            token.push('-');
        }
        // Writing to a String has nothing to fail on.
        let _ = write!(token, "{byte:02x}");
    }
    token + "}"
}
