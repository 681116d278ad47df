//! Model exchange: the importer integrates the modal coordinates $a_m$ and their rates $\dot a_m$,
//! $$\frac{d}{dt}\begin{pmatrix}a_m\\\\ \dot a_m\end{pmatrix} =
//! \begin{pmatrix}\dot a_m\\\\ \sum_k W_m(x_k)f_k - 2\zeta_m\omega_m\dot a_m - \omega_m^2a_m\end{pmatrix}.$$
//!
//! States stand mode after mode: $a_1, \dot a_1, a_2, \dot a_2, \dots$; there are no event indicators.

use super::phase::Phases;
use super::settable_numbers::{fits, fitting, timely};
use super::{Component, Interface, Phase};
use crate::FmuError;

impl Component {
    /// Number of modes, rigid ones included.
    pub(super) fn mode_count(&self) -> usize {
        self.in_use.modes.modes().len()
    }

    /// Number of continuous states: two a mode.
    pub(crate) fn state_count(&self) -> usize {
        2 * self.mode_count()
    }

    /// Refuses a call of model exchange where the instance is co-simulation.
    pub(super) fn require_model_exchange(&self, allowed: Phases) -> Result<(), FmuError> {
        match self.now.interface {
            Interface::ModelExchange => self.require(allowed),
            Interface::CoSimulation => Err(FmuError::ModelExchangeOnly),
        }
    }

    /// Sets the time \[s\] at which derivatives and outputs are asked for.
    pub(crate) fn set_time(&mut self, time: f64) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::MODEL_EXCHANGE)?;
        timely("time", time)?;
        self.now.time = time;
        Ok(())
    }

    pub(crate) fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::CONTINUOUS_TIME)?;
        self.same_states(states.len())?;
        if let Some(&value) = states.iter().find(|state| !fits(**state)) {
            return fitting("continuous state", value);
        }
        for (mode, pair) in states.chunks_exact(2).enumerate() {
            if let &[position, velocity] = pair {
                self.stepper.set_mode_state(mode, [position, velocity])?;
            }
        }
        Ok(())
    }

    pub(crate) fn get_continuous_states(&self, states: &mut [f64]) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::READABLE)?;
        self.same_states(states.len())?;
        self.fill(states, |mode| self.stepper.mode_state(mode))
    }

    /// Time derivatives of the states under the forces now set.
    pub(crate) fn get_state_derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::READABLE)?;
        self.same_states(derivatives.len())?;
        self.apply()?;
        self.fill(derivatives, |mode| self.stepper.mode_rate(mode))
    }

    /// Sizes of the states to be expected for the parameters now set, for the importer's error control.
    ///
    /// FMI 2.0 allows the call once instantiated (3.2.3), FMI 3.0 from initialization mode on (2.1.5).
    pub(crate) fn get_nominals(&mut self, nominals: &mut [f64], once_instantiated: bool) -> Result<(), FmuError> {
        self.require_model_exchange(if once_instantiated { Phase::ANY } else { Phase::READABLE })?;
        self.same_states(nominals.len())?;
        self.apply()?;
        self.fill(nominals, |mode| self.in_use.nominals.get(mode).copied())
    }

    /// There are none; `count` is the number asked for.
    pub(crate) fn get_event_indicators(&self, count: usize) -> Result<(), FmuError> {
        self.require_model_exchange(Phase::READABLE)?;
        if count == 0 { Ok(()) } else { Err(FmuError::NotOffered("no event indicators: ask for 0")) }
    }

    /// Numbers of states and event indicators are told in every state of the life cycle.
    pub(crate) fn count_for_model_exchange(&self, count: usize) -> Result<usize, FmuError> {
        self.require_model_exchange(Phase::ANY).map(|()| count)
    }

    fn fill(&self, values: &mut [f64], of_mode: impl Fn(usize) -> Option<[f64; 2]>) -> Result<(), FmuError> {
        for (mode, pair) in values.chunks_exact_mut(2).enumerate() {
            let found = of_mode(mode).unwrap_or([f64::NAN; 2]);
            if let Some(&value) = found.iter().find(|value| !value.is_finite()) {
                let what = format!("derivative of the state of mode {}", mode + 1);
                return Err(FmuError::Overflow { what, value });
            }
            pair.copy_from_slice(&found);
        }
        Ok(())
    }

    fn same_states(&self, found: usize) -> Result<(), FmuError> {
        let expected = self.state_count();
        if found == expected { Ok(()) } else { Err(FmuError::StateCount { found, expected }) }
    }
}
