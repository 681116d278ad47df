//! The panel behind the modes: what of it may be set, and its modes solved again.

mod parts;

use orthopanel_model::{
    Attachments, CoreFit, ModalModel, ModeRange, ModelError, PanelModel, Piece, Place, Ports, StructureKind, TimeModel,
};
use serde::{Deserialize, Serialize};

use crate::{FmuError, PortNames, Residual};

pub(crate) use parts::{PanelParameter, Part};

use parts::set;

/// A panel as identified, with the number of modes that its FMU keeps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Panel {
    model: PanelModel,
    flexible_modes: usize,
    residual: Option<ResidualModes>,
}

/// Residual modes: how many, of forces at which places, and their damping ratio.
///
/// The places are those of the force ports until initialization has ended. From then on they stay, so that the states mean the same motion
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
    pub modes: ModalModel,
    /// Flexible modes of the panel itself among these: a core adds its internal variables.
    pub flexible: usize,
    /// Residual modes, behind all others.
    pub residual: usize,
    /// How the core's modulus is fitted, where there is one.
    pub core: Option<CoreFit>,
}

impl Panel {
    /// A panel of which the modes of `range` are kept, and these modes.
    pub(crate) fn new(
        model: &PanelModel,
        range: ModeRange,
        ports: Ports,
        residual: Residual,
    ) -> Result<(Self, Solution), ModelError> {
        let mut model = model.clone();
        model.ports = ports;
        model.provenance.clear();
        let seen = model.time_model(range, &model.ports.forces, &model.ports.responses)?;
        let flexible_modes = seen.flexible;
        let of_forces = || Attachments::new(&model, flexible_modes, &model.ports.forces);
        let attachments = (residual == Residual::Attachment).then(of_forces);
        let solution = with_residual(&model, seen, attachments.as_ref())?;
        model.damping.ratios = (1..=flexible_modes).map(|mode| model.damping.ratio(mode)).collect();
        let count = solution.residual;
        let residual =
            attachments.map(|Attachments { places, damping_ratio, .. }| ResidualModes { count, places, damping_ratio });
        Ok((Self { model, flexible_modes, residual }, solution))
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
        if let Some(ResidualModes { count, places, damping_ratio }) = &self.residual {
            let (found, forces) = (places.len(), ports.forces.len());
            if found != forces || *count > 2 * forces {
                return refused(format!("panel.residual: {count} modes of {found} places for {forces} forces"));
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
    pub(crate) fn check(&self, index: usize, value: f64) -> Result<(), ModelError> {
        match self.parts().get(index) {
            Some(Part::Length) => positive("length", value, "m"),
            Some(Part::Width) => positive("width", value, "m"),
            Some(Part::Thickness) => positive("thickness", value, "m"),
            Some(Part::MassPerArea) => positive("mass_per_area", value, "kg/m2"),
            Some(Part::Damping(mode)) => damping(*mode, value),
            Some(Part::ResidualDamping) => damping(self.flexible_modes, value),
            Some(Part::Constant(name)) => {
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
            Some(Part::ForceX(_) | Part::ResponseX(_)) => Place { x: value, y: at(index + 1) },
            Some(Part::ForceY(_) | Part::ResponseY(_)) => Place { x: at(index.saturating_sub(1)), y: value },
            _ => return Ok(()),
        };
        // Length and width come first.
        Piece { length: at(0), width: at(1), ..self.model.piece }.contains(place)
    }

    /// Where that place stands among the parts which follows the place of a force until initialization has ended; none for what is none.
    pub(crate) fn attachment_of(&self, index: usize) -> Option<usize> {
        let parts = self.parts();
        let own = match *parts.get(index)? {
            Part::ForceX(port) => Part::AttachmentX(port),
            Part::ForceY(port) => Part::AttachmentY(port),
            _ => return None,
        };
        parts.iter().position(|part| *part == own)
    }

    /// These modes with the damping ratios of `values`, where they are known for all the others: without any solution. `None` where
    /// something else differs, or where effects mix the damping of the bare modes.
    pub(crate) fn redamped(&self, modes: &ModalModel, known: &[f64], values: &[f64]) -> Option<ModalModel> {
        let parts = self.parts();
        let alike = |(part, (known, value)): (&Part, (&f64, &f64))| part.is_damping() || known == value;
        if !self.model.effects.is_empty() || !parts.iter().zip(known.iter().zip(values)).all(alike) {
            return None;
        }
        let mut ratios = parts.iter().zip(values).filter(|(part, _)| part.is_damping()).map(|(_, value)| *value);
        let mut damped = modes.modes().to_vec();
        let mut last = 0.0;
        for mode in damped.iter_mut().filter(|mode| mode.angular_frequency > 0.0) {
            // All residual modes have the one that stands last.
            last = ratios.next().unwrap_or(last);
            mode.damping_ratio = last;
        }
        ModalModel::new(modes.force_count(), modes.response_count(), damped).ok()
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
    pub(crate) fn solve(&self, values: &[f64]) -> Result<Solution, FmuError> {
        let mut model = self.model.clone();
        let mut residual = self.residual.clone();
        for (part, &value) in self.parts().into_iter().zip(values) {
            set((&mut model, residual.as_mut()), &part, value);
        }
        model.check()?;
        let piece = model.piece;
        in_range("length over thickness", piece.length / piece.thickness, 1.0, 1e4)?;
        in_range("length over width", piece.length / piece.width, 1e-3, 1e4)?;
        if let (Some(e_x), Some(g_zx)) = (model.constants.get("e_x"), model.constants.get("g_zx")) {
            in_range("e_x over g_zx", e_x.value / g_zx.value, 1e-2, 1e4)?;
        }
        let attachments = residual.map(|ResidualModes { count, places, damping_ratio }| Attachments {
            places,
            count: Some(count),
            damping_ratio,
        });
        let (range, ports) = (ModeRange::Count(self.flexible_modes), &model.ports);
        let seen = model.time_model(range, &ports.forces, &ports.responses)?;
        Ok(with_residual(&model, seen, attachments.as_ref())?)
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

fn with_residual(
    model: &PanelModel,
    seen: TimeModel,
    attachments: Option<&Attachments>,
) -> Result<Solution, ModelError> {
    let Ports { forces, responses } = &model.ports;
    let seen = match attachments {
        Some(attachments) => seen.with_residual_modes(model, attachments, forces, responses)?,
        None => seen,
    };
    let TimeModel { modes, flexible, residual, core, .. } = seen;
    Ok(Solution { modes, flexible, residual, core })
}
