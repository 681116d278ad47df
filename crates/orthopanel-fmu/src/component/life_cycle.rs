//! The state machine: which call leads from one phase to another.

use super::Component;
use super::phase::{Interface, Phase, Phases};
use crate::FmuError;

impl Component {
    /// Refuses a call that the present state does not allow.
    #[inline]
    pub(super) fn require(&self, allowed: Phases) -> Result<(), FmuError> {
        if allowed.contain(self.now.phase) { Ok(()) } else { Err(self.out_of_order(allowed)) }
    }

    #[cold]
    fn out_of_order(&self, allowed: Phases) -> FmuError {
        let names = Phase::ALL.into_iter().filter(|&phase| allowed.contain(phase)).map(Phase::name);
        FmuError::Order { state: self.now.phase.name(), allowed: names.collect::<Vec<_>>().join(", ") }
    }

    fn change(&mut self, from: Phases, to: Phase) -> Result<(), FmuError> {
        self.require(from)?;
        self.now.phase = to;
        Ok(())
    }

    pub(crate) fn enter_initialization(&mut self) -> Result<(), FmuError> {
        self.change(Phase::INSTANTIATED, Phase::Initialization)
    }

    /// Ends initialization; an instance that the importer integrates then stands at an event.
    pub(crate) fn exit_initialization(&mut self) -> Result<(), FmuError> {
        self.require(Phase::INITIALIZATION)?;
        self.apply()?;
        self.now.forces_before.copy_from_slice(&self.now.forces);
        self.nominals_changed = false;
        let next = match self.now.interface {
            Interface::CoSimulation => Phase::Step,
            Interface::ModelExchange => Phase::Event,
        };
        self.change(Phase::INITIALIZATION, next)
    }

    pub(crate) fn enter_event_mode(&mut self) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::CONTINUOUS_TIME)?;
        self.change(Phase::CONTINUOUS_TIME, Phase::Event)
    }

    pub(crate) fn enter_continuous_time_mode(&mut self) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::EVENT)?;
        self.change(Phase::EVENT, Phase::ContinuousTime)
    }

    /// Ends a turn of an event, which needs nothing of a linear panel but that tunable parameters set in it are taken in; whether
    /// these have changed the sizes of states to be expected.
    pub(crate) fn update_discrete_states(&mut self) -> Result<bool, FmuError> {
        self.require_model_exchange(Phase::EVENT)?;
        self.apply()?;
        Ok(std::mem::take(&mut self.nominals_changed))
    }

    /// After a step of the importer's integrator, where nothing is to be done: this only asks whether it is allowed now.
    pub(crate) fn completed_integrator_step(&self) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::CONTINUOUS_TIME)
    }

    pub(crate) fn terminate(&mut self) -> Result<(), FmuError> {
        self.change(Phase::RUNNING, Phase::Terminated)
    }
}
