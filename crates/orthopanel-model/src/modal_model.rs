//! The hinge of the house: everything that can vibrate becomes a [`ModalModel`]; accelerance, time response and
//! the FMU need nothing else.

use serde::{Deserialize, Serialize};

use crate::ModelError;

/// One mode, as seen from the ports.
///
/// The shape is mass-normalised (eq. 18), so the modal coordinate obeys eq. 20,
/// $$\ddot a + 2\zeta\omega\,\dot a + \omega^2 a = \sum_k W(x_k)\,f_k(t).$$
/// A rigid mode has $\omega = 0$ and $\zeta = 0$.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Undamped natural angular frequency $\omega$ \[rad/s\]; zero for a rigid mode.
    pub angular_frequency: f64,
    /// Modal damping ratio $\zeta$ \[1\].
    pub damping_ratio: f64,
    /// Shape value at each force port \[kg^-1/2\].
    pub at_forces: Vec<f64>,
    /// Shape value at each response port \[kg^-1/2\].
    pub at_responses: Vec<f64>,
}

/// Frequencies, damping ratios and shape values at the ports: all that accelerance, response and FMU need.
///
/// Modes stand in rising order of frequency, rigid modes first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModalModel {
    force_count: usize,
    response_count: usize,
    modes: Vec<Mode>,
}

impl ModalModel {
    /// Joins modes into a model with `force_count` force ports and `response_count` response ports.
    ///
    /// # Errors
    /// [`ModelError::PortCount`] where a mode's lists have another length, [`ModelError::NotFinite`] and
    /// [`ModelError::Damping`] where a number has no physical meaning.
    pub fn new(force_count: usize, response_count: usize, modes: Vec<Mode>) -> Result<Self, ModelError> {
        Self { force_count, response_count, modes }.checked()
    }

    /// Checks a model that came from a file.
    ///
    /// # Errors
    /// As [`ModalModel::new`].
    pub fn checked(self) -> Result<Self, ModelError> {
        for (index, mode) in self.modes.iter().enumerate() {
            let counts = [
                ("forces", mode.at_forces.len(), self.force_count),
                ("responses", mode.at_responses.len(), self.response_count),
            ];
            for (ports, found, expected) in counts {
                if found != expected {
                    return Err(ModelError::PortCount { mode: index + 1, ports, found, expected });
                }
            }
            if !(mode.angular_frequency.is_finite() && mode.angular_frequency >= 0.0) {
                return Err(ModelError::NotFinite { what: "angular frequency", value: mode.angular_frequency });
            }
            if !(0.0..1.0).contains(&mode.damping_ratio) {
                return Err(ModelError::Damping { mode: index + 1, value: mode.damping_ratio });
            }
            for &value in mode.at_forces.iter().chain(&mode.at_responses) {
                if !value.is_finite() {
                    return Err(ModelError::NotFinite { what: "shape value", value });
                }
            }
        }
        Ok(self)
    }

    /// Number of force ports.
    pub fn force_count(&self) -> usize {
        self.force_count
    }

    /// Number of response ports.
    pub fn response_count(&self) -> usize {
        self.response_count
    }

    /// The modes, rigid ones first.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }
}
