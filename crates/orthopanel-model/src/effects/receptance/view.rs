//! What one record sees of the modes: numbers in one list, so that a complex modulus can interpolate between lists.

use faer::Mat;
use num_complex::Complex64;

use super::far_modes::{self, SERIES_TERMS};
use super::modal_base::ModalBase;
use crate::ModelError;
use crate::dense::product;
use crate::effects::row::Row;

/// Where what stands in a [`View`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    /// Modes that are summed, rigid ones first.
    modes: usize,
    /// Rigid ones.
    rigid: usize,
    /// Force, response, then the elements.
    rows: usize,
}

/// $\lambda_m$, shapes, and the series of the modes above.
#[derive(Debug, Clone)]
pub(super) struct View {
    pub layout: Layout,
    pub numbers: Vec<f64>,
}

impl Layout {
    /// Start of the shape of mode `m` in all rows.
    fn shape(&self, m: usize) -> usize {
        self.modes + m * self.rows
    }

    /// Start of $C_k$, row by row.
    fn series(&self, k: usize) -> usize {
        self.shape(self.modes) + k * self.rows * self.rows
    }

    /// The receptances between all rows at `s`, row by row, by the numbers of a view; those of force and response at their own
    /// places are left out. `zetas` are those of the flexible modes that are summed and of all beyond.
    pub(super) fn receptances(&self, numbers: &[Complex64], zetas: &[f64], s: Complex64) -> Vec<Complex64> {
        let n = self.rows;
        let last = (self.modes > self.rigid).then(|| numbers[self.modes - 1]);
        let weights = far_modes::weights(s, zetas[self.modes - self.rigid], last);
        let gain = |m: usize| {
            let lambda = numbers[m];
            let zeta = if m < self.rigid { 0.0 } else { zetas[m - self.rigid] };
            (s * s + 2.0 * zeta * lambda.sqrt() * s + lambda).inv()
        };
        let gains: Vec<Complex64> = (0..self.modes).map(gain).collect();
        let mut bare = vec![Complex64::ZERO; n * n];
        for a in 0..n {
            for b in (a..n).filter(|&b| a != b || a >= super::elements::BARE) {
                let far = weights.iter().enumerate().map(|(k, weight)| weight * numbers[self.series(k) + a * n + b]);
                let near = gains.iter().enumerate().map(|(m, gain)| {
                    let shape = self.shape(m);
                    gain * numbers[shape + a] * numbers[shape + b]
                });
                bare[a * n + b] = far.chain(near).sum();
                bare[b * n + a] = bare[a * n + b];
            }
        }
        bare
    }
}

impl View {
    pub(super) fn new(base: &ModalBase, rows: &[Row]) -> Result<Self, ModelError> {
        let layout = Layout { modes: base.near.len(), rigid: base.rigid, rows: rows.len() };
        let mut view = Self { layout, numbers: vec![0.0; layout.series(SERIES_TERMS)] };
        for index in 0..base.blocks.len() {
            view.add_block(base, index, &base.rows(index, rows)?);
        }
        view.close(base, rows);
        Ok(view)
    }

    fn add_block(&mut self, base: &ModalBase, index: usize, shapes: &Mat<f64>) {
        let Layout { rows, .. } = self.layout;
        let lambda = &base.blocks[index].lambda;
        let mut is_near = vec![false; lambda.len()];
        for (m, &(_, n)) in base.near.iter().enumerate().filter(|(_, (block, _))| *block == index) {
            is_near[n] = true;
            self.numbers[m] = lambda[n];
            let at = self.layout.shape(m);
            (0..rows).for_each(|row| self.numbers[at + row] = shapes[(row, n)]);
        }
        let far: Vec<usize> = (0..lambda.len()).filter(|&n| !is_near[n]).collect();
        let bare = Mat::from_fn(rows, far.len(), |row, i| shapes[(row, far[i])]);
        for k in 0..SERIES_TERMS {
            let weighted =
                Mat::from_fn(rows, far.len(), |row, i| bare[(row, i)] * lambda[far[i]].powi(-(k as i32 + 1)));
            self.add_to_series(k, &product(weighted.as_ref(), bare.transpose()));
        }
    }

    /// Puts the exact static flexibility in place of the basis' own, where the structure knows it, else adds what the basis
    /// is known to lack; adds what it lacks of the series' further terms: most at a driving point, where the strain jumps.
    fn close(&mut self, base: &ModalBase, rows: &[Row]) {
        let (layout, structure) = (self.layout, &base.structure);
        let further = structure.inertial_remainders(&base.values, [rows; 2]);
        (1..SERIES_TERMS).zip(&further).for_each(|(term, lacking)| self.add_to_series(term, lacking));
        if let Some(lacking) = structure.static_remainders(&base.values, [rows; 2]) {
            return self.add_to_series(0, &lacking);
        }
        for (row, &first) in rows.iter().enumerate() {
            for (column, &second) in rows.iter().enumerate() {
                let Some(whole) = structure.static_flexibility(&base.values, [first, second]) else { continue };
                let summed = (layout.rigid..layout.modes).map(|m| {
                    let at = layout.shape(m);
                    self.numbers[at + row] * self.numbers[at + column] / self.numbers[m]
                });
                let rest = whole - summed.sum::<f64>();
                self.numbers[layout.series(0) + row * layout.rows + column] = rest;
            }
        }
    }

    fn add_to_series(&mut self, k: usize, matrix: &Mat<f64>) {
        let at = self.layout.series(k);
        for row in 0..matrix.nrows() {
            for column in 0..matrix.ncols() {
                self.numbers[at + row * matrix.ncols() + column] += matrix[(row, column)];
            }
        }
    }
}
