//! One instance without any C: the state of the FMI life cycle, the values set, and the stepper.

mod continuous;
mod elements;
mod fmu_states;
mod kept_states;
mod life_cycle;
mod parameter_sensitivities;
mod parameters;
mod phase;
mod seen;
mod sensitivities;
mod settable_numbers;
mod situation;
mod snapshots;
mod step;
mod values;

use std::sync::Arc;

use crate::connections;
use crate::panel::Panel;
use crate::wide_stepper::WideStepper;
use crate::{FmuError, Quantity, Resource, VariableTable};

use kept_states::FmuStates;
pub(crate) use phase::{Interface, Phase};
use seen::{Seen, Settable};
use settable_numbers::{finite, timely};
use situation::Situation;

/// One panel in a simulation.
#[derive(Debug)]
pub(crate) struct Component {
    variables: VariableTable,
    stepper: WideStepper,
    now: Situation,
    /// Where [`Component::reset`] goes back to.
    start: Situation,
    /// The panel, where its modes may be found anew.
    settable: Option<Settable>,
    /// What the stepper's modes are.
    in_use: Arc<Seen>,
    /// Has the stepper yet to be told the forces?
    forces_changed: bool,
    /// Were parameters set for which the modes have yet to be found?
    parameters_changed: bool,
    /// Of each mount, where its base's displacement and velocity stand among the inputs.
    bases: Vec<[usize; 2]>,
    /// Force at the end of a step at given rates, while it is computed.
    forces_after: Vec<f64>,
    /// A panel of the same modes that derivatives are asked of.
    probe: Probe,
    /// Are the nominals others than the importer was told?
    nominals_changed: bool,
    states: FmuStates,
}

#[derive(Debug)]
struct Probe {
    stepper: WideStepper,
    forces: Vec<f64>,
}

impl Component {
    /// An instance of this resource, whose token is `token`.
    pub(crate) fn new(resource: &Resource, interface: Interface, token: &str) -> Self {
        let model = resource.model();
        let stepper = WideStepper::new(model);
        let forces = vec![0.0; model.force_count()];
        let in_use = Arc::new(Seen::exported(resource));
        let start = Situation::new(interface, forces.len(), in_use.values.clone());
        let settable = |panel: &Panel| Settable { panel: panel.clone(), exported: Arc::clone(&in_use) };
        Self {
            variables: VariableTable::new(resource),
            probe: Probe { stepper: stepper.clone(), forces: forces.clone() },
            stepper,
            now: start.clone(),
            start,
            settable: resource.panel().map(settable),
            in_use,
            forces_changed: false,
            parameters_changed: false,
            bases: resource.bases(),
            forces_after: forces,
            nominals_changed: false,
            states: FmuStates::new(token),
        }
    }

    /// Sets start and stop time; both versions allow it before initialization. A tolerance is of no use to steps that are
    /// exact, but must be one. Zero, which some importers pass for none, is.
    pub(crate) fn set_experiment(
        &mut self,
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    ) -> Result<(), FmuError> {
        self.require(Phase::INSTANTIATED)?;
        if let Some(value) = tolerance {
            finite("tolerance", value)?;
            if value < 0.0 {
                return Err(FmuError::Tolerance { value });
            }
        }
        timely("start time", start)?;
        // A stop time is held against others alone: importers give any for one that never comes.
        if let Some(stop) = stop {
            finite("stop time", stop)?;
            if stop < start {
                return Err(FmuError::StopBeforeStart { start, stop });
            }
        }
        (self.now.time, self.now.stop_time) = (start, stop);
        Ok(())
    }

    /// Time of the instance \[s\]: the end of the last step that succeeded, or the time that the importer set.
    pub(crate) fn time(&self) -> f64 {
        self.now.time
    }

    fn forget_rates(&mut self) {
        self.now.force_rates.fill(0.0);
        self.now.rates_given = false;
    }

    /// Tells the stepper what was set since it was last asked.
    #[inline(always)]
    fn apply(&mut self) -> Result<(), FmuError> {
        if self.forces_changed { self.tell_forces() } else { Ok(()) }
    }

    fn tell_forces(&mut self) -> Result<(), FmuError> {
        if self.parameters_changed {
            self.solve_for(&self.now.parameters.clone())?;
            self.parameters_changed = false;
        }
        self.stepper.set_forces(self.now.forces_in_effect())?;
        self.forces_changed = false;
        Ok(())
    }

    /// Value of a quantity of the panel, given its modes and forces; `None` for what is none of the panel's.
    #[inline(always)]
    fn panel_value(&self, quantity: Quantity, seen: &Seen, stepper: &WideStepper, forces: &[f64]) -> Option<f64> {
        match quantity {
            Quantity::Time | Quantity::ForceLinear => None,
            Quantity::Parameter(index) => self.now.parameters.get(index).copied(),
            Quantity::Input(port) => forces.get(port).copied(),
            Quantity::Acceleration(port) => stepper.acceleration(port),
            Quantity::Velocity(port) => stepper.velocity(port),
            Quantity::Displacement(port) => stepper.displacement(port),
            Quantity::Connected(output) => connections::value(seen.outputs.get(output)?, stepper, forces),
            Quantity::ModalPosition(mode) => stepper.mode_state(mode).map(|[position, _]| position),
            Quantity::ModalVelocity(mode) => stepper.mode_state(mode).map(|[_, velocity]| velocity),
            Quantity::ModalPositionRate(mode) => stepper.mode_rate(mode).map(|[velocity, _]| velocity),
            Quantity::ModalVelocityRate(mode) => stepper.mode_rate(mode).map(|[_, acceleration]| acceleration),
        }
    }
}

#[cfg(test)]
mod panel_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tunable_tests;
#[cfg(test)]
mod tuned_state_tests;
