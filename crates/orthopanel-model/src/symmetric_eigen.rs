//! Eigenvalues and vectors of a dense symmetric matrix.

use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Auto, Col, Mat, Par, Spec};

/// Rising eigenvalues and their vectors as columns; `None` where the search does not converge.
///
/// faer's divide-and-conquer, its default from some 128 rows on, leaves errors near 1e-9 of the largest eigenvalue in
/// all the others (0.24), which would cost the higher modes all their digits. Its QR iteration leaves rounding alone,
/// so we ask for that at every size.
pub(crate) fn symmetric_eigen(matrix: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let size = matrix.nrows();
    let parameters = SelfAdjointEvdParams { recursion_threshold: usize::MAX, ..Auto::<f64>::auto() };
    let spec: Spec<SelfAdjointEvdParams, f64> = parameters.into();
    let scratch = self_adjoint_evd_scratch::<f64>(size, ComputeEigenvectors::Yes, Par::Seq, spec);
    let mut buffer = MemBuffer::try_new(scratch).ok()?;
    let mut values = Col::<f64>::zeros(size);
    let mut vectors = Mat::<f64>::zeros(size, size);
    self_adjoint_evd(
        matrix.as_ref(),
        DiagMut::from(values.as_mut().as_diagonal_mut()),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut buffer),
        spec,
    )
    .ok()?;
    Some((values.iter().copied().collect(), vectors))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A graded spectrum, 1 down to 1e-9, in a basis of Householder reflections: each eigenvalue to rounding.
    #[test]
    fn val_small_eigenvalues_of_a_large_matrix_keep_their_digits() {
        let size = 200;
        let expected: Vec<f64> =
            (0..size).map(|i| 10.0_f64.powf(-9.0 * (1.0 - i as f64 / (size - 1) as f64))).collect();
        let normal: Vec<f64> = (0..size).map(|i| (1.0 + i as f64).sin()).collect();
        let length2: f64 = normal.iter().map(|v| v * v).sum();
        let reflect = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * normal[i] * normal[j] / length2;
        let entry = |i: usize, j: usize| (0..size).map(|k| reflect(i, k) * expected[k] * reflect(j, k)).sum::<f64>();
        let (values, _) = symmetric_eigen(&Mat::from_fn(size, size, entry)).unwrap();
        // The backward error of a reduction to tridiagonal form grows like size times rounding: here 4e-14.
        let rounding = size as f64 * f64::EPSILON;
        for (value, expected) in values.iter().zip(&expected) {
            assert!((value - expected).abs() < rounding, "{value:e} {expected:e}");
        }
    }
}
