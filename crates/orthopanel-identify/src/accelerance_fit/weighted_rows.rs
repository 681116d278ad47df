//! Residuals and derivatives of a record's lines over their noise, and their products.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use super::line_block::{BLOCK, LineBlock};
use super::records::PlaceRecord;
use super::synthesis::PairModel;

/// Lines summed by one task: enough to be worth a task, few enough to share out evenly.
pub(super) const RUN: usize = 32 * BLOCK;

/// $[J\,r]$ over the noise of runs of lines: derivatives by the free constants first, then by each $\ln\zeta$, then the residual.
pub(super) struct WeightedRows<'a> {
    record: &'a PlaceRecord,
    model: &'a PairModel,
    chain: &'a [Vec<f64>],
    functions: Vec<LineBlock>,
    rows: Mat<f64>,
}

impl<'a> WeightedRows<'a> {
    pub(super) fn of(record: &'a PlaceRecord, model: &'a PairModel, chain: &'a [Vec<f64>]) -> Self {
        let functions = vec![LineBlock::ZERO; model.functions()];
        let coefficients = chain.first().map_or(model.coefficients(), Vec::len);
        let size = chain.len() + model.functions() - coefficients;
        Self { record, model, chain, functions, rows: Mat::zeros(2 * BLOCK, size) }
    }

    /// Columns: the derivatives, and one for the residual.
    pub(super) fn size(&self) -> usize {
        self.rows.ncols()
    }

    /// The [`BLOCK`] lines from this one on, real parts above imaginary ones.
    pub(super) fn block(&mut self, from: usize) -> &Mat<f64> {
        let Self { record, model, chain, functions, rows } = self;
        let coefficients = chain.first().map_or(model.coefficients(), Vec::len);
        let last = rows.ncols() - 1;
        model.lines(&record.s_block(from), functions);
        let weights = record.weights(from);
        let (structural, by_zeta) = functions.split_at_mut(1 + coefficients);
        let Some((value, by_coefficients)) = structural.split_first_mut() else { return rows };
        for (column, shares) in chain.iter().enumerate() {
            let mut by = LineBlock::ZERO;
            for (by_coefficient, share) in by_coefficients.iter().zip(shares) {
                by.add_multiple(by_coefficient, *share);
            }
            by.write_weighted(&weights, rows.col_as_slice_mut(column));
        }
        for (by, column) in by_zeta.iter().zip(chain.len()..) {
            by.write_weighted(&weights, rows.col_as_slice_mut(column));
        }
        value.subtract(&record.value[from..]);
        value.write_weighted(&weights, rows.col_as_slice_mut(last));
        rows
    }
}

/// $[J\,r]^T[J\,r]$ of a run of lines.
pub(super) fn run_products(record: &PlaceRecord, model: &PairModel, chain: &[Vec<f64>], from: usize) -> Mat<f64> {
    let mut rows = WeightedRows::of(record, model, chain);
    let mut products = Mat::zeros(rows.size(), rows.size());
    for from in (from..record.value.len().min(from + RUN)).step_by(BLOCK) {
        let rows = rows.block(from);
        matmul(&mut products, Accum::Add, rows.transpose(), rows, 1.0, Par::Seq);
    }
    products
}
