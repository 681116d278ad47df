//! Model exchange: the importer integrates the modal coordinates $a_m$ and their rates $\dot a_m$,
//! $$\frac{d}{dt}\begin{pmatrix}a_m\\\\ \dot a_m\end{pmatrix} =
//! \begin{pmatrix}\dot a_m\\\\ \sum_k W_m(x_k)f_k - 2\zeta_m\omega_m\dot a_m - \omega_m^2a_m\end{pmatrix}.$$
//!
//! States stand mode after mode: $a_1, \dot a_1, a_2, \dot a_2, \dots$; there are no event indicators.

use super::{Component, Phase, finite};
use crate::FmuError;

impl Component {
    /// Number of modes, rigid ones included.
    pub(super) fn mode_count(&self) -> usize {
        self.nominals.len()
    }

    /// Number of continuous states: two a mode.
    pub(crate) fn state_count(&self) -> usize {
        2 * self.mode_count()
    }

    /// Sets the time \[s\] at which derivatives and outputs are asked for.
    pub(crate) fn set_time(&mut self, time: f64) -> Result<(), FmuError> {
        self.require(Phase::MODEL_EXCHANGE)?;
        finite("time", time)?;
        self.now.time = time;
        Ok(())
    }

    pub(crate) fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), FmuError> {
        self.require(Phase::CONTINUOUS_TIME)?;
        self.same_states(states.len())?;
        if let Some(&value) = states.iter().find(|state| !state.is_finite()) {
            return finite("continuous state", value);
        }
        for (mode, pair) in states.chunks_exact(2).enumerate() {
            if let &[position, velocity] = pair {
                self.stepper.set_mode_state(mode, [position, velocity])?;
            }
        }
        Ok(())
    }

    pub(crate) fn get_continuous_states(&self, states: &mut [f64]) -> Result<(), FmuError> {
        self.require(Phase::READABLE)?;
        self.same_states(states.len())?;
        self.fill(states, |mode| self.stepper.mode_state(mode));
        Ok(())
    }

    /// Time derivatives of the states under the forces now set.
    pub(crate) fn get_state_derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), FmuError> {
        self.require(Phase::READABLE)?;
        self.same_states(derivatives.len())?;
        self.apply()?;
        self.fill(derivatives, |mode| self.stepper.mode_rate(mode));
        Ok(())
    }

    /// Sizes of the states to be expected, for the importer's error control.
    pub(crate) fn get_nominals(&self, nominals: &mut [f64]) -> Result<(), FmuError> {
        self.same_states(nominals.len())?;
        self.fill(nominals, |mode| self.nominals.get(mode).copied());
        Ok(())
    }

    fn fill(&self, values: &mut [f64], of_mode: impl Fn(usize) -> Option<[f64; 2]>) {
        for (mode, pair) in values.chunks_exact_mut(2).enumerate() {
            pair.copy_from_slice(&of_mode(mode).unwrap_or([f64::NAN; 2]));
        }
    }

    fn same_states(&self, found: usize) -> Result<(), FmuError> {
        let expected = self.state_count();
        if found == expected { Ok(()) } else { Err(FmuError::StateCount { found, expected }) }
    }
}
