//! One instance without any C: the state of the FMI life cycle, the values set, and the stepper.

mod step;
mod values;

use orthopanel_model::ModalStepper;

use crate::{FmuError, Resource, VariableTable};

/// States of the life cycle, common to FMI 2.0 and 3.0 co-simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    Instantiated,
    Initialization,
    Step,
    Terminated,
}

impl Phase {
    fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::Step => "step mode (initialized, between steps)",
            Self::Terminated => "terminated",
        }
    }
}

/// One panel in a simulation.
#[derive(Debug)]
pub(crate) struct Component {
    variables: VariableTable,
    stepper: ModalStepper,
    phase: Phase,
    time: f64,
    stop_time: Option<f64>,
    force_linear: bool,
    /// Force at each port as set, and whether the stepper has yet to be told.
    forces: Vec<f64>,
    forces_changed: bool,
    /// Force at the end of the last step: where a linear force starts.
    forces_before: Vec<f64>,
    /// Input derivatives for the next step, and whether the importer gave some.
    force_rates: Vec<f64>,
    rates_given: bool,
    /// Force at the end of a step at these rates, while it is computed.
    forces_after: Vec<f64>,
}

impl Component {
    pub(crate) fn new(resource: &Resource) -> Self {
        let forces = vec![0.0; resource.model().force_count()];
        Self {
            variables: resource.variables(),
            stepper: ModalStepper::new(resource.model()),
            phase: Phase::Instantiated,
            time: 0.0,
            stop_time: None,
            force_linear: false,
            forces_changed: false,
            forces_before: forces.clone(),
            force_rates: forces.clone(),
            rates_given: false,
            forces_after: forces.clone(),
            forces,
        }
    }

    /// Sets start and stop time; both versions allow it before initialization.
    pub(crate) fn set_experiment(&mut self, start: f64, stop: Option<f64>) -> Result<(), FmuError> {
        self.require(&[Phase::Instantiated])?;
        finite("start time", start)?;
        if let Some(stop) = stop {
            finite("stop time", stop)?;
            if stop < start {
                return Err(FmuError::StopBeforeStart { start, stop });
            }
        }
        (self.time, self.stop_time) = (start, stop);
        Ok(())
    }

    pub(crate) fn enter_initialization(&mut self) -> Result<(), FmuError> {
        self.require(&[Phase::Instantiated])?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    pub(crate) fn exit_initialization(&mut self) -> Result<(), FmuError> {
        self.require(&[Phase::Initialization])?;
        self.phase = Phase::Step;
        self.forces_before.copy_from_slice(&self.forces);
        Ok(())
    }

    pub(crate) fn terminate(&mut self) -> Result<(), FmuError> {
        self.require(&[Phase::Step])?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Back to where instantiation left it.
    pub(crate) fn reset(&mut self) -> Result<(), FmuError> {
        let at_rest = vec![[0.0; 2]; self.stepper.state().len()];
        self.stepper.set_state(&at_rest)?;
        self.forces.fill(0.0);
        self.forces_before.fill(0.0);
        self.forget_rates();
        (self.forces_changed, self.force_linear) = (true, false);
        (self.phase, self.time, self.stop_time) = (Phase::Instantiated, 0.0, None);
        Ok(())
    }

    /// Time of the instance \[s\]: the end of the last step that succeeded.
    pub(crate) fn time(&self) -> f64 {
        self.time
    }

    fn require(&self, allowed: &[Phase]) -> Result<(), FmuError> {
        if allowed.contains(&self.phase) {
            return Ok(());
        }
        let allowed = allowed.iter().map(|phase| phase.name()).collect::<Vec<_>>().join(", ");
        Err(FmuError::Order { state: self.phase.name(), allowed })
    }

    fn forget_rates(&mut self) {
        self.force_rates.fill(0.0);
        self.rates_given = false;
    }

    /// Tells the stepper the force now, if it changed since.
    fn apply_forces(&mut self) -> Result<(), FmuError> {
        if self.forces_changed {
            self.stepper.set_forces(&self.forces)?;
            self.forces_changed = false;
        }
        Ok(())
    }
}

fn finite(what: &str, value: f64) -> Result<(), FmuError> {
    if value.is_finite() { Ok(()) } else { Err(FmuError::NotFinite { what: what.into(), value }) }
}

#[cfg(test)]
mod tests;
