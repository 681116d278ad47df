//! The panel behind the modes: what of it may be set, and its modes solved again.

mod part;
mod parts;

use orthopanel_model::{
    Attachments, CoreFit, ModalModel, ModeRange, ModelError, PanelModel, Piece, Place, Ports, StructureKind, TimeModel,
};
use serde::{Deserialize, Serialize};

use crate::connections::{Connections, Layout, Terms, check_mount};
use crate::{FmuError, PortNames, Residual};

pub(crate) use part::{PanelParameter, Part};

/// A panel as identified, with the number of modes that its FMU keeps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Panel {
    model: PanelModel,
    flexible_modes: usize,
    residual: Option<ResidualModes>,
    #[serde(default)]
    connections: Connections,
}

/// Residual modes: how many, of forces at which places, and their damping ratio.
///
/// The places are those of the force ports and mounts until initialization has ended. From then on they stay, so that the states mean the same motion
/// wherever a port is moved to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResidualModes {
    count: usize,
    places: Vec<Place>,
    damping_ratio: f64,
}

/// What a stepper needs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Solution {
    /// Without the mounts.
    pub free: ModalModel,
    /// On the mounts.
    pub modes: ModalModel,
    /// What each output of a connection is made of.
    pub outputs: Vec<Terms>,
    /// Flexible modes of the panel itself among these: a core adds its internal variables.
    pub flexible: usize,
    /// Residual modes, behind all others.
    pub residual: usize,
    /// How the core's modulus is fitted, where there is one.
    pub core: Option<CoreFit>,
}

impl Panel {
    /// A panel of which the modes of `range` are kept, and these modes.
    #[cold]
    pub(crate) fn new(
        model: &PanelModel,
        range: ModeRange,
        ports: Ports,
        residual: Residual,
        connections: Connections,
    ) -> Result<(Self, Solution), FmuError> {
        let mut model = model.clone();
        model.ports = ports;
        model.provenance.clear();
        // Nothing here is drawn, and there will be as many ratios as modes are kept.
        #[cfg(not(feature = "compact"))]
        {
            model.damping.std.clear();
            model.correlation = None;
        }
        connections.check(&model)?;
        let mut panel = Self { model, flexible_modes: 0, residual: None, connections };
        // How many there are is known once they are found; places and integrals follow from the number.
        panel.flexible_modes = match range {
            ModeRange::Count(count) => count,
            range => panel.model.time_model(range, &[], &[])?.flexible,
        };
        let places = panel.attached_places();
        let attachments = Attachments::new(&panel.model, panel.flexible_modes, &places);
        let attachments = (residual == Residual::Attachment).then_some(attachments);
        let solution = panel.solution(attachments.as_ref())?;
        let flexible = panel.flexible_modes;
        panel.model.damping.ratios = (1..=flexible).map(|mode| panel.model.damping.ratio(mode)).collect();
        let count = solution.residual;
        panel.residual =
            attachments.map(|Attachments { places, damping_ratio, .. }| ResidualModes { count, places, damping_ratio });
        Ok((panel, solution))
    }

    /// Where forces and mounts stand.
    fn attached_places(&self) -> Vec<Place> {
        self.model.ports.forces.iter().copied().chain(self.connections.mounts.iter().map(|mount| mount.at)).collect()
    }

    /// What joins it to its surroundings.
    pub(crate) fn layout(&self, names: &PortNames) -> Result<Layout, ModelError> {
        self.connections.layout(&self.model, self.flexible_modes, names)
    }

    pub(crate) fn force_ports(&self) -> usize {
        self.model.ports.forces.len()
    }

    pub(crate) fn connections(&self) -> &Connections {
        &self.connections
    }

    /// How many residual modes there are.
    pub(crate) fn residual_modes(&self) -> usize {
        self.residual.as_ref().map_or(0, |residual| residual.count)
    }

    pub(crate) fn flexible_modes(&self) -> usize {
        self.flexible_modes
    }

    /// Checks what a file says of the panel against the modes and ports beside it: lists are made by these numbers.
    ///
    /// # Errors
    /// [`FmuError::ResourceText`] with the numbers, [`FmuError::Model`] for a panel without physical meaning.
    #[cold]
    pub(crate) fn check_resource(&self, modes: &ModalModel, ports: &Ports) -> Result<(), FmuError> {
        let refused = |message: String| Err(FmuError::ResourceText(message));
        let flexible = modes.flexible().count().saturating_sub(self.residual_modes());
        let asked = self.flexible_modes;
        // A core brings internal variables that vibrate too.
        let fits = if self.model.relaxes() { asked <= flexible } else { asked == flexible };
        if asked > ModeRange::MOST || !fits {
            return refused(format!(
                "panel.flexible_modes = {asked}: the model has {flexible} flexible modes, and at most {} can be kept",
                ModeRange::MOST
            ));
        }
        let damped = self.model.damping.ratios.len();
        if damped != asked {
            return refused(format!("panel.model.damping: {damped} ratios for {asked} flexible modes"));
        }
        if self.model.ports != *ports {
            let own = &self.model.ports;
            return refused(format!(
                "panel.model.ports: {} forces and {} responses, not the same places as the {} and {} of the FMU",
                own.forces.len(),
                own.responses.len(),
                ports.forces.len(),
                ports.responses.len()
            ));
        }
        self.model.check()?;
        self.connections.check(&self.model)?;
        if let Some(ResidualModes { count, places, damping_ratio }) = &self.residual {
            let (found, forces) = (places.len(), ports.forces.len() + self.connections.mounts.len());
            if found != forces || *count > 2 * forces {
                return refused(format!(
                    "panel.residual: {count} modes of {found} places for {forces} forces and mounts"
                ));
            }
            places.iter().try_for_each(|&place| self.model.piece.contains(place))?;
            damping(self.flexible_modes, *damping_ratio)?;
        }
        for constant in self.model.structure.constants() {
            constant.check(self.model.constant(constant.name)?)?;
        }
        Ok(())
    }

    /// Values of all parts as exported.
    pub(crate) fn values(&self) -> Vec<f64> {
        self.parts().iter().map(|part| self.value(part)).collect()
    }

    /// Everything that may be set, with the values it was exported with; its parts come first.
    pub(crate) fn parameters(&self, names: &PortNames) -> Vec<PanelParameter> {
        let named = self.parts().into_iter().filter(|part| !part.is_of_attachment()).map(|part| {
            let (name, unit, mut description) = self.describe(&part, names);
            if matches!(part, Part::Damping(_)) && self.has_effects() {
                description += " of the panel without its effects";
            }
            PanelParameter { name, unit, description, start: self.value(&part), tunable: part.is_tunable() }
        });
        named.collect()
    }

    /// Refuses a value that has no physical meaning by itself, whatever the others are.
    pub(crate) fn check(&self, index: usize, value: f64) -> Result<(), FmuError> {
        match self.parts().get(index) {
            Some(part @ (Part::MountStiffness(mount) | Part::MountDamping(mount))) => {
                let name = self.connections.mounts.get(*mount).map_or("", |mount| &mount.name);
                let what = if matches!(part, Part::MountStiffness(_)) { "stiffness" } else { "damping" };
                check_mount(name, what, value)
            }
            Some(part) => Ok(self.check_part(part, value)?),
            None => Ok(()),
        }
    }

    fn check_part(&self, part: &Part, value: f64) -> Result<(), ModelError> {
        match part {
            Part::Length => positive("length", value, "m"),
            Part::Width => positive("width", value, "m"),
            Part::Thickness => positive("thickness", value, "m"),
            Part::MassPerArea => positive("mass_per_area", value, "kg/m2"),
            Part::Damping(mode) => damping(*mode, value),
            Part::ResidualDamping => damping(self.flexible_modes, value),
            Part::Constant(name) => {
                let known = self.model.structure.constants().iter().find(|constant| constant.name == name);
                known.map_or(Ok(()), |constant| constant.check(value))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a place off the piece with these values of the parameters, of which all but places and damping stay.
    pub(crate) fn check_place(&self, index: usize, value: f64, values: &[f64]) -> Result<(), ModelError> {
        let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
        let place = match self.parts().get(index) {
            Some(Part::ForceX(_) | Part::ResponseX(_) | Part::MountX(_)) => Place { x: value, y: at(index + 1) },
            Some(Part::ForceY(_) | Part::ResponseY(_) | Part::MountY(_)) => {
                Place { x: at(index.saturating_sub(1)), y: value }
            }
            _ => return Ok(()),
        };
        // Length and width come first.
        Piece { length: at(0), width: at(1), ..self.model.piece }.contains(place)
    }

    /// Where that place stands among the parts which follows the place of a force or mount until initialization has ended; none for what is none.
    pub(crate) fn attachment_of(&self, index: usize) -> Option<usize> {
        let parts = self.parts();
        let own = match *parts.get(index)? {
            Part::ForceX(port) => Part::AttachmentX(port),
            Part::ForceY(port) => Part::AttachmentY(port),
            Part::MountX(mount) => Part::AttachmentX(self.model.ports.forces.len() + mount),
            Part::MountY(mount) => Part::AttachmentY(self.model.ports.forces.len() + mount),
            _ => return None,
        };
        parts.iter().position(|part| *part == own)
    }

    /// What is known with the damping ratios, and the stiffness and damping of mounts, of `values`, where they are known for all the others:
    /// without any solution. `None` where something else differs, or where effects mix the damping of the bare modes.
    #[cold]
    pub(crate) fn quickly(&self, free: &ModalModel, known: &[f64], values: &[f64]) -> Option<Solution> {
        let parts = self.parts();
        let differs = |(part, (known, value)): (&Part, (&f64, &f64))| (known != value).then(|| part.clone());
        let changed: Vec<Part> = parts.iter().zip(known.iter().zip(values)).filter_map(differs).collect();
        let redamped = changed.iter().any(Part::is_damping);
        let quick = changed.iter().all(|part| part.is_damping() || part.is_of_mount_law());
        if !quick || redamped && !self.model.effects.is_empty() {
            return None;
        }
        let mut free = free.clone();
        if redamped {
            let mut ratios = parts.iter().zip(values).filter(|(part, _)| part.is_damping()).map(|(_, value)| *value);
            let mut damped = free.modes().to_vec();
            let mut last = 0.0;
            for mode in damped.iter_mut().filter(|mode| mode.angular_frequency > 0.0) {
                // All residual modes have the one that stands last.
                last = ratios.next().unwrap_or(last);
                mode.damping_ratio = last;
            }
            free = ModalModel::new(free.force_count(), free.response_count(), damped).ok()?;
        }
        let layout = self.with(values).layout(&PortNames::default()).ok()?;
        let modes = layout.mounted(&free).ok()?;
        Some(Solution {
            free,
            modes,
            outputs: layout.terms(),
            flexible: self.flexible_modes,
            residual: self.residual_modes(),
            core: None,
        })
    }

    /// The same with these values of the parameters.
    #[cold]
    fn with(&self, values: &[f64]) -> Self {
        let mut panel = self.clone();
        for (part, &value) in self.parts().into_iter().zip(values) {
            panel.set(&part, value);
        }
        panel
    }

    /// Whether effects are in the modes, so that damping may couple them.
    pub(crate) fn has_effects(&self) -> bool {
        !self.model.effects.is_empty()
    }

    /// Whether nothing depends on a place across the panel.
    pub(crate) fn is_beam(&self) -> bool {
        self.model.structure == StructureKind::TimoshenkoBeam
    }

    /// Sizes by which the parameters are differenced: their own values, and for places a quarter of the length, for the shapes of
    /// residual modes are short. What may be zero has one of its kind.
    pub(crate) fn sizes(&self, values: &[f64]) -> Vec<f64> {
        let length = values.first().copied().unwrap_or(1.0);
        let size = |(part, &value): (Part, &f64)| match part {
            part if part.is_place() => 0.25 * length,
            part if part.is_damping() => value.max(0.01),
            Part::Constant(_) | Part::Effect(..) if value == 0.0 => 1.0,
            Part::MountStiffness(_) => value.max(1.0),
            Part::MountDamping(_) => value.max(0.01),
            // A place, or what is alike in either sense.
            Part::Effect(..) => value.abs(),
            _ => value,
        };
        self.parts().into_iter().zip(values).map(size).collect()
    }

    /// The modes with these values of the parameters.
    ///
    /// # Errors
    /// [`FmuError::OutOfRange`] for a piece that is no panel: its modes could take any time to find.
    #[cold]
    pub(crate) fn solve(&self, values: &[f64]) -> Result<Solution, FmuError> {
        let panel = self.with(values);
        panel.model.check()?;
        panel.connections.check(&panel.model)?;
        let piece = panel.model.piece;
        in_range("length over thickness", piece.length / piece.thickness, 1.0, 1e4)?;
        in_range("length over width", piece.length / piece.width, 1e-3, 1e4)?;
        if let (Some(e_x), Some(g_zx)) = (panel.model.constants.get("e_x"), panel.model.constants.get("g_zx")) {
            in_range("e_x over g_zx", e_x.value / g_zx.value, 1e-2, 1e4)?;
        }
        let attachments = panel.residual.clone().map(|ResidualModes { count, places, damping_ratio }| Attachments {
            places,
            count: Some(count),
            damping_ratio,
        });
        Ok(panel.solution(attachments.as_ref())?)
    }

    /// The modes as they now are, with these residual modes.
    #[cold]
    fn solution(&self, attachments: Option<&Attachments>) -> Result<Solution, ModelError> {
        let layout = self.layout(&PortNames::default())?;
        let kept = self.model.time_model(ModeRange::Count(self.flexible_modes), &layout.places(), &[])?;
        let TimeModel { modes, flexible, core, .. } = kept;
        let residual = match attachments {
            Some(attachments) => self.model.residual_modes(flexible, attachments, &layout.near_places(), &[])?,
            None => vec![],
        };
        let free = layout.seen(&modes, &residual)?;
        let (modes, outputs) = (layout.mounted(&free)?, layout.terms());
        Ok(Solution { free, modes, outputs, flexible, residual: residual.len(), core })
    }
}

fn positive(name: &'static str, value: f64, unit: &'static str) -> Result<(), ModelError> {
    if value > 0.0 { Ok(()) } else { Err(ModelError::Size { name, value, unit }) }
}

fn in_range(what: &'static str, value: f64, low: f64, high: f64) -> Result<(), FmuError> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(FmuError::OutOfRange { what, value, low, high }) }
}

/// Of a mode counted from 0, below the ratio at which it would cease to swing.
fn damping(mode: usize, value: f64) -> Result<(), ModelError> {
    let sound = (0.0..std::f64::consts::FRAC_1_SQRT_2).contains(&value);
    if sound { Ok(()) } else { Err(ModelError::Damping { mode: mode + 1, value }) }
}
