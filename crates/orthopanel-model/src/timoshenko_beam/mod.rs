//! The orthotropic Timoshenko beam of the paper (section 2.3), three ways: exact, Ritz and finite element.
//!
//! $$\begin{aligned}
//! (E_x I\psi')' - k'G_{zx}A(w'+\psi) - \rho I\ddot\psi &= 0,\\\\
//! (k'G_{zx}A(w'+\psi))' - \rho A\ddot w + f\,\delta(x-l_1) &= 0 \qquad\text{(eq. 5)}
//! \end{aligned}$$
//! with $A = bt$, $I = bt^3/12$ and the shear coefficient $k' = 2/3$. The rotation $\psi$ is counted so that the
//! shear strain is $w' + \psi$: without shear, $\psi = -w'$.

mod beam_terms;
mod exact;
mod finite_element;
mod inertial_remainder;
mod ritz;
mod static_field;
mod static_flexibility;
mod static_shape;
mod strain_basis;
mod term_matrices;

pub use beam_terms::{BeamTerms, ShearLoss, Support};
pub use exact::{BeamMode, ExactBeam};
pub use finite_element::BeamElements;
pub use ritz::TimoshenkoBeam;
pub use static_flexibility::StaticFlexibility;
pub(crate) use static_shape::{Grid, StaticShape, StaticShapes};

use crate::constant::Constant;
use crate::{ModelError, Piece};

/// Shear coefficient $k'$ of the rectangular section, as in the paper. Only $k'G_{zx}$ can be identified, so this
/// value scales $G_{zx}$.
pub const SHEAR_COEFFICIENT: f64 = 2.0 / 3.0;

/// The constants of the beam, in the order in which every list of them stands.
pub const BEAM_CONSTANTS: [Constant; 2] = [
    Constant { name: "e_x", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "g_zx", unit: "Pa", low: 1e3, high: 1e15 },
];

/// Elastic constants of the beam (eq. 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamConstants {
    /// Longitudinal elastic constant $E_x$ \[Pa\].
    pub e_x: f64,
    /// Shear elastic constant $G_{zx}$ \[Pa\].
    pub g_zx: f64,
}

impl BeamConstants {
    /// Checks both against their bounds.
    ///
    /// # Errors
    /// [`ModelError::Constant`] names the one outside.
    pub fn checked(self) -> Result<Self, ModelError> {
        BEAM_CONSTANTS[0].check(self.e_x)?;
        BEAM_CONSTANTS[1].check(self.g_zx)?;
        Ok(self)
    }
}

/// Stiffness and inertia of the section, per unit length where a length enters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Section {
    /// $I$ \[m⁴\]: bending stiffness per unit of $E_x$.
    pub second_moment: f64,
    /// $k'A$ \[m²\]: shear stiffness per unit of $G_{zx}$.
    pub shear_area: f64,
    /// $\rho A$ \[kg/m\].
    pub mass: f64,
    /// $\rho I$ \[kg m\].
    pub rotary_inertia: f64,
}

impl Section {
    pub(crate) fn of(piece: &Piece) -> Self {
        let Piece { width, thickness, mass_per_area, .. } = *piece;
        Self {
            second_moment: width * thickness.powi(3) / 12.0,
            shear_area: SHEAR_COEFFICIENT * width * thickness,
            mass: mass_per_area * width,
            rotary_inertia: mass_per_area * width * thickness * thickness / 12.0,
        }
    }
}

/// Gauss points and weights on $[-1, 1]$: four of them integrate the products of two cubics exactly.
pub(crate) fn gauss_points() -> [(f64, f64); 4] {
    let root = (6.0_f64 / 5.0).sqrt() * 2.0 / 7.0;
    let (near, far) = ((3.0 / 7.0 - root).sqrt(), (3.0 / 7.0 + root).sqrt());
    let (heavy, light) = ((18.0 + 30.0_f64.sqrt()) / 36.0, (18.0 - 30.0_f64.sqrt()) / 36.0);
    [(-far, light), (-near, heavy), (near, heavy), (far, light)]
}
