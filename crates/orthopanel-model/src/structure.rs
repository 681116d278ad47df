//! What can vibrate: the layer on which beams, plates and every later structure stand.

use faer::Mat;

use crate::dense::dot;
use crate::{Constant, ModelError, Place, SymmetricMatrix};

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

    /// What [`Structure::shape_row`] is for the deflection, for any [`Motion`]; `None` where the structure has no such row.
    fn motion_row(&self, block: usize, motion: Motion, place: Place) -> Option<Vec<f64>> {
        (motion == Motion::Deflection).then(|| self.shape_row(block, place))
    }

    /// Static flexibility between two motions, of all flexible modes together and without the error of the basis; `None`
    /// where no closed form is known.
    fn static_flexibility(&self, _values: &[f64], _motions: [(Motion, Place); 2]) -> Option<f64> {
        None
    }

    /// What the basis lacks of the static flexibility between two motions; `None` where that is not known. Asked only where
    /// [`Structure::static_flexibility`] knows nothing.
    fn static_remainder(&self, _values: &[f64], _motions: [(Motion, Place); 2]) -> Option<f64> {
        None
    }

    /// [`Structure::static_remainder`] between the motions of two lists, a row each of the first, zero where one has none; `None` where nothing is
    /// known.
    fn static_remainders(&self, _values: &[f64], _motions: [&[(Motion, Place)]; 2]) -> Option<Mat<f64>> {
        None
    }

    /// What the basis lacks of $\sum_m\phi_{1m}\phi_{2m}/\omega_m^{2+2k}$ over all flexible modes between the motions of two lists, a row each of
    /// the first, from $k = 1$ on as far as that is known. They are the further terms of the series in $s^2$ that stands for the modes above a sum, of which
    /// [`Structure::static_flexibility`] is the first.
    fn inertial_remainders(&self, _values: &[f64], _motions: [&[(Motion, Place)]; 2]) -> Vec<Mat<f64>> {
        vec![]
    }
}

/// What moves at a place. A force works on a deflection, a couple on a rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// $w$ \[m\].
    Deflection,
    /// Mean of $w$ \[m\] over a square foot of 10 mm, on which something stands on a plate: under a force at a point a plate that shears
    /// gives way without limit. A beam's deflection.
    Foot,
    /// $\partial w/\partial x$ \[1\]: how the deflection changes when its place moves.
    Slope,
    /// $\partial w/\partial y$ \[1\]; zero of a beam.
    SlopeAcross,
    /// $\psi$ \[rad\], counted so that $\psi = -w'$ without shear.
    Rotation,
    /// $\partial\psi/\partial x$ \[1/m\]: how the rotation changes when its place moves.
    Curvature,
    /// A moment of a plate's shear strain over a square about the place; zero of a beam.
    Shear(ShearMoment),
}

/// $\int p_i(x)\,p_j(y)\,\gamma\,dx\,dy$ \[m\] of a shear strain over a square, as far as that lies on the plate, with Legendre polynomials that are
/// orthonormal there: the squares of all moments sum to $\int\gamma^2dx\,dy$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearMoment {
    /// Whether the strain is $\partial w/\partial y+\psi_y$; else $\partial w/\partial x+\psi_x$.
    pub across: bool,
    /// Side of the square \[m\].
    pub span: f64,
    /// $i$ and $j$.
    pub degrees: [usize; 2],
}

/// Coordinates that only couple among themselves.
#[derive(Debug, Clone)]
pub struct Block {
    /// $K_i$, one matrix a coefficient; an empty one is zero.
    pub stiffness: Vec<SymmetricMatrix>,
    /// The mass matrix, positive definite.
    pub mass: SymmetricMatrix,
    /// The rigid modes that lie in this block, mass-normalised and orthogonal to each other.
    pub rigid: Vec<Vec<f64>>,
}

impl Block {
    /// Number of coordinates.
    pub fn size(&self) -> usize {
        self.mass.nrows()
    }

    /// $K = \sum_ic_iK_i$.
    pub(crate) fn stiffness_at(&self, coefficients: &[f64]) -> SymmetricMatrix {
        let size = self.size();
        let terms = coefficients.iter().copied().zip(&self.stiffness).filter(|(_, matrix)| matrix.nrows() == size);
        SymmetricMatrix::sum(terms, size)
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
        stiffness.iter().map(|matrix| matrix.quadratic_form(&self.coordinates)).collect()
    }
}

/// $v^TAv$.
pub(crate) fn quadratic_form(matrix: &Mat<f64>, vector: &[f64]) -> f64 {
    let row = |(column, share): (usize, &f64)| share * dot(matrix.col_as_slice(column), vector);
    vector.iter().enumerate().map(row).sum()
}
