//! One variable, as the importer sees it.

use super::dependency::Dependency;
use super::quantity::Quantity;

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
