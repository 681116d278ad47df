//! Phases of the life cycle, and which of them allow which call.

use serde::{Deserialize, Serialize};

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
    pub(super) const ALL: [Self; 6] =
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

    pub(super) fn name(self) -> &'static str {
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
