//! Stiffness and mass of one block at given coefficients, ready to be solved.

use faer::Mat;

use crate::ModelError;
use crate::dense::{Cholesky, negative_pivots, symmetric_eigen};
use crate::skyline::{SkylineCholesky, SymmetricMatrix};
use crate::sparse_rows::SparseRows;
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
    /// $S(K+\sigma M)S$.
    shifted: SymmetricMatrix,
    factor: Factor,
    /// $SMS$.
    mass: SymmetricMatrix,
    /// The same without zeros, where that is worth it.
    mass_rows: Option<SparseRows>,
}

/// $LL^T$ by rows where few entries are not zero, else by blocks.
#[derive(Debug)]
pub(crate) enum Factor {
    Thin(SkylineCholesky),
    Dense(Cholesky),
}

/// One mode of a block: $\omega^2$ and its mass-normalised coordinates.
pub(crate) type Eigenpair = (f64, Vec<f64>);

impl<'a> BlockPencil<'a> {
    /// # Errors
    /// [`ModelError::Eigenproblem`] where stiffness or mass is not positive.
    pub(crate) fn new(block: &'a Block, coefficients: &[f64]) -> Result<Self, ModelError> {
        let stiffness = block.stiffness_at(coefficients);
        let sigma = shift(&stiffness, &block.mass);
        let sum = [(1.0, &stiffness), (sigma, &block.mass)];
        let shifted = SymmetricMatrix::sum(sum.into_iter(), block.size());
        // Unit diagonal first: Cholesky then keeps the digits of soft and stiff coordinates alike.
        let scale: Vec<f64> = (0..block.size()).map(|i| shifted[(i, i)].sqrt().recip()).collect();
        if scale.iter().any(|value| !value.is_finite()) {
            return Err(ModelError::Eigenproblem);
        }
        let (shifted, mass) = (shifted.scaled(&scale), block.mass.clone().scaled(&scale));
        let factor = Factor::new(&shifted).ok_or(ModelError::Eigenproblem)?;
        let mass_rows = SparseRows::of(&mass);
        Ok(Self { block, sigma, scale, shifted, factor, mass, mass_rows })
    }

    pub(crate) fn size(&self) -> usize {
        self.block.size()
    }

    pub(crate) fn rigid_count(&self) -> usize {
        self.block.rigid.len()
    }

    /// The rigid modes as unit vectors of $A$.
    pub(crate) fn rigid_vectors(&self) -> Vec<Vec<f64>> {
        self.unit_vectors(&self.block.rigid)
    }

    /// The unit vectors of $A$ that stand for shapes.
    pub(crate) fn unit_vectors(&self, shapes: &[impl AsRef<[f64]>]) -> Vec<Vec<f64>> {
        let unit = |shape: &[f64]| {
            let mut vector: Vec<f64> = shape.iter().zip(&self.scale).map(|(value, scale)| value / scale).collect();
            self.factor.upper_times(&mut vector);
            let norm = vector.iter().map(|value| value * value).sum::<f64>().sqrt();
            vector.iter_mut().for_each(|value| *value /= norm);
            vector
        };
        shapes.iter().map(|shape| unit(shape.as_ref())).collect()
    }

    /// $Av$.
    pub(crate) fn apply(&self, vector: &[f64]) -> Vec<f64> {
        let mut half = vector.to_vec();
        self.factor.solve_upper(&mut half);
        let mut image = self.mass_rows.as_ref().map_or_else(|| self.mass.image(&half), |rows| rows.image(&half));
        self.factor.solve_lower(&mut image);
        image
    }

    /// $(K+\sigma M)^{-1}B$.
    pub(crate) fn solve(&self, mut loads: Mat<f64>) -> Mat<f64> {
        self.scale_rows(&mut loads);
        self.factor.solve_lower_columns(&mut loads);
        self.factor.solve_upper_columns(&mut loads);
        self.scale_rows(&mut loads);
        loads
    }

    fn scale_rows(&self, columns: &mut Mat<f64>) {
        for column in 0..columns.ncols() {
            columns.col_as_slice_mut(column).iter_mut().zip(&self.scale).for_each(|(value, scale)| *value *= scale);
        }
    }

    /// $\omega^2$ that an eigenvalue of $A$ stands for.
    pub(crate) fn omega2(&self, theta: f64) -> f64 {
        (1.0 / theta - self.sigma).max(0.0)
    }

    /// The mode of a unit eigenvector of $A$ with its eigenvalue.
    pub(crate) fn mode(&self, theta: f64, mut vector: Vec<f64>) -> Eigenpair {
        self.factor.solve_upper(&mut vector);
        self.mode_of(theta, vector)
    }

    /// The same from $L^{-T}v$.
    fn mode_of(&self, theta: f64, mut vector: Vec<f64>) -> Eigenpair {
        let norm = theta.sqrt().recip();
        vector.iter_mut().zip(&self.scale).for_each(|(value, scale)| *value *= norm * scale);
        (self.omega2(theta), vector)
    }

    /// All flexible modes, rising.
    ///
    /// # Errors
    /// [`ModelError::Eigenproblem`] where the eigenvalues are not found.
    pub(crate) fn all_modes(&self) -> Result<Vec<Eigenpair>, ModelError> {
        let size = self.size();
        let mut half = self.mass.to_dense();
        self.factor.solve_lower_columns(&mut half);
        let mut image = half.transpose().to_owned();
        self.factor.solve_lower_columns(&mut image);
        let symmetric = Mat::from_fn(size, size, |i, j| 0.5 * (image[(i, j)] + image[(j, i)]));
        let (thetas, mut vectors) = symmetric_eigen(&symmetric).ok_or(ModelError::Eigenproblem)?;
        self.factor.solve_upper_columns(&mut vectors);
        // Largest θ first; the rigid modes are the very largest and are replaced by their exact shapes.
        let flexible = (0..size - self.rigid_count()).rev();
        let modes = flexible.map(|n| self.mode_of(thetas[n], vectors.col_as_slice(n).to_vec()));
        Ok(modes.filter(|(omega2, _)| omega2.is_finite()).collect())
    }

    /// Number of modes, rigid ones included, with $\omega^2$ below `limit`: the negative pivots of $K - \text{limit}\,M$
    /// (Sylvester's law of inertia). `None` where a pivot vanishes.
    pub(crate) fn count_below(&self, limit: f64) -> Option<usize> {
        let mut shifted = self.shifted.clone();
        shifted.add(-self.sigma - limit, &self.mass);
        if shifted.is_thin() { shifted.negative_pivots() } else { negative_pivots(&shifted.to_dense()) }
    }
}

impl Factor {
    /// `None` where the matrix is not positive definite.
    pub(crate) fn new(matrix: &SymmetricMatrix) -> Option<Self> {
        if matrix.is_thin() {
            SkylineCholesky::new(matrix).map(Self::Thin)
        } else {
            Cholesky::new(&matrix.to_dense()).map(Self::Dense)
        }
    }

    /// $L^{-1}b$ in the place of $b$.
    pub(crate) fn solve_lower(&self, vector: &mut [f64]) {
        match self {
            Self::Thin(factor) => factor.solve_lower(vector),
            Self::Dense(factor) => on_column(vector, |column| factor.solve_lower(column)),
        }
    }

    /// $L^{-1}B$ in the place of $B$.
    fn solve_lower_columns(&self, columns: &mut Mat<f64>) {
        match self {
            Self::Thin(factor) => each_column(columns, |column| factor.solve_lower(column)),
            Self::Dense(factor) => factor.solve_lower(columns),
        }
    }

    /// $L^{-T}B$ in the place of $B$.
    fn solve_upper_columns(&self, columns: &mut Mat<f64>) {
        match self {
            Self::Thin(factor) => each_column(columns, |column| factor.solve_upper(column)),
            Self::Dense(factor) => factor.solve_upper(columns),
        }
    }

    /// $L^{-T}b$ in the place of $b$.
    pub(crate) fn solve_upper(&self, vector: &mut [f64]) {
        match self {
            Self::Thin(factor) => factor.solve_upper(vector),
            Self::Dense(factor) => on_column(vector, |column| factor.solve_upper(column)),
        }
    }

    /// $L^Tb$ in the place of $b$.
    fn upper_times(&self, vector: &mut [f64]) {
        match self {
            Self::Thin(factor) => factor.upper_times(vector),
            Self::Dense(factor) => on_column(vector, |column| *column = factor.upper_times(column)),
        }
    }
}

fn each_column(columns: &mut Mat<f64>, work: impl Fn(&mut [f64])) {
    for column in 0..columns.ncols() {
        work(columns.col_as_slice_mut(column));
    }
}

fn on_column(vector: &mut [f64], work: impl Fn(&mut Mat<f64>)) {
    let mut column = Mat::from_fn(vector.len(), 1, |i, _| vector[i]);
    work(&mut column);
    vector.copy_from_slice(column.col_as_slice(0));
}

/// A shift of the size of the lowest $\omega^2$: the least Rayleigh quotient of a single coordinate that has stiffness.
pub(crate) fn shift(stiffness: &SymmetricMatrix, mass: &SymmetricMatrix) -> f64 {
    let quotients = (0..mass.nrows()).map(|i| stiffness[(i, i)] / mass[(i, i)]);
    let greatest = quotients.clone().fold(0.0, f64::max);
    quotients.filter(|&quotient| quotient > 1e-14 * greatest).fold(greatest, f64::min)
}
