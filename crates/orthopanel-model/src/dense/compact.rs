//! Dense matrices in small code: plain loops down the columns.

use faer::{Mat, MatRef};

use super::dot;

/// $AB$.
pub(crate) fn product(left: MatRef<'_, f64>, right: MatRef<'_, f64>) -> Mat<f64> {
    let Some(columns) = right.try_as_col_major() else { return product(left, copied(right).as_ref()) };
    let mut product = Mat::zeros(left.nrows(), right.ncols());
    for (j, factors) in columns.col_iter().enumerate() {
        let (sums, factors) = (product.col_as_slice_mut(j), factors.as_slice());
        // Of A^T, as it mostly comes, the rows lie as columns in memory.
        if let Some(rows) = left.transpose().try_as_col_major() {
            sums.iter_mut().zip(rows.col_iter()).for_each(|(sum, row)| *sum = dot(row.as_slice(), factors));
        } else if let Some(columns) = left.try_as_col_major() {
            columns.col_iter().zip(factors).for_each(|(column, &factor)| add(sums, factor, column.as_slice()));
        } else {
            return self::product(copied(left).as_ref(), right);
        }
    }
    product
}

/// $LL^T$ of a symmetric positive definite matrix.
#[derive(Debug)]
pub(crate) struct Cholesky(Mat<f64>);

impl Cholesky {
    /// `None` where the matrix is not positive definite.
    pub(crate) fn new(matrix: &Mat<f64>) -> Option<Self> {
        let mut lower = matrix.clone();
        let (size, pivots) = (lower.nrows(), eliminate(&mut lower)?);
        for (j, pivot) in pivots.into_iter().enumerate() {
            if pivot <= 0.0 {
                return None;
            }
            let root = pivot.sqrt();
            let column = lower.col_as_slice_mut(j);
            (0..j).for_each(|i| column[i] = 0.0);
            (j..size).for_each(|i| column[i] *= root);
        }
        Some(Self(lower))
    }

    /// $L^{-1}B$ in the place of $B$.
    pub(crate) fn solve_lower(&self, columns: &mut Mat<f64>) {
        for j in 0..columns.ncols() {
            let solved = columns.col_as_slice_mut(j);
            for k in 0..solved.len() {
                let (done, rest) = solved.split_at_mut(k + 1);
                let factors = &self.0.col_as_slice(k)[k..];
                done[k] /= factors[0];
                add(rest, -done[k], &factors[1..]);
            }
        }
    }

    /// $L^{-T}B$ in the place of $B$.
    pub(crate) fn solve_upper(&self, columns: &mut Mat<f64>) {
        for j in 0..columns.ncols() {
            let solved = columns.col_as_slice_mut(j);
            for k in (0..solved.len()).rev() {
                let factors = &self.0.col_as_slice(k)[k..];
                solved[k] = (solved[k] - dot(&factors[1..], &solved[k + 1..])) / factors[0];
            }
        }
    }

    /// $L^TB$.
    pub(crate) fn upper_times(&self, columns: &Mat<f64>) -> Mat<f64> {
        product(self.0.transpose(), columns.as_ref())
    }
}

/// Number of negative eigenvalues of a symmetric matrix: the negative pivots of $LDL^T$ (Sylvester's law of inertia).
/// `None` where a pivot vanishes.
pub(crate) fn negative_pivots(matrix: &Mat<f64>) -> Option<usize> {
    let pivots = eliminate(&mut matrix.clone())?;
    Some(pivots.iter().filter(|pivot| **pivot < 0.0).count())
}

/// $LDL^T$ of a symmetric matrix: returns $D$, and leaves $L$, whose diagonal is one, in the lower triangle. `None` where
/// a pivot vanishes or is no number.
fn eliminate(matrix: &mut Mat<f64>) -> Option<Vec<f64>> {
    let size = matrix.nrows();
    let mut pivots = Vec::with_capacity(size);
    for k in 0..size {
        let column = &mut matrix.col_as_slice_mut(k)[k..];
        let pivot = column[0];
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        pivots.push(pivot);
        let before = column[1..].to_vec();
        column.iter_mut().for_each(|value| *value /= pivot);
        let factors = column[1..].to_vec();
        for (below, &value) in before.iter().enumerate() {
            add(&mut matrix.col_as_slice_mut(k + 1 + below)[k + 1 + below..], -value, &factors[below..]);
        }
    }
    Some(pivots)
}

/// The same matrix, its columns one after the other in memory.
fn copied(matrix: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)])
}

fn add(sum: &mut [f64], factor: f64, values: &[f64]) {
    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}
