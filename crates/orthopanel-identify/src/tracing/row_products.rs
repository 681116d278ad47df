//! Products of rows that come some at a time: no more of them is kept than fits beside the processor.

use faer::Mat;
use pulp::{Arch, Simd, WithSimd};

/// Rows that are multiplied at once.
const ROWS: usize = 128;
/// Columns whose products are summed at once, on either side: as many sums as a processor's registers hold.
const SIDE: usize = 3;

/// $A^TA$ of rows that are added block by block.
pub(super) struct RowProducts {
    /// Some rows: [`ROWS`] numbers a column. Columns are made up to a multiple of [`SIDE`].
    rows: Vec<f64>,
    filled: usize,
    columns: usize,
    sums: Vec<[f64; SIDE * SIDE]>,
}

impl RowProducts {
    pub(super) fn new(columns: usize) -> Self {
        let tiles = columns.div_ceil(SIDE);
        let sums = vec![[0.0; SIDE * SIDE]; tiles * (tiles + 1) / 2];
        Self { rows: vec![0.0; tiles * SIDE * ROWS], filled: 0, columns, sums }
    }

    /// Room for `count` more rows, no more than [`ROWS`]: `fill` is told each column's number and its rows.
    pub(super) fn add(&mut self, count: usize, mut fill: impl FnMut(usize, &mut [f64])) {
        if self.filled + count > ROWS {
            self.multiply();
        }
        let own = self.filled..self.filled + count;
        self.rows.chunks_exact_mut(ROWS).take(self.columns).enumerate().for_each(|(column, rows)| {
            fill(column, &mut rows[own.clone()]);
        });
        self.filled += count;
    }

    fn multiply(&mut self) {
        for rows in self.rows.chunks_exact_mut(ROWS) {
            rows[self.filled..].fill(0.0);
        }
        Arch::new().dispatch(Tiles { rows: &self.rows, sums: &mut self.sums });
        self.filled = 0;
    }

    /// The lower triangle of the sum.
    pub(super) fn lower(mut self) -> Mat<f64> {
        self.multiply();
        Mat::from_fn(self.columns, self.columns, |i, j| {
            if i < j {
                return 0.0;
            }
            let (row, column) = (i / SIDE, j / SIDE);
            self.sums[row * (row + 1) / 2 + column][i % SIDE * SIDE + j % SIDE]
        })
    }
}

struct Tiles<'a> {
    rows: &'a [f64],
    sums: &'a mut [[f64; SIDE * SIDE]],
}

impl WithSimd for Tiles<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let columns = |tile: usize| -> [&[S::f64s]; SIDE] {
            [0, 1, 2].map(|i| {
                let start = (tile * SIDE + i) * ROWS;
                S::as_simd_f64s(&self.rows[start..start + ROWS]).0
            })
        };
        let mut sums = self.sums.iter_mut();
        for row in 0..self.rows.len() / (SIDE * ROWS) {
            let [a, b, c] = columns(row);
            for column in 0..=row {
                let [x, y, z] = columns(column);
                let mut tile = [simd.splat_f64s(0.0); SIDE * SIDE];
                let left = a.iter().zip(b).zip(c);
                for (((&a, &b), &c), ((&x, &y), &z)) in left.zip(x.iter().zip(y).zip(z)) {
                    tile[0] = simd.mul_add_f64s(a, x, tile[0]);
                    tile[1] = simd.mul_add_f64s(a, y, tile[1]);
                    tile[2] = simd.mul_add_f64s(a, z, tile[2]);
                    tile[3] = simd.mul_add_f64s(b, x, tile[3]);
                    tile[4] = simd.mul_add_f64s(b, y, tile[4]);
                    tile[5] = simd.mul_add_f64s(b, z, tile[5]);
                    tile[6] = simd.mul_add_f64s(c, x, tile[6]);
                    tile[7] = simd.mul_add_f64s(c, y, tile[7]);
                    tile[8] = simd.mul_add_f64s(c, z, tile[8]);
                }
                let Some(sum) = sums.next() else { return };
                sum.iter_mut().zip(tile).for_each(|(sum, part)| *sum += simd.reduce_sum_f64s(part));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of many sizes, against the plain sum.
    #[test]
    fn val_products_of_blocks_are_those_of_all_rows() {
        let entry = |row: usize, column: usize| (1.3 * row as f64 + 0.7 * (column * column) as f64).sin();
        for columns in [1, 3, 7, 11] {
            let mut products = RowProducts::new(columns);
            let mut rows = 0;
            for count in [64, 64, 6, 64, 100, 128, 1] {
                products.add(count, |column, block| {
                    block.iter_mut().enumerate().for_each(|(row, value)| *value = entry(rows + row, column));
                });
                rows += count;
            }
            let lower = products.lower();
            for i in 0..columns {
                for j in 0..=i {
                    let sum: f64 = (0..rows).map(|row| entry(row, i) * entry(row, j)).sum();
                    assert!((lower[(i, j)] - sum).abs() < 1e-12, "{columns} columns, {i}, {j}");
                }
            }
        }
    }
}
