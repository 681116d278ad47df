//! All that calls can change in an instance, so that it can be kept, put back and carried away.

use serde::{Deserialize, Serialize};

use super::phase::{Interface, Phase};
use super::settable_numbers::timely;
use crate::FmuError;

/// What an instance holds beside the motion of its modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Situation {
    pub(super) interface: Interface,
    pub(super) phase: Phase,
    /// \[s\]
    pub(super) time: f64,
    pub(super) stop_time: Option<f64>,
    pub(super) force_linear: bool,
    /// Force at each port as set \[N\].
    pub(super) forces: Vec<f64>,
    /// With `force_linear`: force at the end of the last step, where the next one starts.
    pub(super) forces_before: Vec<f64>,
    /// Input derivatives for the next step \[N/s\], and whether the importer gave some.
    pub(super) force_rates: Vec<f64>,
    pub(super) rates_given: bool,
    /// Rate of each force over the last step \[N/s\], for the derivatives of outputs; zero where none was given.
    pub(super) slopes: Vec<f64>,
    pub(super) slopes_given: bool,
    /// Parameters of the panel as set.
    pub(super) parameters: Vec<f64>,
}

impl Situation {
    pub(super) fn new(interface: Interface, force_count: usize, parameters: Vec<f64>) -> Self {
        let forces = vec![0.0; force_count];
        Self {
            interface,
            phase: Phase::Instantiated,
            time: 0.0,
            stop_time: None,
            force_linear: false,
            forces_before: forces.clone(),
            force_rates: forces.clone(),
            rates_given: false,
            slopes: forces.clone(),
            slopes_given: false,
            parameters,
            forces,
        }
    }

    /// The forces that act now: those set, but with `force_linear` between steps those at the end of the last step, for
    /// what was set since is reached at the end of the next one only. Masters that hand over values before they read
    /// outputs would else see accelerations a step ahead of the motion.
    pub(super) fn forces_in_effect(&self) -> &[f64] {
        if self.forces_wait() { &self.forces_before } else { &self.forces }
    }

    /// Do the forces set act at the end of the next step only?
    pub(super) fn forces_wait(&self) -> bool {
        let between_steps = self.force_linear && matches!(self.phase, Phase::Step | Phase::Terminated);
        between_steps && self.interface == Interface::CoSimulation
    }

    /// Does it fit an instance that now stands in `other`, and is every number one?
    pub(super) fn check(&self, other: &Self) -> Result<(), FmuError> {
        if self.interface != other.interface {
            return Err(FmuError::State("it was taken from an instance of the other interface"));
        }
        let lists = [&self.forces, &self.forces_before, &self.force_rates, &self.slopes];
        if lists.iter().any(|list| list.len() != other.forces.len()) || self.parameters.len() != other.parameters.len()
        {
            return Err(FmuError::State("it holds another number of forces or parameters"));
        }
        let numbers = lists.into_iter().flatten().chain(&self.parameters).chain(&self.stop_time).chain([&self.time]);
        if numbers.into_iter().any(|number| !number.is_finite()) {
            return Err(FmuError::State("it holds a number that is not finite"));
        }
        timely("time of the FMU state", self.time)?;
        Ok(())
    }
}

/// An FMU state: where an instance stands, with the motion of its modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Snapshot {
    pub(super) situation: Situation,
    /// Modal coordinate and its rate of each mode.
    pub(super) motion: Vec<[f64; 2]>,
}
