//! A model as the matrices that control engineers know.

use orthopanel_model::{ModeRange, Ports};

use super::Model;
use crate::Error;
use crate::error::InFile as _;

/// $\dot x = Ax + Bf$, $\ddot w = Cx + Df$ in modal coordinates: the states are the modes' displacements $q_m$ \[m √kg\] in rising order,
/// the rigid ones first, then their velocities.
///
/// A row a list.
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpace {
    /// States x states: $\begin{bmatrix}0&I\\\\-\omega_m^2&-2\zeta_m\omega_m\end{bmatrix}$.
    pub a: Vec<Vec<f64>>,
    /// States x forces \[N\]: $\begin{bmatrix}0\\\\\phi_m(f)\end{bmatrix}$.
    pub b: Vec<Vec<f64>>,
    /// Accelerations \[m/s²\] x states.
    pub c: Vec<Vec<f64>>,
    /// Accelerations x forces \[1/kg\].
    pub d: Vec<Vec<f64>>,
}

impl Model {
    /// The modes of `range`, the rigid ones too, as seen from these ports; what all others yield is left out.
    ///
    /// # Errors
    /// [`Error::Model`], as where a viscoelastic core has no such matrices.
    ///
    /// # Examples
    /// ```
    /// use orthopanel::{Model, ModeRange};
    ///
    /// let model = Model::load("../../examples/plate.json")?;
    /// let matrices = model.state_space(ModeRange::Count(5), &model.panel().ports)?;
    /// // Three rigid modes of a free plate, and a position and a velocity of each mode.
    /// assert_eq!(matrices.a.len(), 2 * (3 + 5));
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn state_space(&self, range: ModeRange, ports: &Ports) -> Result<StateSpace, Error> {
        let modal = self.panel.modal_model(range, &ports.forces, &ports.responses).in_file(&self.name)?;
        let modes = modal.modes();
        let count = modes.len();
        let (forces, responses) = (ports.forces.len(), ports.responses.len());
        let zeros = |rows: usize, columns: usize| vec![vec![0.0; columns]; rows];
        let (mut a, mut b) = (zeros(2 * count, 2 * count), zeros(2 * count, forces));
        let (mut c, mut d) = (zeros(responses, 2 * count), zeros(responses, forces));
        for (index, mode) in modes.iter().enumerate() {
            let (omega, zeta) = (mode.angular_frequency, mode.damping_ratio);
            let [stiffness, damping] = [omega * omega, 2.0 * zeta * omega];
            a[index][count + index] = 1.0;
            a[count + index][index] = -stiffness;
            a[count + index][count + index] = -damping;
            b[count + index].copy_from_slice(&mode.at_forces);
            for (response, shape) in mode.at_responses.iter().enumerate() {
                c[response][index] = -stiffness * shape;
                c[response][count + index] = -damping * shape;
                for (force, at_force) in mode.at_forces.iter().enumerate() {
                    d[response][force] += shape * at_force;
                }
            }
        }
        Ok(StateSpace { a, b, c, d })
    }
}
