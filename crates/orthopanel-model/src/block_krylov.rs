//! The lowest modes of a block without solving for all of them: block Lanczos on the inverted problem.
//!
//! Reference: G. H. Golub and R. Underwood, The block Lanczos method for computing eigenvalues, in Mathematical Software
//! III (1977) 361. All vectors are kept and orthogonalised twice, so no eigenvalue returns as a ghost.

use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Mat, MatMut, MatRef};

use crate::block_pencil::{BlockPencil, Eigenpair};
use crate::dense::{norm, product, symmetric_eigen};

/// Vectors a step; modes that coincide in this number are found together. Products of fewer columns waste the machine.
const WIDTH: usize = 4;
/// Residual, over its eigenvalue, at which a vector has converged: its frequency is then exact to rounding.
const CONVERGED: f64 = 1e-9;
/// Vectors for each mode wanted from which on convergence is likely, where nothing is known.
const LIKELY: usize = 5;
/// Residual at which a vector that began near its mode has converged: an eigenvalue errs by its square.
const NEARLY_CONVERGED: f64 = 1e-6;

/// The lowest `wanted` flexible modes, rising; `None` where a dense solution is the cheaper or the surer way.
pub(crate) fn lowest_modes(pencil: &BlockPencil<'_>, wanted: usize) -> Option<Vec<Eigenpair>> {
    let capacity = pencil.size() - pencil.rigid_count();
    if (LIKELY + 1) * wanted > capacity || wanted == 0 {
        return None;
    }
    modes_from(pencil, wanted, start(pencil.size()), LIKELY * wanted, CONVERGED)
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
    modes_from(pencil, wanted, pencil.unit_vectors(shapes), 2 * shapes.len(), NEARLY_CONVERGED)
}

/// From the columns of `start`; looks for convergence once there are `likely` vectors.
fn modes_from(
    pencil: &BlockPencil<'_>,
    wanted: usize,
    start: Mat<f64>,
    likely: usize,
    residual: f64,
) -> Option<Vec<Eigenpair>> {
    let size = pencil.size();
    let rigid = pencil.rigid_vectors();
    let capacity = size - rigid.ncols();
    // Orthonormal columns: the rigid modes, then the Krylov space; images are those of the latter.
    let mut basis = rigid.clone();
    let mut images = Mat::<f64>::zeros(size, 0);
    let mut next = orthonormal(&basis, start)?;
    while 2 * images.ncols() < capacity {
        let image = pencil.apply(&next);
        basis = beside(&basis, &next);
        images = beside(&images, &image);
        let found = images.ncols();
        // The projection costs more than a step: look only where convergence is likely.
        if found >= likely
            && let Some(modes) = converged(pencil, &basis, rigid.ncols(), &images, wanted, residual)
        {
            return Some(modes);
        }
        next = orthonormal(&basis, image)?;
    }
    None
}

/// The modes of the projection on the Krylov space, where all that are wanted have small residuals.
fn converged(
    pencil: &BlockPencil<'_>,
    basis: &Mat<f64>,
    rigid: usize,
    images: &Mat<f64>,
    wanted: usize,
    least: f64,
) -> Option<Vec<Eigenpair>> {
    let found = images.ncols();
    let space = basis.subcols(rigid, found);
    let projection = product(space.transpose(), images.as_ref());
    let (thetas, vectors) = symmetric_eigen(&projection)?;
    let highest = |column: usize| found - 1 - column;
    let thetas: Vec<f64> = (0..wanted).map(|column| thetas[highest(column)]).collect();
    let vectors = Mat::from_fn(found, wanted, |i, j| vectors[(i, highest(j))]);
    let shapes = product(space, vectors.as_ref());
    let mut residual = product(images.as_ref(), vectors.as_ref());
    let along_rigid = basis.subcols(0, rigid);
    residual -= along(along_rigid, residual.as_ref());
    residual -= Mat::from_fn(shapes.nrows(), wanted, |i, j| thetas[j] * shapes[(i, j)]);
    let mut norms = residual.col_iter().map(norm).zip(&thetas);
    norms.all(|(norm, theta)| norm <= least * theta).then(|| pencil.modes(&thetas, shapes))
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
