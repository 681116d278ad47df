//! The variables of an FMU: one table for the XML and for the calls at run time.

use orthopanel_model::{ModalModel, Place, Ports};

/// What a variable stands for; ports are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The independent variable \[s\].
    Time,
    /// Parameter: does the force run linearly between the values set?
    ForceLinear,
    /// Input: force \[N\] at a force port.
    Force(usize),
    /// Output: acceleration \[m/s²\] at a response port.
    Acceleration(usize),
    /// Output: velocity \[m/s\] at a response port.
    Velocity(usize),
    /// Output: displacement \[m\] at a response port.
    Displacement(usize),
}

impl Quantity {
    /// Name of the unit; `None` for a Boolean.
    pub fn unit(self) -> Option<&'static str> {
        match self {
            Self::Time => Some("s"),
            Self::ForceLinear => None,
            Self::Force(_) => Some("N"),
            Self::Acceleration(_) => Some("m/s2"),
            Self::Velocity(_) => Some("m/s"),
            Self::Displacement(_) => Some("m"),
        }
    }

    /// FMI causality.
    pub fn causality(self) -> &'static str {
        match self {
            Self::Time => "independent",
            Self::ForceLinear => "parameter",
            Self::Force(_) => "input",
            Self::Acceleration(_) | Self::Velocity(_) | Self::Displacement(_) => "output",
        }
    }
}

/// One variable, as the importer sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Value reference: its place in the table.
    pub reference: u32,
    /// Name, without dots or brackets: some importers refuse these.
    pub name: String,
    /// One line on what it is, where, and its sign.
    pub description: String,
    /// What it stands for.
    pub quantity: Quantity,
    /// References of the inputs on which an output depends directly (without an integration between); empty for all
    /// but accelerations.
    pub dependencies: Vec<u32>,
}

/// A unit with its exponents of kg, m and s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unit {
    /// Name.
    pub name: &'static str,
    /// Exponents of the base units, those that are zero left out.
    pub exponents: &'static [(&'static str, i8)],
}

/// Every unit in use.
pub const UNITS: [Unit; 5] = [
    Unit { name: "s", exponents: &[("s", 1)] },
    Unit { name: "N", exponents: &[("kg", 1), ("m", 1), ("s", -2)] },
    Unit { name: "m/s2", exponents: &[("m", 1), ("s", -2)] },
    Unit { name: "m/s", exponents: &[("m", 1), ("s", -1)] },
    Unit { name: "m", exponents: &[("m", 1)] },
];

/// The variables of a panel; a variable's reference is its index.
///
/// Order: `time`, `force_linear`, then `force_1`.., `acceleration_1`.., `velocity_1`.., `displacement_1`..; ports are
/// counted from 1 in names.
#[derive(Debug, Clone, PartialEq)]
pub struct VariableTable(Vec<Variable>);

impl VariableTable {
    /// The table for a model and the places of its ports.
    pub fn new(model: &ModalModel, ports: &Ports) -> Self {
        let mut table = Self(Vec::new());
        table.push(Quantity::Time, "time".into(), "Time".into());
        table.push(Quantity::ForceLinear, "force_linear".into(), FORCE_LINEAR.into());
        for (port, place) in ports.forces.iter().enumerate() {
            table.push(Quantity::Force(port), format!("force_{}", port + 1), format!("Force {}. {HOLD}", at(place)));
        }
        table.push_outputs("acceleration", Quantity::Acceleration, ports);
        table.push_outputs("velocity", Quantity::Velocity, ports);
        table.push_outputs("displacement", Quantity::Displacement, ports);
        table.depend(model);
        table
    }

    /// All variables, in the order of their references.
    pub fn variables(&self) -> &[Variable] {
        &self.0
    }

    /// The variable of a reference.
    pub fn get(&self, reference: u32) -> Option<&Variable> {
        self.0.get(usize::try_from(reference).ok()?)
    }

    fn push(&mut self, quantity: Quantity, name: String, description: String) {
        // A table of 2^32 ports cannot be built in memory, so the index always fits.
        let reference = u32::try_from(self.0.len()).unwrap_or(u32::MAX);
        self.0.push(Variable { reference, name, description, quantity, dependencies: Vec::new() });
    }

    fn push_outputs(&mut self, word: &str, quantity: fn(usize) -> Quantity, ports: &Ports) {
        for (port, place) in ports.responses.iter().enumerate() {
            let number = port + 1;
            self.push(quantity(port), format!("{word}_{number}"), format!("The panel's {word} {}", at(place)));
        }
    }

    /// An acceleration depends on the forces that some mode joins it to: $\partial a_r/\partial f_k = \sum_m W_r W_k$.
    fn depend(&mut self, model: &ModalModel) {
        let forces: Vec<(u32, usize)> = self
            .0
            .iter()
            .filter_map(|variable| match variable.quantity {
                Quantity::Force(port) => Some((variable.reference, port)),
                _ => None,
            })
            .collect();
        for variable in &mut self.0 {
            if let Quantity::Acceleration(response) = variable.quantity {
                let reached = |&&(_, force): &&(u32, usize)| {
                    model.modes().iter().any(|mode| {
                        let at = |values: &[f64], port: usize| values.get(port).is_some_and(|&value| value != 0.0);
                        at(&mode.at_responses, response) && at(&mode.at_forces, force)
                    })
                };
                variable.dependencies = forces.iter().filter(reached).map(|&(reference, _)| reference).collect();
            }
        }
    }
}

fn at(place: &Place) -> String {
    format!("at x = {} m, y = {} m from the centre, positive along +z", place.x, place.y)
}

const HOLD: &str = "Held at the value set over each step, unless the importer gives its first derivative (FMI 2, for \
                    the next step) or force_linear is true";

const FORCE_LINEAR: &str = "If true, every force runs linearly over a step, from its value at the end of the last step \
                            to the value now set (set the value of the step's end before the step); if false, it is \
                            held at the value now set";
