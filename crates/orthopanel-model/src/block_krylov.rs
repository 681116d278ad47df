//! The lowest modes of a block without solving for all of them: block Lanczos on the inverted problem.
//!
//! Reference: G. H. Golub and R. Underwood, The block Lanczos method for computing eigenvalues, in Mathematical Software
//! III (1977) 361. All vectors are kept and orthogonalised twice, so no eigenvalue returns as a ghost.

use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Mat, MatMut, MatRef};

use crate::block_pencil::{BlockPencil, Eigenpair};
use crate::dense::{norm, product, symmetric_eigen};

/// Vectors a step; modes that coincide in this number are found together. More would find the space of as many vectors poorer.
const WIDTH: usize = 2;
/// Residual, over its eigenvalue, at which a vector has converged: its frequency is then exact to rounding.
const CONVERGED: f64 = 1e-8;
/// Vectors for each mode wanted from which on convergence is likely, where nothing is known.
const LIKELY: usize = 6;
/// What a step takes off a residual, on the quick side.
const GAIN: f64 = 15.0;
/// Residual at which a vector that began near its mode has converged: an eigenvalue errs by its square.
const NEARLY_CONVERGED: f64 = 1e-6;

/// The Krylov space of a block, which grows until the modes asked for have converged.
pub(crate) struct BlockKrylov {
    /// Orthonormal columns: the rigid modes, then the space.
    basis: Mat<f64>,
    /// $A$ times the space.
    images: Mat<f64>,
    /// With what the space grows next.
    next: Option<Mat<f64>>,
    rigid: usize,
    /// Residual at which a vector has converged.
    least: f64,
    /// Largest first: the eigenvalues of the projection, of which the first few have shapes.
    thetas: Vec<f64>,
    shapes: Mat<f64>,
    converged: usize,
}

impl BlockKrylov {
    /// From columns without preference.
    pub(crate) fn new(pencil: &BlockPencil<'_>) -> Self {
        Self::from_columns(pencil, start(pencil.size()), CONVERGED)
    }

    fn from_columns(pencil: &BlockPencil<'_>, start: Mat<f64>, least: f64) -> Self {
        let basis = pencil.rigid_vectors();
        let images = Mat::zeros(pencil.size(), 0);
        let (rigid, next) = (basis.ncols(), orthonormal(&basis, start));
        Self {
            basis,
            images,
            next,
            rigid,
            least,
            thetas: Vec::new(),
            shapes: Mat::zeros(pencil.size(), 0),
            converged: 0,
        }
    }

    /// How many of the lowest flexible modes have converged.
    pub(crate) fn converged(&self) -> usize {
        self.converged
    }

    /// $\omega^2$ of the lowest flexible modes, rising: those that have converged, then others from above.
    pub(crate) fn omega2s(&self, pencil: &BlockPencil<'_>) -> impl Iterator<Item = f64> {
        self.thetas.iter().take_while(|theta| **theta > 0.0).map(|&theta| pencil.omega2(theta))
    }

    /// The lowest flexible modes that have converged, rising.
    pub(crate) fn modes(&self, pencil: &BlockPencil<'_>) -> Vec<Eigenpair> {
        pencil.modes(&self.thetas[..self.converged], self.shapes.subcols(0, self.converged).to_owned())
    }

    /// Grows until the lowest `wanted` flexible modes have converged; whether they have before a dense solution is cheaper.
    pub(crate) fn grow(&mut self, pencil: &BlockPencil<'_>, wanted: usize) -> bool {
        let capacity = pencil.size() - self.rigid;
        let mut look_at = (LIKELY * wanted).max(self.images.ncols() + 1);
        while self.converged < wanted {
            if 2 * self.images.ncols() >= capacity || 2 * wanted > capacity {
                return false;
            }
            let Some(next) = self.next.take() else { return false };
            let image = pencil.apply(&next);
            self.basis = beside(&self.basis, &next);
            self.images = beside(&self.images, &image);
            // The projection costs more than a step: look only where convergence is likely.
            if self.images.ncols() >= look_at {
                let Some(worst) = self.look(wanted) else { return false };
                let steps = ((worst / self.least).ln() / GAIN.ln()).ceil().max(1.0);
                look_at = self.images.ncols() + image.ncols() * steps.min(wanted as f64) as usize;
            }
            self.next = orthonormal(&self.basis, image);
        }
        true
    }

    /// Counts the modes that have converged, `wanted` at most; the largest residual of these.
    fn look(&mut self, wanted: usize) -> Option<f64> {
        let found = self.images.ncols();
        let space = self.basis.subcols(self.rigid, found);
        let projection = product(space.transpose(), self.images.as_ref());
        let (thetas, vectors) = symmetric_eigen(&projection)?;
        let wanted = wanted.min(found);
        self.thetas = thetas.into_iter().rev().collect();
        let vectors = Mat::from_fn(found, wanted, |i, j| vectors[(i, found - 1 - j)]);
        self.shapes = product(space, vectors.as_ref());
        let mut residual = product(self.images.as_ref(), vectors.as_ref());
        residual -= along(self.basis.subcols(0, self.rigid), residual.as_ref());
        residual -= Mat::from_fn(self.shapes.nrows(), wanted, |i, j| self.thetas[j] * self.shapes[(i, j)]);
        let residuals: Vec<f64> =
            residual.col_iter().map(norm).zip(&self.thetas).map(|(norm, theta)| norm / theta).collect();
        self.converged = residuals.iter().take_while(|residual| **residual <= self.least).count();
        Some(residuals.into_iter().fold(0.0, f64::max))
    }
}

/// The lowest `wanted` flexible modes, rising, from shapes that nearly are some more of them; their frequencies are exact
/// to rounding, their shapes to some 1e-6.
pub(crate) fn lowest_modes_near(pencil: &BlockPencil<'_>, wanted: usize, shapes: &[&[f64]]) -> Option<Vec<Eigenpair>> {
    if wanted > shapes.len() {
        return None;
    }
    if wanted == 0 {
        return Some(Vec::new());
    }
    let mut krylov = BlockKrylov::from_columns(pencil, pencil.unit_vectors(shapes), NEARLY_CONVERGED);
    krylov.grow(pencil, wanted).then(|| krylov.modes(pencil))
}

/// Columns without preference for any coordinate, the same in every run.
fn start(size: usize) -> Mat<f64> {
    // Multiples of the golden ratio, modulo one, fall evenly.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    Mat::from_fn(size, WIDTH, |i, j| (golden * (1 + i * WIDTH + j) as f64).fract() - 0.5)
}

/// `block` made orthogonal to `basis`, and its columns to each other; `None` where a column vanishes.
fn orthonormal(basis: &Mat<f64>, mut block: Mat<f64>) -> Option<Mat<f64>> {
    for _ in 0..2 {
        block -= along(basis.as_ref(), block.as_ref());
        for column in 0..block.ncols() {
            let (done, mut rest) = block.as_mut().split_at_col_mut(column);
            orthogonalise(done.as_ref(), rest.rb_mut().subcols_mut(0, 1))?;
        }
    }
    Some(block)
}

fn orthogonalise(done: MatRef<'_, f64>, mut column: MatMut<'_, f64>) -> Option<()> {
    let before = norm(column.rb().col(0));
    let within = along(done, column.rb());
    column -= within;
    let after = norm(column.rb().col(0));
    if after.is_nan() || after <= 1e-12 * before {
        return None;
    }
    column /= faer::Scale(after);
    Some(())
}

/// What of `columns` lies in the space of orthonormal `directions`.
fn along(directions: MatRef<'_, f64>, columns: MatRef<'_, f64>) -> Mat<f64> {
    product(directions, product(directions.transpose(), columns).as_ref())
}

fn beside(left: &Mat<f64>, right: &Mat<f64>) -> Mat<f64> {
    faer::concat![[left, right]]
}
