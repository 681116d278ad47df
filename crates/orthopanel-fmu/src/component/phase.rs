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

/// Phases that allow a call, as bits: asked at every call, so it must cost nothing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Phases(u8);

impl Phases {
    const fn of(phases: &[Phase]) -> Self {
        let (mut bits, mut index) = (0, 0);
        while index < phases.len() {
            bits |= 1 << phases[index] as u8;
            index += 1;
        }
        Self(bits)
    }

    pub(super) fn contain(self, phase: Phase) -> bool {
        self.0 & (1 << phase as u8) != 0
    }
}

impl Phase {
    const ALL: [Self; 6] =
        [Self::Instantiated, Self::Initialization, Self::Step, Self::Event, Self::ContinuousTime, Self::Terminated];
    pub(super) const STEP: Phases = Phases::of(&[Self::Step]);
    pub(super) const INSTANTIATED: Phases = Phases::of(&[Self::Instantiated]);
    pub(super) const INITIALIZATION: Phases = Phases::of(&[Self::Initialization]);
    pub(super) const EVENT: Phases = Phases::of(&[Self::Event]);
    pub(super) const CONTINUOUS_TIME: Phases = Phases::of(&[Self::ContinuousTime]);
    pub(super) const MODEL_EXCHANGE: Phases = Phases::of(&[Self::Event, Self::ContinuousTime]);
    pub(super) const RUNNING: Phases = Phases::of(&[Self::Step, Self::Event, Self::ContinuousTime]);
    pub(super) const STEPPED: Phases = Phases::of(&[Self::Step, Self::Terminated]);
    pub(super) const SETTABLE: Phases =
        Phases::of(&[Self::Instantiated, Self::Initialization, Self::Step, Self::Event, Self::ContinuousTime]);
    pub(super) const READABLE: Phases =
        Phases::of(&[Self::Initialization, Self::Step, Self::Event, Self::ContinuousTime, Self::Terminated]);
    pub(super) const ANY: Phases = Phases::of(&Self::ALL);
    /// Here tunable parameters are set: in model exchange only at an event, for the states go on from other equations.
    pub(super) const TUNABLE: Phases = Phases::of(&[Self::Instantiated, Self::Initialization, Self::Step, Self::Event]);
    /// Until here fixed parameters and the initial state are set.
    pub(super) const BEFORE_START: Phases = Phases::of(&[Self::Instantiated, Self::Initialization]);

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
