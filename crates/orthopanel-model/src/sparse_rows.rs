//! A symmetric matrix of which few entries are not zero, by these alone.

use crate::SymmetricMatrix;

/// The entries of the lower triangle that are not zero, row by row.
///
/// A mass matrix has the rows of the stiffness, lest their sum had others; but masses couple each field with itself alone.
pub(crate) struct SparseRows {
    starts: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

/// Times as many entries must be stored as are not zero: each costs more here.
const WORTH: usize = 3;

impl SparseRows {
    /// `None` where too many entries are not zero to gain by it.
    pub(crate) fn of(matrix: &SymmetricMatrix) -> Option<Self> {
        let most = matrix.stored() / WORTH;
        let (mut starts, mut entries) = (vec![0], Vec::with_capacity(most));
        for row in 0..matrix.nrows() {
            let (first, values) = matrix.row(row);
            entries.extend(values.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(at, v)| (first + at, *v)));
            if entries.len() > most {
                return None;
            }
            starts.push(entries.len());
        }
        Some(Self { starts, entries })
    }

    /// $Av$.
    pub(crate) fn image(&self, vector: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; vector.len()];
        for (row, (pair, own)) in self.starts.windows(2).zip(vector).enumerate() {
            let mut sum = 0.0;
            for &(column, value) in &self.entries[pair[0]..pair[1]] {
                sum += value * vector[column];
                if column < row {
                    image[column] += value * own;
                }
            }
            image[row] += sum;
        }
        image
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::SparseRows;
    use crate::SymmetricMatrix;

    #[test]
    fn val_what_is_not_zero_is_the_matrix() {
        // Every fourth diagonal, within full rows of the lower triangle.
        let entry = |i: usize, j: usize| if (i + j).is_multiple_of(4) { 1.0 + (i * j) as f64 } else { 0.0 };
        let matrix = SymmetricMatrix::from(Mat::from_fn(20, 20, entry));
        let vector: Vec<f64> = (0..20).map(|i| (0.3 * i as f64).sin()).collect();
        let image = SparseRows::of(&matrix).unwrap().image(&vector);
        assert!(image.iter().zip(matrix.image(&vector)).all(|(a, b)| (a - b).abs() < 1e-12 * (1.0 + b.abs())));
    }

    #[test]
    fn full_rows_are_left_as_they_are() {
        let full = SymmetricMatrix::from(Mat::from_fn(9, 9, |i, j| (1 + i + j) as f64));
        assert!(SparseRows::of(&full).is_none());
    }
}
