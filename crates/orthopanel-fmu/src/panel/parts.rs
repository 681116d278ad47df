//! The parts of a panel that are parameters of its FMU.

use orthopanel_model::{EffectParameter, Estimate, StructureKind, effect};

use super::Panel;
use super::part::Part;
use crate::PortNames;

impl Panel {
    /// All of them, in the order of the FMU's parameters.
    pub(crate) fn parts(&self) -> Vec<Part> {
        let mut parts = vec![Part::Length, Part::Width, Part::Thickness, Part::MassPerArea];
        parts.extend(self.model.constants.keys().cloned().map(Part::Constant));
        for (number, entry) in self.model.effects.iter().enumerate() {
            let known = effect(&entry.id).map(|effect| effect.parameters()).unwrap_or_default();
            // A beam has no place across, and what reaches across a whole plate has none either.
            let is_beam = self.model.structure == StructureKind::TimoshenkoBeam;
            let has = |of: &&EffectParameter| {
                let is_told = entry.parameters.contains_key(of.name) || of.held_at.is_some_and(|held| !held.is_nan());
                !of.across || (!is_beam && is_told)
            };
            parts.extend(known.iter().filter(has).map(|parameter| Part::Effect(number, parameter)));
        }
        parts.extend((0..self.flexible_modes).map(Part::Damping));
        parts.extend(self.residual.is_some().then_some(Part::ResidualDamping));
        parts.extend((0..self.model.ports.forces.len()).flat_map(|port| [Part::ForceX(port), Part::ForceY(port)]));
        let responses = 0..self.model.ports.responses.len();
        parts.extend(responses.flat_map(|port| [Part::ResponseX(port), Part::ResponseY(port)]));
        let of_mount =
            |mount| [Part::MountStiffness(mount), Part::MountDamping(mount), Part::MountX(mount), Part::MountY(mount)];
        parts.extend((0..self.connections.mounts.len()).flat_map(of_mount));
        let places = 0..self.residual.as_ref().map_or(0, |residual| residual.places.len());
        parts.extend(places.flat_map(|place| [Part::AttachmentX(place), Part::AttachmentY(place)]));
        parts
    }

    pub(super) fn value(&self, part: &Part) -> f64 {
        let (piece, ports) = (&self.model.piece, &self.model.ports);
        let residual = self.residual.as_ref();
        let place = |place: &usize| residual.and_then(|residual| residual.places.get(*place));
        let mount = |mount: &usize| self.connections.mounts.get(*mount);
        let value = match part {
            Part::Length => Some(piece.length),
            Part::Width => Some(piece.width),
            Part::Thickness => Some(piece.thickness),
            Part::MassPerArea => Some(piece.mass_per_area),
            Part::Constant(name) => self.model.constants.get(name).map(|estimate| estimate.value),
            Part::Effect(number, parameter) => {
                let given = self.model.effects.get(*number).and_then(|entry| entry.parameters.get(parameter.name));
                given.map(|estimate| estimate.value).or(parameter.held_at)
            }
            Part::Damping(mode) => Some(self.model.damping.ratio(mode + 1)),
            Part::ResidualDamping => residual.map(|residual| residual.damping_ratio),
            Part::MountStiffness(at) => mount(at).map(|mount| mount.stiffness),
            Part::MountDamping(at) => mount(at).map(|mount| mount.damping),
            Part::MountX(at) => mount(at).map(|mount| mount.at.x),
            Part::MountY(at) => mount(at).map(|mount| mount.at.y),
            Part::AttachmentX(at) => place(at).map(|place| place.x),
            Part::AttachmentY(at) => place(at).map(|place| place.y),
            Part::ForceX(port) => ports.forces.get(*port).map(|place| place.x),
            Part::ForceY(port) => ports.forces.get(*port).map(|place| place.y),
            Part::ResponseX(port) => ports.responses.get(*port).map(|place| place.x),
            Part::ResponseY(port) => ports.responses.get(*port).map(|place| place.y),
        };
        // The parts are those of this panel: none is ever missing.
        value.unwrap_or(f64::NAN)
    }
}

impl Panel {
    pub(super) fn set(&mut self, part: &Part, value: f64) {
        let Self { model, residual, connections, .. } = self;
        let (residual, mounts) = (residual.as_mut(), &mut connections.mounts);
        let (piece, ports) = (&mut model.piece, &mut model.ports);
        let place = match part {
            Part::Length => Some(&mut piece.length),
            Part::Width => Some(&mut piece.width),
            Part::Thickness => Some(&mut piece.thickness),
            Part::MassPerArea => Some(&mut piece.mass_per_area),
            Part::Constant(name) => {
                model.constants.insert(name.clone(), Estimate { value, std: None });
                None
            }
            Part::Effect(number, parameter) => {
                if let Some(entry) = model.effects.get_mut(*number) {
                    entry.parameters.insert(parameter.name.into(), Estimate { value, std: None });
                }
                None
            }
            Part::Damping(mode) => model.damping.ratios.get_mut(*mode),
            Part::ResidualDamping => residual.map(|residual| &mut residual.damping_ratio),
            Part::MountStiffness(at) => mounts.get_mut(*at).map(|mount| &mut mount.stiffness),
            Part::MountDamping(at) => mounts.get_mut(*at).map(|mount| &mut mount.damping),
            Part::MountX(at) => mounts.get_mut(*at).map(|mount| &mut mount.at.x),
            Part::MountY(at) => mounts.get_mut(*at).map(|mount| &mut mount.at.y),
            Part::AttachmentX(at) => {
                residual.and_then(|residual| residual.places.get_mut(*at)).map(|place| &mut place.x)
            }
            Part::AttachmentY(at) => {
                residual.and_then(|residual| residual.places.get_mut(*at)).map(|place| &mut place.y)
            }
            Part::ForceX(port) => ports.forces.get_mut(*port).map(|place| &mut place.x),
            Part::ForceY(port) => ports.forces.get_mut(*port).map(|place| &mut place.y),
            Part::ResponseX(port) => ports.responses.get_mut(*port).map(|place| &mut place.x),
            Part::ResponseY(port) => ports.responses.get_mut(*port).map(|place| &mut place.y),
        };
        if let Some(place) = place {
            *place = value;
        }
    }

    fn mount_name(&self, mount: usize) -> String {
        self.connections.mounts.get(mount).map(|mount| mount.name.clone()).unwrap_or_default()
    }

    pub(super) fn describe(&self, part: &Part, names: &PortNames) -> (String, &'static str, String) {
        let place = |what: &str, label: String, axis: &str| {
            let text = described!("Place of {what} {label} along {axis}, from the centre");
            (format!("{what}_{label}_{axis}"), "m", text)
        };
        match part {
            Part::Length => ("length".into(), "m", described!("Length of the piece, along x")),
            Part::Width => ("width".into(), "m", described!("Width of the piece, along y")),
            Part::Thickness => ("thickness".into(), "m", described!("Thickness of the piece")),
            Part::MassPerArea => ("mass_per_area".into(), "kg/m2", described!("Mass per area of the piece")),
            Part::Constant(name) => {
                let unit = if name.starts_with("nu") { "1" } else { "Pa" };
                (name.clone(), unit, described!("Elastic constant {name}"))
            }
            Part::Effect(number, parameter) => {
                let id = |at: usize| self.model.effects.get(at).map_or("", |entry| &entry.id);
                let before = (0..*number).filter(|&other| id(other) == id(*number)).count();
                let of = if before == 0 { id(*number).into() } else { format!("{} {}", id(*number), before + 1) };
                let name = format!("{of}_{}", parameter.name).replace(['-', ' '], "_");
                (name, parameter.unit, described!("Parameter {} of the effect {of}", parameter.name))
            }
            Part::Damping(mode) => {
                let text = described!("Modal damping ratio of flexible mode {}", mode + 1);
                (format!("damping_ratio_{}", mode + 1), "1", text)
            }
            Part::ResidualDamping => {
                let text = described!("Damping ratio of the residual modes, which stand for the modes left out");
                ("residual_damping_ratio".into(), "1", text)
            }
            Part::MountStiffness(mount) => {
                let name = self.mount_name(*mount);
                (format!("mount_{name}_stiffness"), "N/m", described!("Stiffness of mount {name}"))
            }
            Part::MountDamping(mount) => {
                let name = self.mount_name(*mount);
                (format!("mount_{name}_damping"), "N.s/m", described!("Damping of mount {name}"))
            }
            Part::MountX(mount) => place("mount", self.mount_name(*mount), "x"),
            Part::MountY(mount) => place("mount", self.mount_name(*mount), "y"),
            // No importer sees these.
            Part::AttachmentX(port) | Part::AttachmentY(port) => place("attachment", port.to_string(), ""),
            Part::ForceX(port) => place("force", names.force(*port), "x"),
            Part::ForceY(port) => place("force", names.force(*port), "y"),
            Part::ResponseX(port) => place("response", names.response(*port), "x"),
            Part::ResponseY(port) => place("response", names.response(*port), "y"),
        }
    }
}
