//! The variables of an FMU: one table for the XML and for the calls at run time.

mod arrays;
mod dependencies;
mod units;

use std::f64::consts::TAU;
use std::ops::Range;

use orthopanel_model::{ModalModel, Place, Ports};

use crate::{FmuError, PortNames, Resource, nominals};

pub use arrays::Array;
pub use dependencies::{Dependency, Factor};
pub use units::{UNITS, Unit};

/// What a variable stands for; ports are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The independent variable \[s\].
    Time,
    /// Parameter: does the force run linearly between the values set?
    ForceLinear,
    /// Input: force \[N\] at a force port; behind the last port what connections bring, in their own units.
    Input(usize),
    /// Output: acceleration \[m/s²\] at a response port.
    Acceleration(usize),
    /// Output: velocity \[m/s\] at a response port.
    Velocity(usize),
    /// Output: displacement \[m\] at a response port.
    Displacement(usize),
    /// Output of a connection, in its own unit.
    Connected(usize),
    /// Continuous state: coordinate $a$ of a mode \[m kg^1/2\]; modes are counted from 0, rigid ones first.
    ModalPosition(usize),
    /// Continuous state: $\dot a$ of a mode \[m kg^1/2/s\].
    ModalVelocity(usize),
    /// Derivative of [`Quantity::ModalPosition`] by time.
    ModalPositionRate(usize),
    /// Derivative of [`Quantity::ModalVelocity`] by time.
    ModalVelocityRate(usize),
    /// Parameter: a size, constant, damping ratio or place of the panel, counted from 0 as in the table.
    Parameter(usize),
}

impl Quantity {
    /// Name of the unit; `None` for a Boolean, and for what has one of its own.
    fn unit(self) -> Option<&'static str> {
        match self {
            Self::Time => Some("s"),
            Self::ForceLinear | Self::Parameter(_) | Self::Connected(_) => None,
            Self::Input(_) => Some("N"),
            Self::Acceleration(_) => Some("m/s2"),
            Self::Velocity(_) => Some("m/s"),
            Self::Displacement(_) => Some("m"),
            Self::ModalPosition(_) => Some(units::MODAL_POSITION),
            Self::ModalVelocity(_) | Self::ModalPositionRate(_) => Some(units::MODAL_VELOCITY),
            Self::ModalVelocityRate(_) => Some(units::MODAL_ACCELERATION),
        }
    }

    /// FMI causality.
    pub fn causality(self) -> &'static str {
        match self {
            Self::Time => "independent",
            Self::ForceLinear | Self::Parameter(_) => "parameter",
            Self::Input(_) => "input",
            Self::Acceleration(_) | Self::Velocity(_) | Self::Displacement(_) | Self::Connected(_) => "output",
            Self::ModalPosition(_)
            | Self::ModalVelocity(_)
            | Self::ModalPositionRate(_)
            | Self::ModalVelocityRate(_) => "local",
        }
    }

    /// FMI attribute `initial`; `None` where the standard has none.
    pub fn initial(self) -> Option<&'static str> {
        match self {
            Self::Time | Self::Input(_) => None,
            Self::ForceLinear | Self::Parameter(_) | Self::ModalPosition(_) | Self::ModalVelocity(_) => Some("exact"),
            _ => Some("calculated"),
        }
    }

    /// Start value as the XML says it; `None` for what is calculated, and for a parameter, whose start is its own.
    fn start(self) -> Option<&'static str> {
        match self {
            Self::ForceLinear => Some("false"),
            Self::Input(_) | Self::ModalPosition(_) | Self::ModalVelocity(_) => Some("0"),
            _ => None,
        }
    }
}

/// One variable, as the importer sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Value reference: its place in the table, from 1.
    pub reference: u32,
    /// Name, without dots or brackets: some importers refuse these.
    pub name: String,
    /// One line on what it is, where, and its sign.
    pub description: String,
    /// What it stands for.
    pub quantity: Quantity,
    /// Name of the unit; `None` for a Boolean.
    pub unit: Option<&'static str>,
    /// Start value as the XML says it; `None` for what is calculated.
    pub start: Option<String>,
    /// The inputs, continuous states and tunable parameters on which an output or a derivative depends directly (without an
    /// integration between); empty for what is neither.
    pub dependencies: Vec<Dependency>,
    /// References of the same while the FMU is initialized, when all parameters count.
    pub initial_dependencies: Vec<u32>,
    /// Of a derivative: reference of the continuous state.
    pub derivative_of: Option<u32>,
    /// Of a continuous state: the size to be expected.
    pub nominal: Option<f64>,
    /// Of a parameter: whether it may be set while the simulation runs.
    pub tunable: bool,
}

impl Variable {
    /// FMI variability.
    pub fn variability(&self) -> &'static str {
        match self.quantity {
            Quantity::Parameter(_) if self.tunable => "tunable",
            Quantity::ForceLinear | Quantity::Parameter(_) => "fixed",
            _ => "continuous",
        }
    }
}

/// The variables of a panel; references count from 1.
///
/// Order: `time`, `force_linear`, then `force_1`.., `acceleration_1`.., `velocity_1`.., `displacement_1`.., then the inputs and the outputs of
/// connections, then of each mode `modal_position_1`, `modal_velocity_1` and the derivatives of both, then the parameters of the panel; ports and
/// modes are counted from 1 in names, but for ports that have one. Where the resource asks for arrays, an importer sees [`VariableTable::arrays`] in the
/// place of the variables that these hold.
#[derive(Debug, Clone, PartialEq)]
pub struct VariableTable {
    variables: Vec<Variable>,
    /// What each stands for, close together: asked at every call.
    quantities: Vec<Quantity>,
    arrays: Vec<Array>,
}

impl Resource {
    /// The same with ports that have names.
    ///
    /// # Errors
    /// [`FmuError::PortName`] for what is no identifier, [`FmuError::SameName`] where two variables would have one name.
    pub fn with_names(self, names: PortNames) -> Result<Self, FmuError> {
        let named = self.renamed(names)?;
        let table = VariableTable::new(&named);
        let mut all: Vec<&str> = table.variables().iter().map(|variable| variable.name.as_str()).collect();
        all.sort_unstable();
        match all.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(FmuError::SameName { name: pair[0].into() }),
            None => Ok(named),
        }
    }

    /// The variables of this FMU.
    pub fn variables(&self) -> VariableTable {
        VariableTable::with_dependencies(self)
    }
}

impl VariableTable {
    /// The table of an FMU with this resource.
    pub(crate) fn new(resource: &Resource) -> Self {
        let (model, ports, names) = (resource.model(), resource.ports(), resource.names());
        let mut table = Self { variables: Vec::new(), quantities: Vec::new(), arrays: Vec::new() };
        table.push(Quantity::Time, "time".into(), "Time".into());
        table.push(Quantity::ForceLinear, "force_linear".into(), described!("{FORCE_LINEAR}"));
        for (port, place) in ports.forces.iter().enumerate() {
            let name = format!("force_{}", names.force(port));
            table.push(Quantity::Input(port), name, described!("Force {}. {HOLD}", at(place)));
        }
        table.push_outputs("acceleration", Quantity::Acceleration, (ports, names));
        table.push_outputs("velocity", Quantity::Velocity, (ports, names));
        table.push_outputs("displacement", Quantity::Displacement, (ports, names));
        let forces = ports.forces.len();
        for (index, input) in resource.inputs().iter().enumerate() {
            table.push_own(Quantity::Input(forces + index), &input.name, &input.description, input.unit);
        }
        for (index, output) in resource.outputs().iter().enumerate() {
            table.push_own(Quantity::Connected(index), &output.name, &output.description, output.unit);
        }
        table.push_modes(model, resource);
        for (index, parameter) in resource.panel().into_iter().flat_map(|panel| panel.parameters(names)).enumerate() {
            table.push(Quantity::Parameter(index), parameter.name, parameter.description);
            if let Some(variable) = table.variables.last_mut() {
                (variable.unit, variable.start) = (Some(parameter.unit), Some(parameter.start.to_string()));
                variable.tunable = parameter.tunable;
            }
        }
        if resource.arrays() {
            table.arrays = arrays::of(ports);
        }
        table
    }

    /// The same, with what each variable depends on: for the XML alone, so that an instance does without the work, and the library
    /// without its code.
    pub(crate) fn with_dependencies(resource: &Resource) -> Self {
        let mut table = Self::new(resource);
        dependencies::fill(&mut table.variables, resource);
        table
    }

    /// The same without states and parameters, as of a panel that nothing but its inputs changes.
    #[must_use]
    pub fn without_states(mut self) -> Self {
        let inner =
            |variable: &Variable| variable.nominal.is_some() || matches!(variable.quantity, Quantity::Parameter(_));
        let end = self.variables.iter().position(inner).unwrap_or(self.variables.len());
        self.variables.truncate(end);
        self.quantities.truncate(end);
        let stays = |reference: u32| place(reference).is_some_and(|place| place < end);
        for variable in &mut self.variables {
            variable.dependencies.retain(|on| stays(on.reference));
            variable.dependencies.iter_mut().for_each(|on| on.factor = Factor::Fixed);
            variable.initial_dependencies.retain(|&reference| stays(reference));
        }
        self
    }

    /// All variables, in the order of their references.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The variable of a reference.
    pub fn get(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(place(reference)?)
    }

    /// Arrays in place of the variables that they hold; none unless asked for.
    pub fn arrays(&self) -> &[Array] {
        &self.arrays
    }

    /// The array that holds the variable of a reference.
    pub fn array_of(&self, reference: u32) -> Option<&Array> {
        self.arrays.iter().find(|array| array.references.contains(&reference))
    }

    /// By which reference importers know a variable: they count arrays in place of what these hold, without gaps.
    pub fn seen(&self, reference: u32) -> u32 {
        let Some([first, end]) = self.in_arrays() else { return reference };
        let arrays = || self.arrays.iter().zip(first..);
        match arrays().find(|(array, _)| array.references.contains(&reference)) {
            Some((_, seen)) => seen,
            None if reference < end => reference,
            None => arrays().count() as u32 + first + (reference - end),
        }
    }

    /// The variables that importers know by a reference: one, or the elements of an array.
    pub(crate) fn seen_as(&self, seen: u32) -> Range<u32> {
        let alone = |reference: u32| reference..reference.saturating_add(1);
        let Some([first, end]) = self.in_arrays() else { return alone(seen) };
        let place = seen.checked_sub(first).and_then(|place| usize::try_from(place).ok());
        match place.map(|place| (self.arrays.get(place), place)) {
            None => alone(seen),
            Some((Some(array), _)) => array.references.clone(),
            Some((None, place)) => alone(end.saturating_add((place - self.arrays.len()) as u32)),
        }
    }

    /// The references of all elements of arrays, which stand behind each other: the first and the one behind the last.
    fn in_arrays(&self) -> Option<[u32; 2]> {
        Some([self.arrays.first()?.references.start, self.arrays.last()?.references.end])
    }

    /// What the variable of a reference stands for.
    #[inline]
    pub fn quantity(&self, reference: u32) -> Option<Quantity> {
        self.quantities.get(place(reference)?).copied()
    }

    /// Adds a variable that so far depends on nothing; returns its reference.
    fn push(&mut self, quantity: Quantity, name: String, description: String) -> u32 {
        // A table of 2^32 variables cannot be built in memory, so the index always fits.
        let reference = u32::try_from(self.variables.len() + 1).unwrap_or(u32::MAX);
        self.quantities.push(quantity);
        self.variables.push(Variable {
            reference,
            name,
            description,
            quantity,
            unit: quantity.unit(),
            start: quantity.start().map(String::from),
            dependencies: Vec::new(),
            initial_dependencies: Vec::new(),
            derivative_of: None,
            nominal: None,
            tunable: false,
        });
        reference
    }

    /// Adds a variable with a unit of its own.
    fn push_own(&mut self, quantity: Quantity, name: &str, description: &str, unit: &'static str) {
        self.push(quantity, name.into(), description.into());
        if let Some(variable) = self.variables.last_mut() {
            variable.unit = Some(unit);
        }
    }

    /// Adds a continuous state and its derivative.
    fn push_state(&mut self, state: Quantity, rate: Quantity, name: &str, description: String, nominal: f64) {
        let of = self.push(state, name.into(), description);
        self.push(rate, format!("der({name})"), described!("Time derivative of {name}"));
        if let [.., state, rate] = self.variables.as_mut_slice() {
            (state.nominal, rate.derivative_of) = (Some(nominal), Some(of));
        }
    }

    fn push_outputs(&mut self, word: &str, quantity: fn(usize) -> Quantity, (ports, names): (&Ports, &PortNames)) {
        for (port, place) in ports.responses.iter().enumerate() {
            let name = format!("{word}_{}", names.response(port));
            self.push(quantity(port), name, described!("The panel's {word} {}", at(place)));
        }
    }

    fn push_modes(&mut self, model: &ModalModel, resource: &Resource) {
        let (frame, kept) = (resource.frame_motions(), model.modes().len() - resource.residual_modes());
        let nominals = nominals::of(model, resource.ports().forces.len());
        for (index, (mode, [position, velocity])) in model.modes().iter().zip(nominals).enumerate() {
            let number = index + 1;
            let kind = match index {
                index if index < frame => "the frame's motion",
                index if index < kept => "mode",
                _ => "residual mode",
            };
            let of = described!("of {kind} {number} ({:.2} Hz), mass-normalised", mode.angular_frequency / TAU);
            let (state, rate) = (Quantity::ModalPosition(index), Quantity::ModalPositionRate(index));
            self.push_state(state, rate, &format!("modal_position_{number}"), described!("Coordinate {of}"), position);
            let (state, rate) = (Quantity::ModalVelocity(index), Quantity::ModalVelocityRate(index));
            self.push_state(state, rate, &format!("modal_velocity_{number}"), described!("Velocity {of}"), velocity);
        }
    }
}

fn place(reference: u32) -> Option<usize> {
    usize::try_from(reference).ok()?.checked_sub(1)
}

fn at(place: &Place) -> String {
    format!("at x = {} m, y = {} m from the centre, positive along +z", place.x, place.y)
}

const HOLD: &str = "Held at the value set over each step, unless the importer gives its first derivative (FMI 2, for \
                    the next step) or force_linear is true";

const FORCE_LINEAR: &str = "If true, every force runs linearly over a step, from its value at the end of the last step \
                            to the value now set (set the value of the step's end before the step); if false, it is \
                            held at the value now set";
