//! Stiffness and mass of one block at given coefficients, ready to be solved.

use faer::Mat;

use crate::ModelError;
use crate::dense::{Cholesky, negative_pivots, norm, product, symmetric_eigen};
use crate::structure::Block;

/// $K$ and $M$ of a block, and the operator whose largest eigenvalues are its lowest modes.
///
/// With $LL^T = S(K+\sigma M)S$, $S$ the scale that makes the diagonal one, it is $A = L^{-1}SMSL^{-T}$, with
/// eigenvalues $\theta = 1/(\omega^2+\sigma)$ and shapes $\phi = SL^{-T}v/\sqrt\theta$. The lowest modes come out to
/// rounding, however stiff the highest are.
pub(crate) struct BlockPencil<'a> {
    block: &'a Block,
    sigma: f64,
    scale: Vec<f64>,
    /// $S(K+\sigma M)S$, its lower triangle.
    shifted: Mat<f64>,
    factor: Cholesky,
    /// $SMS$.
    mass: Mass,
}

/// A mass matrix: that of orthogonal functions has a diagonal alone.
enum Mass {
    Diagonal(Vec<f64>),
    Whole(Mat<f64>),
}

/// One mode of a block: $\omega^2$ and its mass-normalised coordinates.
pub(crate) type Eigenpair = (f64, Vec<f64>);

impl<'a> BlockPencil<'a> {
    /// # Errors
    /// [`ModelError::Eigenproblem`] where stiffness or mass is not positive.
    pub(crate) fn new(block: &'a Block, coefficients: &[f64]) -> Result<Self, ModelError> {
        let size = block.size();
        let mut shifted = Mat::<f64>::zeros(size, size);
        for column in 0..size {
            let sum = &mut shifted.col_as_slice_mut(column)[column..];
            for (matrix, &coefficient) in block.stiffness.iter().zip(coefficients) {
                if matrix.ncols() == size {
                    add(sum, coefficient, &matrix.col_as_slice(column)[column..]);
                }
            }
        }
        let sigma = shift(&shifted, &block.mass);
        // Unit diagonal first: Cholesky then keeps the digits of soft and stiff coordinates alike.
        let diagonal = |i: usize| shifted[(i, i)] + sigma * block.mass[(i, i)];
        let scale: Vec<f64> = (0..size).map(|i| diagonal(i).sqrt().recip()).collect();
        if scale.iter().any(|value| !value.is_finite()) {
            return Err(ModelError::Eigenproblem);
        }
        let mass = Mass::of(&block.mass, &scale);
        scale_both(&mut shifted, &scale);
        mass.add_to(&mut shifted, sigma);
        let factor = Cholesky::new(&shifted).ok_or(ModelError::Eigenproblem)?;
        Ok(Self { block, sigma, scale, shifted, factor, mass })
    }

    pub(crate) fn size(&self) -> usize {
        self.block.size()
    }

    pub(crate) fn rigid_count(&self) -> usize {
        self.block.rigid.len()
    }

    /// The rigid modes as unit vectors of $A$, a column each.
    pub(crate) fn rigid_vectors(&self) -> Mat<f64> {
        self.unit_vectors(&self.block.rigid)
    }

    /// The unit vectors of $A$ that stand for shapes.
    pub(crate) fn unit_vectors(&self, shapes: &[impl AsRef<[f64]>]) -> Mat<f64> {
        let coordinates = Mat::from_fn(self.size(), shapes.len(), |i, n| shapes[n].as_ref()[i] / self.scale[i]);
        let mut vectors = self.factor.upper_times(&coordinates);
        for mut column in vectors.col_iter_mut() {
            let norm = norm(column.as_ref());
            column /= faer::Scale(norm);
        }
        vectors
    }

    /// $AV$.
    pub(crate) fn apply(&self, vectors: &Mat<f64>) -> Mat<f64> {
        let mut half = vectors.clone();
        self.factor.solve_upper(&mut half);
        let mut image = self.mass.times(half);
        self.factor.solve_lower(&mut image);
        image
    }

    /// $(K+\sigma M)^{-1}B$.
    pub(crate) fn solve(&self, mut loads: Mat<f64>) -> Mat<f64> {
        self.scale_rows(&mut loads);
        self.factor.solve_lower(&mut loads);
        self.factor.solve_upper(&mut loads);
        self.scale_rows(&mut loads);
        loads
    }

    fn scale_rows(&self, columns: &mut Mat<f64>) {
        for column in 0..columns.ncols() {
            for (value, scale) in columns.col_as_slice_mut(column).iter_mut().zip(&self.scale) {
                *value *= scale;
            }
        }
    }

    /// $\omega^2$ that an eigenvalue of $A$ stands for.
    pub(crate) fn omega2(&self, theta: f64) -> f64 {
        (1.0 / theta - self.sigma).max(0.0)
    }

    /// Modes of unit eigenvectors of $A$, given as columns, with their eigenvalues.
    pub(crate) fn modes(&self, thetas: &[f64], mut vectors: Mat<f64>) -> Vec<Eigenpair> {
        self.factor.solve_upper(&mut vectors);
        let mode = |(column, &theta): (usize, &f64)| {
            let norm = theta.sqrt().recip();
            let coordinates = self.scale.iter().enumerate().map(|(row, s)| norm * s * vectors[(row, column)]).collect();
            (self.omega2(theta), coordinates)
        };
        thetas.iter().enumerate().map(mode).collect()
    }

    /// All flexible modes, rising.
    ///
    /// # Errors
    /// [`ModelError::Eigenproblem`] where the eigenvalues are not found.
    pub(crate) fn all_modes(&self) -> Result<Vec<Eigenpair>, ModelError> {
        let size = self.size();
        let image = self.apply(&Mat::identity(size, size));
        let symmetric = Mat::from_fn(size, size, |i, j| 0.5 * (image[(i, j)] + image[(j, i)]));
        let (mut thetas, vectors) = symmetric_eigen(&symmetric).ok_or(ModelError::Eigenproblem)?;
        // Largest θ first; the rigid modes are the very largest and are replaced by their exact shapes.
        let flexible = size - self.rigid_count();
        thetas.truncate(flexible);
        thetas.reverse();
        let vectors = Mat::from_fn(size, flexible, |i, j| vectors[(i, flexible - 1 - j)]);
        let modes = self.modes(&thetas, vectors);
        Ok(modes.into_iter().filter(|(omega2, _)| omega2.is_finite()).collect())
    }

    /// Number of modes, rigid ones included, with $\omega^2$ below `limit`: the negative pivots of $K - \text{limit}\,M$
    /// (Sylvester's law of inertia). `None` where a pivot vanishes.
    pub(crate) fn count_below(&self, limit: f64) -> Option<usize> {
        let mut shifted = self.shifted.clone();
        self.mass.add_to(&mut shifted, -self.sigma - limit);
        negative_pivots(&shifted)
    }
}

impl Mass {
    /// $SMS$.
    fn of(mass: &Mat<f64>, scale: &[f64]) -> Self {
        let is_diagonal = |column: usize| {
            let [before, after] = [&mass.col_as_slice(column)[..column], &mass.col_as_slice(column)[column + 1..]];
            before.iter().chain(after).all(|value| *value == 0.0)
        };
        if (0..mass.ncols()).all(is_diagonal) {
            return Self::Diagonal((0..mass.ncols()).map(|i| scale[i] * scale[i] * mass[(i, i)]).collect());
        }
        let mut whole = mass.clone();
        scale_both(&mut whole, scale);
        Self::Whole(whole)
    }

    /// $MV$.
    fn times(&self, mut vectors: Mat<f64>) -> Mat<f64> {
        match self {
            Self::Diagonal(diagonal) => {
                for column in 0..vectors.ncols() {
                    vectors.col_as_slice_mut(column).iter_mut().zip(diagonal).for_each(|(value, mass)| *value *= mass);
                }
                vectors
            }
            Self::Whole(mass) => product(mass.as_ref(), vectors.as_ref()),
        }
    }

    /// Adds $cM$ to the lower triangle of a matrix.
    fn add_to(&self, sum: &mut Mat<f64>, coefficient: f64) {
        match self {
            Self::Diagonal(diagonal) => {
                diagonal.iter().enumerate().for_each(|(i, mass)| sum[(i, i)] += coefficient * mass);
            }
            Self::Whole(mass) => {
                for column in 0..mass.ncols() {
                    add(&mut sum.col_as_slice_mut(column)[column..], coefficient, &mass.col_as_slice(column)[column..]);
                }
            }
        }
    }
}

/// A shift of the size of the lowest $\omega^2$: the least Rayleigh quotient of a single coordinate that has stiffness.
pub(crate) fn shift(stiffness: &Mat<f64>, mass: &Mat<f64>) -> f64 {
    let quotients = (0..mass.nrows()).map(|i| stiffness[(i, i)] / mass[(i, i)]);
    let greatest = quotients.clone().fold(0.0, f64::max);
    quotients.filter(|&quotient| quotient > 1e-14 * greatest).fold(greatest, f64::min)
}

/// $a \mathrel{+}= cb$.
fn add(sum: &mut [f64], coefficient: f64, values: &[f64]) {
    sum.iter_mut().zip(values).for_each(|(total, value)| *total += coefficient * value);
}

/// $SAS$ with a diagonal $S$, in the place of $A$.
fn scale_both(matrix: &mut Mat<f64>, scale: &[f64]) {
    for (column, own) in scale.iter().enumerate() {
        for (value, row) in matrix.col_as_slice_mut(column).iter_mut().zip(scale) {
            *value *= own * row;
        }
    }
}
