//! The variables of an FMU: one table for the XML and for the calls at run time.

mod arrays;
mod dependencies;
mod dependency;
mod quantity;
mod units;
mod variable;

use std::f64::consts::TAU;
use std::ops::Range;

use orthopanel_model::{ModalModel, Place, Ports};

use crate::{FmuError, PortNames, Resource, nominals};

pub use arrays::Array;
pub use dependency::{Dependency, Factor};
use quantity::HOLD;
pub use quantity::Quantity;
pub use units::{UNITS, Unit};
pub use variable::Variable;

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

const FORCE_LINEAR: &str = "If true, every force runs linearly over a step, from its value at the end of the last step \
                            to the value now set (set the value of the step's end before the step); if false, it is \
                            held at the value now set";
