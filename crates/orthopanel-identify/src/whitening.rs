//! Residuals in units of their covariance.

use std::ops::Range;

use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Par, Side};

/// Part of the largest eigenvalue below which a common direction is rounding.
const ROUNDING: f64 = 1e-13;

/// $C^{-1} = W^TW$, and $\ln\det C$, of a covariance
/// $$C = D + UU^T$$
/// with $D$ block by block and $U$ of few columns. With $D = LL^T$, $V = L^{-1}U = Q\Lambda^{1/2}R^T$,
/// $$W = \left(I - Q\left(1-(1+\Lambda)^{-1/2}\right)Q^T\right)L^{-1}$$
/// (Woodbury, Princeton Memorandum 42, 1950).
pub(crate) struct Whitening {
    blocks: Vec<(Range<usize>, Llt<f64>)>,
    /// $Q$, and $1-(1+\Lambda)^{-1/2}$ of each of its columns.
    common: Option<(Mat<f64>, Vec<f64>)>,
    pub log_determinant: f64,
}

/// Which values noise and error of their own alone tie together, and what all share.
pub(crate) struct Split {
    /// Next to each other, all values.
    pub ranges: Vec<Range<usize>>,
    /// Columns whose products are the noise between the ranges.
    pub common: Mat<f64>,
}

impl Split {
    /// The range that holds all of these places; `None` where more than one does.
    pub(crate) fn range_of(&self, mut places: impl Iterator<Item = usize>) -> Option<usize> {
        let range = |place: usize| self.ranges.partition_point(|range| range.end <= place);
        let first = range(places.next()?);
        places.all(|place| range(place) == first).then_some(first)
    }
}

impl Whitening {
    /// Of a covariance that is not split.
    pub(crate) fn new(covariance: &Mat<f64>) -> Option<Self> {
        Self::split(vec![(0..covariance.nrows(), covariance.clone())], None)
    }

    /// Of the blocks of $D$, next to each other, and $U$; `None` where it is not positive definite.
    pub(crate) fn split(blocks: Vec<(Range<usize>, Mat<f64>)>, common: Option<Mat<f64>>) -> Option<Self> {
        let factor = |(range, block): (Range<usize>, Mat<f64>)| Some((range, block.llt(Side::Lower).ok()?));
        let blocks = blocks.into_iter().map(factor).collect::<Option<Vec<_>>>()?;
        let of_factor = |(range, factor): &(Range<usize>, Llt<f64>)| -> f64 {
            (0..range.len()).map(|i| 2.0 * factor.L()[(i, i)].ln()).sum()
        };
        let log_determinant = blocks.iter().map(of_factor).sum();
        let mut own = Self { blocks, common: None, log_determinant };
        if let Some(mut columns) = common.filter(|columns| columns.ncols() > 0) {
            own.whiten(&mut columns);
            let products = columns.transpose() * &columns;
            let eigen = products.self_adjoint_eigen(Side::Lower).ok()?;
            let (sizes, turns) = (eigen.S().column_vector(), eigen.U());
            let least = ROUNDING * sizes.iter().fold(0.0, |most: f64, size| most.max(*size));
            let kept: Vec<usize> = (0..sizes.nrows()).filter(|&k| sizes[k] > least).collect();
            let scaled = Mat::from_fn(turns.nrows(), kept.len(), |i, k| turns[(i, kept[k])] / sizes[kept[k]].sqrt());
            own.log_determinant += kept.iter().map(|&k| sizes[k].ln_1p()).sum::<f64>();
            let shrunk = kept.iter().map(|&k| 1.0 - (1.0 + sizes[k]).sqrt().recip()).collect();
            own.common = Some((columns * scaled, shrunk));
        }
        own.log_determinant.is_finite().then_some(own)
    }

    /// $W$ times these columns.
    pub(crate) fn whiten(&self, columns: &mut Mat<f64>) {
        let width = columns.ncols();
        for (range, factor) in &self.blocks {
            let rows = columns.as_mut().submatrix_mut(range.start, 0, range.len(), width);
            solve_lower_triangular_in_place(factor.L(), rows, Par::Seq);
        }
        if let Some((directions, shrunk)) = &self.common {
            let mut shares = directions.transpose() * &*columns;
            for column in 0..width {
                shares.col_as_slice_mut(column).iter_mut().zip(shrunk).for_each(|(share, by)| *share *= by);
            }
            *columns -= directions * shares;
        }
    }

    pub(crate) fn whitened(&self, values: &[f64]) -> Vec<f64> {
        let mut column = Mat::from_fn(values.len(), 1, |i, _| values[i]);
        self.whiten(&mut column);
        column.col_as_slice(0).to_vec()
    }

    /// Of columns that are zero outside one block: $F^TC^{-1}F$ and $F^TC^{-1}r$, where $W r$ is given as `whitened`.
    pub(crate) fn products_in(&self, block: usize, mut columns: Mat<f64>, whitened: &[f64]) -> (Mat<f64>, Vec<f64>) {
        let (range, factor) = &self.blocks[block];
        solve_lower_triangular_in_place(factor.L(), columns.as_mut(), Par::Seq);
        let mut products = columns.transpose() * &columns;
        let along = |columns: MatRef<'_, f64>, values: &[f64]| -> Vec<f64> {
            let of_column = |j: usize| (0..values.len()).map(|i| columns[(i, j)] * values[i]).sum();
            (0..columns.ncols()).map(of_column).collect()
        };
        let mut crossed = along(columns.as_ref(), &whitened[range.clone()]);
        if let Some((directions, shrunk)) = &self.common {
            let shares = directions.subrows(range.start, range.len()).transpose() * &columns;
            // $W^TW = L^{-T}(I - Q(2c-c^2)Q^T)L^{-1}$, and $W r$ has lost $c$ of its shares already.
            let twice =
                Mat::from_fn(shares.nrows(), shares.ncols(), |k, j| shrunk[k] * (2.0 - shrunk[k]) * shares[(k, j)]);
            products -= shares.transpose() * twice;
            let of_whole: Vec<f64> = (0..shrunk.len())
                .map(|k| shrunk[k] * directions.col_as_slice(k).iter().zip(whitened).map(|(q, r)| q * r).sum::<f64>())
                .collect();
            crossed.iter_mut().zip(along(shares.as_ref(), &of_whole)).for_each(|(sum, taken)| *sum -= taken);
        }
        (products, crossed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers without a pattern.
    fn number(i: usize, j: usize) -> f64 {
        (12.9898 * (i as f64 + 1.0) + 78.233 * (j as f64 + 1.0)).sin()
    }

    fn positive(size: usize, from: usize) -> Mat<f64> {
        let spread = Mat::from_fn(size, size, |i, j| number(i + from, j));
        &spread * spread.transpose() + Mat::<f64>::identity(size, size)
    }

    /// A covariance in blocks with common columns is that covariance written out.
    #[test]
    fn val_a_split_covariance_is_the_whole_one() {
        let blocks = vec![(0..3, positive(3, 0)), (3..8, positive(5, 9)), (8..9, positive(1, 20))];
        let common = Mat::from_fn(9, 2, |i, j| 2.0 * number(i, j + 40));
        let mut whole = &common * common.transpose();
        for (range, block) in &blocks {
            for (i, j) in range.clone().flat_map(|i| range.clone().map(move |j| (i, j))) {
                whole[(i, j)] += block[(i - range.start, j - range.start)];
            }
        }
        let (split, whole) = (Whitening::split(blocks, Some(common)).unwrap(), Whitening::new(&whole).unwrap());
        assert!((split.log_determinant - whole.log_determinant).abs() < 1e-10);
        let columns = Mat::from_fn(9, 4, |i, j| number(i + 3, j + 7));
        let [mut one, mut other] = [columns.clone(), columns.clone()];
        split.whiten(&mut one);
        whole.whiten(&mut other);
        let apart = one.transpose() * &one - other.transpose() * &other;
        assert!(apart.norm_max() < 1e-10, "{apart:?}");
        // Of columns within one block.
        let values: Vec<f64> = (0..9).map(|i| number(i, 3)).collect();
        let part = columns.subrows(3, 5).to_owned();
        let mut within = Mat::<f64>::zeros(9, 4);
        within.submatrix_mut(3, 0, 5, 4).copy_from(&part);
        let (products, crossed) = split.products_in(1, part, &split.whitened(&values));
        whole.whiten(&mut within);
        let (wanted, told) = (within.transpose() * &within, whole.whitened(&values));
        assert!((products - wanted).norm_max() < 1e-10);
        for (j, crossed) in crossed.iter().enumerate() {
            let wanted: f64 = (0..9).map(|i| within[(i, j)] * told[i]).sum();
            assert!((crossed - wanted).abs() < 1e-10);
        }
    }
}
