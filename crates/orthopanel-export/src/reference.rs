//! The reference solution that lies in every FMU: a half-sine hit on the panel as exported, by which an importer checks itself.

use std::f64::consts::PI;
use std::fmt::Write as _;

use orthopanel_fmu::{Quantity, Resource, Variable};
use orthopanel_model::{ModalStepper, ModelError};

/// Steps of the run, and of the hit at its start.
const STEPS: usize = 400;
const OF_HIT: usize = 100;
/// \[N\]
const PEAK: f64 = 100.0;

/// Input and outputs as a table, and how to run it, as importers' cross-checks of the standard write both.
#[derive(Debug, Clone)]
pub(crate) struct Reference {
    pub(crate) table: String,
    pub(crate) settings: String,
}

impl Reference {
    /// Co-simulation by this step \[s\]: `force_1` is set at the start of each step and held over it, all other inputs are zero. A row has the
    /// force of the step that begins there and the outputs at its start, before that force is set.
    ///
    /// # Errors
    /// As [`ModalStepper::advance_held`].
    pub(crate) fn of(resource: &Resource, step: f64) -> Result<Self, ModelError> {
        let table = resource.variables();
        let is_output = |variable: &&Variable| variable.quantity.causality() == "output";
        let outputs: Vec<&Variable> = table.variables().iter().filter(is_output).collect();
        let force = table.variables().iter().find(|variable| variable.quantity == Quantity::Input(0));
        let mut text = String::from("time");
        for variable in force.into_iter().chain(outputs.iter().copied()) {
            text += ",";
            text += &variable.name;
        }
        text += "\n";
        let mut stepper = ModalStepper::new(resource.model());
        let mut forces = vec![0.0; resource.model().force_count()];
        for n in 0..=STEPS {
            let force = if n < OF_HIT { PEAK * (PI * n as f64 / OF_HIT as f64).sin() } else { 0.0 };
            // Writing to a String has nothing to fail on.
            let _ = write!(text, "{:e},{force:e}", n as f64 * step);
            for variable in &outputs {
                let value = match variable.quantity {
                    Quantity::Acceleration(port) => stepper.acceleration(port),
                    Quantity::Velocity(port) => stepper.velocity(port),
                    Quantity::Displacement(port) => stepper.displacement(port),
                    Quantity::Connected(output) => resource.connected(output, &stepper, &forces),
                    _ => None,
                };
                let _ = write!(text, ",{:e}", value.unwrap_or(f64::NAN));
            }
            text += "\n";
            if let Some(first) = forces.first_mut() {
                *first = force;
            }
            stepper.set_forces(&forces)?;
            stepper.advance_held(step)?;
        }
        let stop = STEPS as f64 * step;
        let settings = format!(
            "StartTime, 0\nStopTime, {stop:e}\nStepSize, {step:e}\nRelTol, 0\nAbsTol, 0\nSolver, none (co-simulation)\n\
             OutputIntervalLength, {step:e}\n"
        );
        Ok(Self { table: text, settings })
    }
}
