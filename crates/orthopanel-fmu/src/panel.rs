//! The panel behind the modes: what of it may be set before a simulation starts, and its modes solved again.

use orthopanel_model::{CoreFit, Estimate, ModalModel, ModeRange, ModelError, PanelModel, Ports, TimeModel};
use serde::{Deserialize, Serialize};

use crate::FmuError;

/// A panel as identified, with the number of flexible modes that its FMU keeps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Panel {
    model: PanelModel,
    flexible_modes: usize,
}

/// What a parameter of the FMU is of the panel; ports and modes are counted from 0.
#[derive(Debug, Clone, PartialEq)]
enum Part {
    Length,
    Width,
    Thickness,
    MassPerArea,
    Constant(String),
    Damping(usize),
    ForceX(usize),
    ForceY(usize),
    ResponseX(usize),
    ResponseY(usize),
}

/// A parameter of the FMU, as its table of variables shows it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PanelParameter {
    pub name: String,
    pub unit: &'static str,
    pub description: String,
    pub start: f64,
}

/// What a stepper needs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Solution {
    pub modes: ModalModel,
    /// Flexible modes of the panel itself among these: a core adds its internal variables.
    pub flexible: usize,
    /// How the core's modulus is fitted, where there is one.
    pub core: Option<CoreFit>,
    /// $\sum W_rW_f/\omega^2$ \[m/N\] over the modes left out: a row a response, a column a force.
    pub static_remainder: Vec<Vec<f64>>,
}

impl Panel {
    /// A panel of which the modes of `range` are kept, and these modes.
    pub(crate) fn new(model: &PanelModel, range: ModeRange, ports: Ports) -> Result<(Self, Solution), ModelError> {
        let mut model = model.clone();
        model.ports = ports;
        model.provenance.clear();
        let solution = solve(&model, range)?;
        let flexible_modes = solution.flexible;
        model.damping.ratios = (1..=flexible_modes).map(|mode| model.damping.ratio(mode)).collect();
        Ok((Self { model, flexible_modes }, solution))
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
        let flexible = modes.flexible().count();
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
        for constant in self.model.structure.constants() {
            constant.check(self.model.constant(constant.name)?)?;
        }
        Ok(())
    }

    /// Everything that may be set, with the values it was exported with.
    pub(crate) fn parameters(&self) -> Vec<PanelParameter> {
        let named = self.parts().into_iter().map(|part| {
            let (name, unit, description) = describe(&part);
            PanelParameter { name, unit, description, start: self.value(&part) }
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
            Some(Part::Damping(mode)) if !(0.0..std::f64::consts::FRAC_1_SQRT_2).contains(&value) => {
                Err(ModelError::Damping { mode: mode + 1, value })
            }
            Some(Part::Constant(name)) => {
                let known = self.model.structure.constants().iter().find(|constant| constant.name == name);
                known.map_or(Ok(()), |constant| constant.check(value))
            }
            _ => Ok(()),
        }
    }

    /// Sizes by which the parameters are differenced: their own values, and for places the length. What may be zero has one of
    /// its kind.
    pub(crate) fn sizes(&self, values: &[f64]) -> Vec<f64> {
        let length = values.first().copied().unwrap_or(1.0);
        let size = |(part, &value): (Part, &f64)| match part {
            Part::ForceX(_) | Part::ForceY(_) | Part::ResponseX(_) | Part::ResponseY(_) => length,
            Part::Damping(_) => value.max(0.01),
            Part::Constant(_) if value == 0.0 => 1.0,
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
        for (part, &value) in self.parts().into_iter().zip(values) {
            set(&mut model, &part, value);
        }
        model.check()?;
        let piece = model.piece;
        in_range("length over thickness", piece.length / piece.thickness, 1.0, 1e4)?;
        in_range("length over width", piece.length / piece.width, 1e-3, 1e4)?;
        if let (Some(e_x), Some(g_zx)) = (model.constants.get("e_x"), model.constants.get("g_zx")) {
            in_range("e_x over g_zx", e_x.value / g_zx.value, 1e-2, 1e4)?;
        }
        Ok(solve(&model, ModeRange::Count(self.flexible_modes))?)
    }

    fn parts(&self) -> Vec<Part> {
        let mut parts = vec![Part::Length, Part::Width, Part::Thickness, Part::MassPerArea];
        parts.extend(self.model.constants.keys().cloned().map(Part::Constant));
        parts.extend((0..self.flexible_modes).map(Part::Damping));
        parts.extend((0..self.model.ports.forces.len()).flat_map(|port| [Part::ForceX(port), Part::ForceY(port)]));
        let responses = 0..self.model.ports.responses.len();
        parts.extend(responses.flat_map(|port| [Part::ResponseX(port), Part::ResponseY(port)]));
        parts
    }

    fn value(&self, part: &Part) -> f64 {
        let (piece, ports) = (&self.model.piece, &self.model.ports);
        let value = match part {
            Part::Length => Some(piece.length),
            Part::Width => Some(piece.width),
            Part::Thickness => Some(piece.thickness),
            Part::MassPerArea => Some(piece.mass_per_area),
            Part::Constant(name) => self.model.constants.get(name).map(|estimate| estimate.value),
            Part::Damping(mode) => Some(self.model.damping.ratio(mode + 1)),
            Part::ForceX(port) => ports.forces.get(*port).map(|place| place.x),
            Part::ForceY(port) => ports.forces.get(*port).map(|place| place.y),
            Part::ResponseX(port) => ports.responses.get(*port).map(|place| place.x),
            Part::ResponseY(port) => ports.responses.get(*port).map(|place| place.y),
        };
        // The parts are those of this panel: none is ever missing.
        value.unwrap_or(f64::NAN)
    }
}

fn set(model: &mut PanelModel, part: &Part, value: f64) {
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
        Part::Damping(mode) => model.damping.ratios.get_mut(*mode),
        Part::ForceX(port) => ports.forces.get_mut(*port).map(|place| &mut place.x),
        Part::ForceY(port) => ports.forces.get_mut(*port).map(|place| &mut place.y),
        Part::ResponseX(port) => ports.responses.get_mut(*port).map(|place| &mut place.x),
        Part::ResponseY(port) => ports.responses.get_mut(*port).map(|place| &mut place.y),
    };
    if let Some(place) = place {
        *place = value;
    }
}

fn describe(part: &Part) -> (String, &'static str, String) {
    let place = |what: &str, port: &usize, axis: &str| {
        let text = format!("Place of {what} {} along {axis}, from the centre", port + 1);
        (format!("{what}_{}_{axis}", port + 1), "m", text)
    };
    match part {
        Part::Length => ("length".into(), "m", "Length of the piece, along x".into()),
        Part::Width => ("width".into(), "m", "Width of the piece, along y".into()),
        Part::Thickness => ("thickness".into(), "m", "Thickness of the piece".into()),
        Part::MassPerArea => ("mass_per_area".into(), "kg/m2", "Mass per area of the piece".into()),
        Part::Constant(name) => {
            let unit = if name.starts_with("nu") { "1" } else { "Pa" };
            (name.clone(), unit, format!("Elastic constant {name}"))
        }
        Part::Damping(mode) => {
            let text = format!("Modal damping ratio of flexible mode {}", mode + 1);
            (format!("damping_ratio_{}", mode + 1), "1", text)
        }
        Part::ForceX(port) => place("force", port, "x"),
        Part::ForceY(port) => place("force", port, "y"),
        Part::ResponseX(port) => place("response", port, "x"),
        Part::ResponseY(port) => place("response", port, "y"),
    }
}

fn positive(name: &'static str, value: f64, unit: &'static str) -> Result<(), ModelError> {
    if value > 0.0 { Ok(()) } else { Err(ModelError::Size { name, value, unit }) }
}

fn in_range(what: &'static str, value: f64, low: f64, high: f64) -> Result<(), FmuError> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(FmuError::OutOfRange { what, value, low, high }) }
}

fn solve(model: &PanelModel, range: ModeRange) -> Result<Solution, ModelError> {
    let solved = model.time_model(range, &model.ports.forces, &model.ports.responses)?;
    let TimeModel { modes, flexible, core, static_remainder } = solved;
    Ok(Solution { modes, flexible, core, static_remainder })
}
