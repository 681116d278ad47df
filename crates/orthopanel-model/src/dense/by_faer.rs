//! Dense matrices by faer.

use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Auto, Col, Mat, MatMut, MatRef, Par, Side, Spec};

/// $AB$.
pub(crate) fn product(left: MatRef<'_, f64>, right: MatRef<'_, f64>) -> Mat<f64> {
    left * right
}

/// $LL^T$ of a symmetric positive definite matrix.
#[derive(Debug)]
pub(crate) struct Cholesky(Llt<f64>);

impl Cholesky {
    /// `None` where the matrix is not positive definite.
    pub(crate) fn new(matrix: &Mat<f64>) -> Option<Self> {
        matrix.llt(Side::Lower).ok().map(Self)
    }

    /// $L^{-1}B$ in the place of $B$.
    pub(crate) fn solve_lower(&self, columns: &mut Mat<f64>) {
        solve_lower_triangular_in_place(self.0.L(), columns.as_mut(), Par::Seq);
    }

    /// $L^{-T}B$ in the place of $B$.
    pub(crate) fn solve_upper(&self, columns: &mut Mat<f64>) {
        solve_upper_triangular_in_place(self.0.L().transpose(), columns.as_mut(), Par::Seq);
    }

    /// $L^TB$.
    pub(crate) fn upper_times(&self, columns: &Mat<f64>) -> Mat<f64> {
        self.0.L().transpose() * columns
    }
}

/// Number of negative eigenvalues of a symmetric matrix: the negative pivots of $LDL^T$ (Sylvester's law of inertia).
/// `None` where a pivot vanishes.
pub(crate) fn negative_pivots(matrix: &Mat<f64>) -> Option<usize> {
    let factor = matrix.ldlt(Side::Lower).ok()?;
    let pivots = factor.D().column_vector();
    pivots.iter().all(|pivot| pivot.is_finite()).then(|| pivots.iter().filter(|pivot| **pivot < 0.0).count())
}

/// Rising eigenvalues and their vectors as columns; `None` where the search does not converge.
///
/// faer's divide-and-conquer, its default from some 128 rows on, leaves errors near 1e-9 of the largest eigenvalue in
/// all the others (0.24), which would cost the higher modes all their digits. Its QR iteration leaves rounding alone,
/// so we ask for that at every size.
pub(crate) fn symmetric_eigen(matrix: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let mut vectors = Mat::<f64>::zeros(matrix.nrows(), matrix.nrows());
    let values = eigenvalues(matrix, Some(vectors.as_mut()))?;
    Some((values, vectors))
}

/// The rising eigenvalues alone, in a fifth of the time: to turn the vectors is most of the work.
pub(crate) fn symmetric_eigenvalues(matrix: &Mat<f64>) -> Option<Vec<f64>> {
    eigenvalues(matrix, None)
}

fn eigenvalues(matrix: &Mat<f64>, vectors: Option<MatMut<'_, f64>>) -> Option<Vec<f64>> {
    let size = matrix.nrows();
    let asked = if vectors.is_some() { ComputeEigenvectors::Yes } else { ComputeEigenvectors::No };
    let parameters = SelfAdjointEvdParams { recursion_threshold: usize::MAX, ..Auto::<f64>::auto() };
    let spec: Spec<SelfAdjointEvdParams, f64> = parameters.into();
    let scratch = self_adjoint_evd_scratch::<f64>(size, asked, Par::Seq, spec);
    let mut buffer = MemBuffer::try_new(scratch).ok()?;
    let mut values = Col::<f64>::zeros(size);
    let diagonal = DiagMut::from(values.as_mut().as_diagonal_mut());
    self_adjoint_evd(matrix.as_ref(), diagonal, vectors, Par::Seq, MemStack::new(&mut buffer), spec).ok()?;
    Some(values.iter().copied().collect())
}
