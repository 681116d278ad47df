//! Symmetric matrices of which each row begins at its first entry that is not zero, and their factors.
//!
//! Rows of $L$ in $LL^T$ and $LDL^T$ begin where those of the matrix do (A. Jennings, Comput. J. 9 (1966) 281), so both need but
//! what is stored: with $b$ entries a row $nb^2/2$ products in place of $n^3/6$.

use std::ops::Index;
use std::sync::Arc;

use faer::Mat;

use crate::dense::{dot, product};
use crate::wide::wide;

/// A symmetric matrix by the rows of its lower triangle, each from its first entry that is not zero.
#[derive(Debug, Clone, PartialEq)]
pub struct SymmetricMatrix {
    profile: Arc<Profile>,
    values: Vec<f64>,
}

/// Where the rows begin.
#[derive(Debug, PartialEq)]
pub(crate) struct Profile {
    /// Column of the first entry of each row.
    first: Vec<usize>,
    /// Where each row stands among the values, and where the last one ends.
    starts: Vec<usize>,
}

impl Profile {
    /// Of rows that begin at these columns, up to the diagonal.
    pub(crate) fn new(first: Vec<usize>) -> Self {
        let mut starts = vec![0];
        let mut end = 0;
        for (row, first) in first.iter().enumerate() {
            end += row + 1 - first;
            starts.push(end);
        }
        Self { first, starts }
    }

    fn row<'a>(&self, values: &'a [f64], row: usize) -> &'a [f64] {
        &values[self.starts[row]..self.starts[row + 1]]
    }
}

impl From<Mat<f64>> for SymmetricMatrix {
    /// By the lower triangle.
    fn from(matrix: Mat<f64>) -> Self {
        let first = |row: usize| (0..row).find(|&column| matrix[(row, column)] != 0.0).unwrap_or(row);
        let first: Vec<usize> = (0..matrix.nrows()).map(first).collect();
        Self::from_fn(&Arc::new(Profile::new(first)), |row, column| matrix[(row, column)])
    }
}

impl Index<(usize, usize)> for SymmetricMatrix {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        let (row, column) = (row.max(column), row.min(column));
        let first = self.profile.first[row];
        if column < first { &0.0 } else { &self.profile.row(&self.values, row)[column - first] }
    }
}

impl SymmetricMatrix {
    /// With these entries where the profile has any.
    pub(crate) fn from_fn(profile: &Arc<Profile>, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut values = Vec::with_capacity(profile.starts.last().copied().unwrap_or(0));
        for (row, &first) in profile.first.iter().enumerate() {
            values.extend((first..=row).map(|column| entry(row, column)));
        }
        Self { profile: Arc::clone(profile), values }
    }

    /// With these rows, each from its first entry up to the diagonal; they come filled with zeros.
    pub(crate) fn from_rows(profile: &Arc<Profile>, mut fill: impl FnMut(usize, usize, &mut [f64])) -> Self {
        let mut values = vec![0.0; profile.starts.last().copied().unwrap_or(0)];
        for (row, &first) in profile.first.iter().enumerate() {
            fill(row, first, &mut values[profile.starts[row]..profile.starts[row + 1]]);
        }
        Self { profile: Arc::clone(profile), values }
    }

    /// Where a row begins, and its entries from there up to the diagonal.
    pub(crate) fn row(&self, row: usize) -> (usize, &[f64]) {
        (self.profile.first[row], self.profile.row(&self.values, row))
    }

    /// How many entries are kept.
    pub(crate) fn stored(&self) -> usize {
        self.values.len()
    }

    /// Number of rows.
    pub fn nrows(&self) -> usize {
        self.profile.first.len()
    }

    /// Number of columns.
    pub fn ncols(&self) -> usize {
        self.nrows()
    }

    /// $\sum_ic_iA_i$ of matrices of one size.
    pub(crate) fn sum<'a>(terms: impl Iterator<Item = (f64, &'a Self)> + Clone, size: usize) -> Self {
        let mut first: Vec<usize> = (0..size).collect();
        let mut shared: Option<&Arc<Profile>> = None;
        let alike = terms.clone().all(|(_, matrix)| {
            let profile = shared.get_or_insert(&matrix.profile);
            Arc::ptr_eq(profile, &matrix.profile) || **profile == matrix.profile
        });
        let profile = match shared {
            Some(profile) if alike => Arc::clone(profile),
            _ => {
                for (_, matrix) in terms.clone() {
                    first.iter_mut().zip(&matrix.profile.first).for_each(|(own, &other)| *own = (*own).min(other));
                }
                Arc::new(Profile::new(first))
            }
        };
        let mut sum = Self { values: vec![0.0; profile.starts.last().copied().unwrap_or(0)], profile };
        terms.for_each(|(coefficient, matrix)| sum.add(coefficient, matrix));
        sum
    }

    /// Adds $cA$; no row of $A$ may begin before this one's.
    pub(crate) fn add(&mut self, coefficient: f64, matrix: &Self) {
        if Arc::ptr_eq(&self.profile, &matrix.profile) {
            return add(&mut self.values, coefficient, &matrix.values);
        }
        for row in 0..self.nrows() {
            let own = matrix.profile.row(&matrix.values, row);
            add(&mut self.values[self.profile.starts[row + 1] - own.len()..], coefficient, own);
        }
    }

    /// Adds a value to a diagonal entry.
    pub(crate) fn add_to_diagonal(&mut self, row: usize, value: f64) {
        self.values[self.profile.starts[row + 1] - 1] += value;
    }

    /// $SAS$ with a diagonal $S$.
    pub(crate) fn scaled(mut self, scale: &[f64]) -> Self {
        for (row, (&first, own)) in self.profile.first.iter().zip(scale).enumerate() {
            let values = &mut self.values[self.profile.starts[row]..self.profile.starts[row + 1]];
            values.iter_mut().zip(&scale[first..]).for_each(|(value, other)| *value *= own * other);
        }
        self
    }

    /// The rows and columns of these numbers, which rise.
    pub(crate) fn part(&self, kept: &[usize]) -> Self {
        let first = |&row: &usize| kept.partition_point(|&column| column < self.profile.first[row]);
        let profile = Arc::new(Profile::new(kept.iter().map(first).collect()));
        Self::from_fn(&profile, |row, column| self[(kept[row], kept[column])])
    }

    /// $Av$.
    pub(crate) fn image(&self, vector: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; self.nrows()];
        for (row, &first) in self.profile.first.iter().enumerate() {
            let [before @ .., diagonal] = self.profile.row(&self.values, row) else { continue };
            let own = vector[row];
            image[row] += diagonal * own + dot(before, &vector[first..row]);
            add(&mut image[first..row], own, before);
        }
        image
    }

    /// $AV$.
    pub(crate) fn times(&self, columns: &Mat<f64>) -> Mat<f64> {
        if !self.is_thin() && columns.ncols() > 1 {
            return product(self.to_dense().as_ref(), columns.as_ref());
        }
        // Rows of all columns lie together in the transposed ones: each entry then works on them all at once, and zeros on none.
        let rows = columns.transpose().to_owned();
        let mut images = Mat::zeros(columns.ncols(), columns.nrows());
        let (own, from, to) = (self, &rows, &mut images);
        wide!(|own: &'a SymmetricMatrix, from: &'a Mat<f64>, to: &'a mut Mat<f64>| -> () { own.add_images(from, to) });
        images.transpose().to_owned()
    }

    /// Adds $(AV)^T$ by $V^T$.
    #[inline(always)]
    fn add_images(&self, rows: &Mat<f64>, images: &mut Mat<f64>) {
        for (row, &first) in self.profile.first.iter().enumerate() {
            for (at, &value) in self.profile.row(&self.values, row).iter().enumerate() {
                let column = first + at;
                if value != 0.0 {
                    add(images.col_as_slice_mut(row), value, rows.col_as_slice(column));
                    if column < row {
                        add(images.col_as_slice_mut(column), value, rows.col_as_slice(row));
                    }
                }
            }
        }
    }

    /// $v^TAv$.
    pub(crate) fn quadratic_form(&self, vector: &[f64]) -> f64 {
        let row = |(row, &first): (usize, &usize)| {
            let [before @ .., diagonal] = self.profile.row(&self.values, row) else { return 0.0 };
            vector[row] * (diagonal * vector[row] + 2.0 * dot(before, &vector[first..row]))
        };
        self.profile.first.iter().enumerate().map(row).sum()
    }

    /// Whether so many entries are zero that factors by rows are quicker than by blocks. Small code has no blocks.
    pub(crate) fn is_thin(&self) -> bool {
        let size = self.nrows();
        cfg!(feature = "compact") || size <= 32 || 4 * self.values.len() < size * size
    }

    /// All entries.
    pub(crate) fn to_dense(&self) -> Mat<f64> {
        let mut all = Mat::zeros(self.nrows(), self.nrows());
        for row in 0..self.nrows() {
            let (first, own) = self.row(row);
            all.col_as_slice_mut(row)[first..=row].copy_from_slice(own);
            own.iter().enumerate().for_each(|(i, value)| all[(row, first + i)] = *value);
        }
        all
    }

    /// Number of negative eigenvalues: the negative pivots of $LDL^T$ (Sylvester's law of inertia). `None` where a pivot vanishes.
    pub(crate) fn negative_pivots(mut self) -> Option<usize> {
        let own = &mut self;
        wide!(|own: &'a mut SymmetricMatrix| -> Option<usize> { own.count_negative_pivots() })
    }

    #[inline(always)]
    fn count_negative_pivots(&mut self) -> Option<usize> {
        let mut pivots = Vec::with_capacity(self.nrows());
        for row in 0..self.nrows() {
            self.reduce_row(row);
            let first = self.profile.first[row];
            let values = &mut self.values[self.profile.starts[row]..self.profile.starts[row + 1]];
            let [before @ .., diagonal] = values else { return None };
            for (value, pivot) in before.iter_mut().zip(&pivots[first..]) {
                let reduced = *value;
                *value /= pivot;
                *diagonal -= reduced * *value;
            }
            if *diagonal == 0.0 || !diagonal.is_finite() {
                return None;
            }
            pivots.push(*diagonal);
        }
        Some(pivots.iter().filter(|pivot| **pivot < 0.0).count())
    }

    /// Takes the rows above off this one but for its diagonal, by the factor $L$ that they hold.
    #[inline(always)]
    fn reduce_row(&mut self, row: usize) {
        let Profile { first, starts } = self.profile.as_ref();
        let (above, rest) = self.values.split_at_mut(starts[row]);
        let begin = first[row];
        for column in begin + 1..row {
            let other = &above[starts[column]..starts[column + 1] - 1];
            let common = begin.max(first[column]);
            let taken = dot(&rest[common - begin..column - begin], &other[common - first[column]..]);
            rest[column - begin] -= taken;
        }
    }
}

/// $LL^T$ of a positive definite [`SymmetricMatrix`].
#[derive(Debug)]
pub(crate) struct SkylineCholesky {
    /// $L$, its diagonal inverted.
    lower: SymmetricMatrix,
}

impl SkylineCholesky {
    /// `None` where the matrix is not positive definite.
    pub(crate) fn new(matrix: &SymmetricMatrix) -> Option<Self> {
        let mut lower = matrix.clone();
        let own = &mut lower;
        wide!(|own: &'a mut SymmetricMatrix| -> Option<()> { SkylineCholesky::factor(own) })?;
        Some(Self { lower })
    }

    #[inline(always)]
    fn factor(lower: &mut SymmetricMatrix) -> Option<()> {
        for row in 0..lower.nrows() {
            let Profile { first, starts } = lower.profile.as_ref();
            let (above, rest) = lower.values.split_at_mut(starts[row]);
            let begin = first[row];
            for column in begin..row {
                let other = &above[starts[column]..starts[column + 1]];
                let [before @ .., inverse] = other else { return None };
                let common = begin.max(first[column]);
                let taken = dot(&rest[common - begin..column - begin], &before[common - first[column]..]);
                rest[column - begin] = (rest[column - begin] - taken) * inverse;
            }
            let [own @ .., diagonal] = &mut rest[..row + 1 - begin] else { return None };
            let pivot = *diagonal - dot(own, own);
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            *diagonal = pivot.sqrt().recip();
        }
        Some(())
    }

    #[inline(always)]
    fn rows(&self) -> impl DoubleEndedIterator<Item = (usize, usize, &[f64], f64)> {
        let profile = &self.lower.profile;
        profile.first.iter().enumerate().filter_map(|(row, &first)| {
            let [before @ .., inverse] = profile.row(&self.lower.values, row) else { return None };
            Some((row, first, before, *inverse))
        })
    }

    /// $L^{-1}b$ in the place of $b$.
    pub(crate) fn solve_lower(&self, vector: &mut [f64]) {
        let own = self;
        wide!(|own: &'a SkylineCholesky, vector: &'a mut [f64]| -> () {
            for (row, first, before, inverse) in own.rows() {
                vector[row] = (vector[row] - dot(before, &vector[first..row])) * inverse;
            }
        });
    }

    /// $L^{-T}b$ in the place of $b$.
    pub(crate) fn solve_upper(&self, vector: &mut [f64]) {
        let own = self;
        wide!(|own: &'a SkylineCholesky, vector: &'a mut [f64]| -> () {
            for (row, first, before, inverse) in own.rows().rev() {
                vector[row] *= inverse;
                let share = vector[row];
                add(&mut vector[first..row], -share, before);
            }
        });
    }

    /// $L^Tb$ in the place of $b$.
    pub(crate) fn upper_times(&self, vector: &mut [f64]) {
        for (row, first, before, inverse) in self.rows() {
            let own = vector[row];
            vector[row] = own / inverse;
            add(&mut vector[first..row], own, before);
        }
    }
}

/// $a \mathrel{+}= cb$.
#[inline(always)]
pub(crate) fn add(sum: &mut [f64], coefficient: f64, values: &[f64]) {
    sum.iter_mut().zip(values).for_each(|(total, value)| *total += coefficient * value);
}

#[cfg(test)]
mod tests;
