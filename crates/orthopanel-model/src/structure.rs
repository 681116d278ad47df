//! What can vibrate: the layer on which beams, plates and every later structure stand.

use faer::{ColRef, Mat};

use crate::{Constant, ModelError, Place};

/// A structure with named elastic constants, on a Ritz basis.
///
/// Its stiffness is affine in coefficients $c_i$ of the constants, $K = \sum_i c_iK_i$, so that each step of an
/// identification is one weighted sum and one symmetric eigenproblem, and
/// $$\frac{\partial\omega^2}{\partial c_i} = \phi^TK_i\phi$$
/// comes for free. The coordinates split into blocks that nothing couples (parities, where the boundary allows).
///
/// All lists of constants stand in the order of [`Structure::constants`].
pub trait Structure {
    /// The elastic constants, with unit and bounds.
    fn constants(&self) -> &'static [Constant];

    /// The coefficients $c_i$ at these values of the constants.
    ///
    /// # Errors
    /// [`ModelError`] where the values have no physical meaning.
    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError>;

    /// $\partial c_i/\partial p_j$: a row a coefficient, a column a constant.
    ///
    /// # Errors
    /// As [`Structure::coefficients`].
    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError>;

    /// The uncoupled blocks.
    fn blocks(&self) -> &[Block];

    /// Deflection $w$ at a place of each coordinate of a block: with coordinates $\phi$, $w = \text{row}\cdot\phi$.
    fn shape_row(&self, block: usize, place: Place) -> Vec<f64>;

    /// Number of flexible modes that the basis resolves. Half of its coordinates unless said: the upper half of a Ritz
    /// spectrum belongs to the basis, not to the structure.
    fn resolved_modes(&self) -> usize {
        self.blocks().iter().map(Block::size).sum::<usize>() / 2
    }
}

/// Coordinates that only couple among themselves.
#[derive(Debug, Clone)]
pub struct Block {
    /// $K_i$, one symmetric matrix a coefficient.
    pub stiffness: Vec<Mat<f64>>,
    /// The mass matrix, symmetric and positive definite.
    pub mass: Mat<f64>,
    /// The rigid modes that lie in this block, mass-normalised and orthogonal to each other.
    pub rigid: Vec<Vec<f64>>,
}

impl Block {
    /// Number of coordinates.
    pub fn size(&self) -> usize {
        self.mass.nrows()
    }
}

/// A mode of a [`Structure`].
#[derive(Debug, Clone, PartialEq)]
pub struct RitzMode {
    /// $\omega$ \[rad/s\]; zero for a rigid mode.
    pub angular_frequency: f64,
    /// The block whose coordinates move.
    pub block: usize,
    /// Coordinates of that block, $\phi^TM\phi = 1$.
    pub coordinates: Vec<f64>,
}

impl RitzMode {
    /// Deflection \[kg^-1/2\] at a place.
    pub fn deflection(&self, structure: &dyn Structure, place: Place) -> f64 {
        let row = structure.shape_row(self.block, place);
        row.iter().zip(&self.coordinates).map(|(value, coordinate)| value * coordinate).sum()
    }

    /// $\partial\omega^2/\partial c_i = \phi^TK_i\phi$ for each coefficient.
    pub fn coefficient_sensitivity(&self, structure: &dyn Structure) -> Vec<f64> {
        let stiffness = structure.blocks().get(self.block).map_or(&[][..], |block| &block.stiffness);
        stiffness.iter().map(|matrix| quadratic_form(matrix, &self.coordinates)).collect()
    }
}

/// $v^TAv$.
pub(crate) fn quadratic_form(matrix: &Mat<f64>, vector: &[f64]) -> f64 {
    let vector = ColRef::from_slice(vector);
    vector.transpose() * (matrix * vector)
}
