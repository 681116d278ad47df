//! The state machine: states of the life cycle and which of them allow which call.

use serde::{Deserialize, Serialize};

use super::Component;
use crate::FmuError;

/// The interface through which an instance is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Interface {
    /// The instance advances itself, step by step.
    CoSimulation,
    /// The importer integrates the modal coordinates.
    ModelExchange,
}

/// States of the life cycle, common to FMI 2.0 and 3.0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    Instantiated,
    Initialization,
    /// Co-simulation, between steps.
    Step,
    /// Model exchange, at an event.
    Event,
    /// Model exchange, between events.
    ContinuousTime,
    Terminated,
}

impl Phase {
    pub(super) const RUNNING: &[Self] = &[Self::Step, Self::Event, Self::ContinuousTime];
    pub(super) const SETTABLE: &[Self] =
        &[Self::Instantiated, Self::Initialization, Self::Step, Self::Event, Self::ContinuousTime];
    pub(super) const READABLE: &[Self] =
        &[Self::Initialization, Self::Step, Self::Event, Self::ContinuousTime, Self::Terminated];
    /// Where partial derivatives of equations exist.
    pub(super) const DIFFERENTIABLE: &[Self] = Self::READABLE;
    /// Until here parameters and the initial state are set.
    pub(super) const BEFORE_START: &[Self] = &[Self::Instantiated, Self::Initialization];

    fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated",
            Self::Initialization => "initialization mode",
            Self::Step => "step mode (co-simulation, between steps)",
            Self::Event => "event mode (model exchange)",
            Self::ContinuousTime => "continuous-time mode (model exchange)",
            Self::Terminated => "terminated",
        }
    }
}

impl Component {
    /// Refuses a call that the present state does not allow.
    pub(super) fn require(&self, allowed: &[Phase]) -> Result<(), FmuError> {
        if allowed.contains(&self.now.phase) {
            return Ok(());
        }
        let allowed = allowed.iter().map(|phase| phase.name()).collect::<Vec<_>>().join(", ");
        Err(FmuError::Order { state: self.now.phase.name(), allowed })
    }

    fn change(&mut self, from: &[Phase], to: Phase) -> Result<(), FmuError> {
        self.require(from)?;
        self.now.phase = to;
        Ok(())
    }

    pub(crate) fn enter_initialization(&mut self) -> Result<(), FmuError> {
        self.change(&[Phase::Instantiated], Phase::Initialization)
    }

    /// Ends initialization; an instance that the importer integrates then stands at an event.
    pub(crate) fn exit_initialization(&mut self) -> Result<(), FmuError> {
        self.require(&[Phase::Initialization])?;
        self.apply()?;
        self.now.forces_before.copy_from_slice(&self.now.forces);
        let next = match self.now.interface {
            Interface::CoSimulation => Phase::Step,
            Interface::ModelExchange => Phase::Event,
        };
        self.change(&[Phase::Initialization], next)
    }

    pub(crate) fn enter_event_mode(&mut self) -> Result<(), FmuError> {
        self.change(&[Phase::ContinuousTime], Phase::Event)
    }

    pub(crate) fn enter_continuous_time_mode(&mut self) -> Result<(), FmuError> {
        self.change(&[Phase::Event], Phase::ContinuousTime)
    }

    /// An event needs nothing of a linear panel: this only asks whether it is allowed now.
    pub(crate) fn update_discrete_states(&self) -> Result<(), FmuError> {
        self.require(&[Phase::Event])
    }

    /// As [`Component::update_discrete_states`], after a step of the importer's integrator.
    pub(crate) fn completed_integrator_step(&self) -> Result<(), FmuError> {
        self.require(&[Phase::ContinuousTime])
    }

    pub(crate) fn terminate(&mut self) -> Result<(), FmuError> {
        self.change(Phase::RUNNING, Phase::Terminated)
    }
}
