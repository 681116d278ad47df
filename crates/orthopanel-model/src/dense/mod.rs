//! Products and decompositions of dense matrices: the one place that says who computes them.
//!
//! By faer; with the feature `compact` by plain loops, for the library inside an FMU. faer brings a set of kernels for each
//! kind of processor, which are worth their speed in an identification and fill megabytes in every FMU.

#[cfg(any(test, not(feature = "compact")))]
mod by_faer;
#[cfg(any(test, feature = "compact"))]
mod compact;
#[cfg(any(test, feature = "compact"))]
mod compact_eigen;

#[cfg(not(feature = "compact"))]
pub(crate) use by_faer::{Cholesky, negative_pivots, product, symmetric_eigen, symmetric_eigenvalues};
#[cfg(feature = "compact")]
pub(crate) use compact::{Cholesky, negative_pivots, product};
#[cfg(feature = "compact")]
pub(crate) use compact_eigen::{symmetric_eigen, symmetric_eigenvalues};

/// $a^Tb$, in four sums, which the compiler may keep side by side.
#[inline(always)]
pub(crate) fn dot(left: &[f64], right: &[f64]) -> f64 {
    let (left, left_rest) = left.as_chunks::<4>();
    let (right, right_rest) = right.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in left.iter().zip(right) {
        for i in 0..4 {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = left_rest.iter().zip(right_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// The same of as many entries as both have.
#[inline(always)]
pub(crate) fn dot_of_common(left: &[f64], right: &[f64]) -> f64 {
    let common = left.len().min(right.len());
    dot(&left[..common], &right[..common])
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::{by_faer, compact, compact_eigen};

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
        let matrix = Mat::from_fn(size, size, entry);
        // The backward error of a reduction to tridiagonal form grows like size times rounding: here 4e-14.
        let rounding = size as f64 * f64::EPSILON;
        for (values, _) in
            [by_faer::symmetric_eigen(&matrix), compact_eigen::symmetric_eigen(&matrix)].map(Option::unwrap)
        {
            for (value, expected) in values.iter().zip(&expected) {
                assert!((value - expected).abs() < rounding, "{value:e} {expected:e}");
            }
        }
    }

    fn made(rows: usize, columns: usize) -> Mat<f64> {
        Mat::from_fn(rows, columns, |i, j| (1.7 * i as f64 + 0.9 * (j * j) as f64).sin())
    }

    fn apart(left: &Mat<f64>, right: &Mat<f64>) -> f64 {
        assert_eq!((left.nrows(), left.ncols()), (right.nrows(), right.ncols()));
        left.col_iter()
            .zip(right.col_iter())
            .fold(0.0, |most, (a, b)| a.iter().zip(b.iter()).fold(most, |most: f64, (a, b)| most.max((a - b).abs())))
    }

    /// Products and solutions of both do the same to rounding.
    #[test]
    fn val_both_factor_and_solve_alike() {
        let (wide, columns) = (made(30, 40), made(30, 7));
        let square = by_faer::product(wide.as_ref(), wide.transpose());
        assert!(apart(&square, &compact::product(wide.as_ref(), wide.transpose())) < 1e-13);
        let positive = &square + Mat::<f64>::identity(30, 30);
        let (one, other) = (by_faer::Cholesky::new(&positive).unwrap(), compact::Cholesky::new(&positive).unwrap());
        let (mut there, mut here) = (columns.clone(), columns.clone());
        one.solve_lower(&mut there);
        other.solve_lower(&mut here);
        assert!(apart(&there, &here) < 1e-13);
        one.solve_upper(&mut there);
        other.solve_upper(&mut here);
        assert!(apart(&there, &here) < 1e-13);
        assert!(apart(&by_faer::product(positive.as_ref(), there.as_ref()), &columns) < 1e-12);
        assert!(apart(&one.upper_times(&columns), &other.upper_times(&columns)) < 1e-13);
        let indefinite = &square - 2.0 * Mat::<f64>::identity(30, 30);
        assert!(by_faer::Cholesky::new(&indefinite).is_none() && compact::Cholesky::new(&indefinite).is_none());
    }

    /// The count of negative pivots is that of the negative eigenvalues.
    #[test]
    fn val_negative_pivots_are_negative_eigenvalues() {
        let matrix = made(25, 25);
        let symmetric = &matrix + matrix.transpose();
        for shift in [-6.0, -0.5, 0.1, 2.0, 40.0] {
            let shifted = &symmetric - shift * Mat::<f64>::identity(25, 25);
            let alone = [by_faer::symmetric_eigenvalues(&shifted), compact_eigen::symmetric_eigenvalues(&shifted)]
                .map(Option::unwrap);
            for (values, vectors) in
                [by_faer::symmetric_eigen(&shifted), compact_eigen::symmetric_eigen(&shifted)].map(Option::unwrap)
            {
                for alone in &alone {
                    assert!(values.iter().zip(alone).all(|(value, alone)| (value - alone).abs() < 1e-12));
                }
                let images = by_faer::product(shifted.as_ref(), vectors.as_ref());
                let scaled = Mat::from_fn(25, 25, |i, j| vectors[(i, j)] * values[j]);
                assert!(apart(&images, &scaled) < 1e-12);
                let expected = values.iter().filter(|value| **value < 0.0).count();
                assert_eq!(by_faer::negative_pivots(&shifted), Some(expected));
                assert_eq!(compact::negative_pivots(&shifted), Some(expected));
            }
        }
    }
}
