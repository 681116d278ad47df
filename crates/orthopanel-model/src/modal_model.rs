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
    /// Empty where nothing couples the modes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    damping_coupling: Vec<Vec<f64>>,
    /// Alike.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    stiffness_coupling: Vec<Vec<f64>>,
}

impl ModalModel {
    /// Joins modes into a model with `force_count` force ports and `response_count` response ports.
    ///
    /// # Errors
    /// [`ModelError::PortCount`] where a mode's lists have another length, [`ModelError::Frequency`],
    /// [`ModelError::NotFinite`] and [`ModelError::Damping`] where a number has no physical meaning.
    pub fn new(force_count: usize, response_count: usize, modes: Vec<Mode>) -> Result<Self, ModelError> {
        Self { force_count, response_count, modes, damping_coupling: vec![], stiffness_coupling: vec![] }.checked()
    }

    /// The same modes with dampers that couple them: $c_{mn}$ \[1/s\], a row a mode, in
    /// $$\ddot a_m + 2\zeta_m\omega_m\dot a_m + \sum_nc_{mn}\dot a_n + \omega_m^2a_m + \sum_nk_{mn}a_n = \sum_kW_m(x_k)f_k.$$
    ///
    /// # Errors
    /// [`ModelError::StateCount`] for another number of rows or columns than modes, [`ModelError::NotFinite`].
    pub fn with_damping_coupling(self, damping_coupling: Vec<Vec<f64>>) -> Result<Self, ModelError> {
        Self { damping_coupling, ..self }.checked()
    }

    /// The same modes with springs that couple them, $k_{mn}$ \[1/s²\] in the equation of [`ModalModel::with_damping_coupling`].
    ///
    /// # Errors
    /// As there.
    pub fn with_stiffness_coupling(self, stiffness_coupling: Vec<Vec<f64>>) -> Result<Self, ModelError> {
        Self { stiffness_coupling, ..self }.checked()
    }

    /// $k_{mn}$ \[1/s²\] of [`ModalModel::with_stiffness_coupling`]; empty where none couples the modes.
    pub fn stiffness_coupling(&self) -> &[Vec<f64>] {
        &self.stiffness_coupling
    }

    /// $c_{mn}$ \[1/s\] of [`ModalModel::with_damping_coupling`]; empty where nothing couples the modes.
    pub fn damping_coupling(&self) -> &[Vec<f64>] {
        &self.damping_coupling
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
                return Err(ModelError::Frequency { mode: index + 1, value: mode.angular_frequency });
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
        let expected = self.modes.len();
        for (what, coupling) in
            [("coupling of damping", &self.damping_coupling), ("coupling of stiffness", &self.stiffness_coupling)]
        {
            let lists = coupling.iter().map(Vec::len).chain([coupling.len()]);
            if let Some(found) = lists.filter(|_| !coupling.is_empty()).find(|&list| list != expected) {
                return Err(ModelError::StateCount { found, expected });
            }
            if let Some(&value) = coupling.iter().flatten().find(|value| !value.is_finite()) {
                return Err(ModelError::NotFinite { what, value });
            }
        }
        Ok(self)
    }

    /// The same modes, those whose entry of `turn` is true in the other sense: what they are to stays the same motion.
    pub(crate) fn turned(mut self, turn: &[bool]) -> Self {
        let flip = |value: &mut f64| *value = -*value;
        for (mode, _) in self.modes.iter_mut().zip(turn).filter(|(_, turn)| **turn) {
            mode.at_forces.iter_mut().chain(&mut mode.at_responses).for_each(flip);
        }
        for coupling in [&mut self.damping_coupling, &mut self.stiffness_coupling] {
            for (row, one) in coupling.iter_mut().zip(turn) {
                row.iter_mut().zip(turn).filter(|(_, other)| *other != one).for_each(|(value, _)| flip(value));
            }
        }
        self
    }

    /// Adds modes behind these, which nothing couples to them.
    pub(crate) fn join(&mut self, further: Vec<Mode>) {
        let size = self.modes.len() + further.len();
        self.modes.extend(further);
        for coupling in [&mut self.damping_coupling, &mut self.stiffness_coupling] {
            if !coupling.is_empty() {
                coupling.resize(size, vec![]);
                coupling.iter_mut().for_each(|row| row.resize(size, 0.0));
            }
        }
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

    /// The modes that vibrate, without the rigid ones.
    pub fn flexible(&self) -> impl Iterator<Item = &Mode> {
        self.modes.iter().filter(|mode| mode.angular_frequency > 0.0)
    }

    /// What these modes leave of a static flexibility $G$ over all flexible modes, $G - \sum_mW_r(m)W_f(m)/\omega_m^2$ \[m/N\]:
    /// a row a response, a column a force, in `all` as in what is returned.
    pub fn left_of_flexibility(&self, mut all: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        for mode in self.flexible() {
            add_flexibility(&mut all, -1.0, mode.angular_frequency, (&mode.at_responses, &mode.at_forces));
        }
        all
    }
}

/// Adds so many times $W_rW_f/\omega^2$ \[m/N\] of a mode to a row a response, a column a force.
pub(crate) fn add_flexibility(sum: &mut [Vec<f64>], times: f64, omega: f64, (responses, forces): (&[f64], &[f64])) {
    let omega2 = omega.powi(2);
    for (row, response) in sum.iter_mut().zip(responses) {
        row.iter_mut().zip(forces).for_each(|(value, force)| *value += times * (response * force / omega2));
    }
}
