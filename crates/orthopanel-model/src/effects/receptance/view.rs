//! What one record sees of the modes: numbers in one list, so that a complex modulus can interpolate between lists.

use faer::Mat;

use super::modal_base::{BlockModes, ModalBase, Row};
use crate::ModelError;
use crate::dense::product;

/// Terms of the series in $s^2$ that stands for the modes above the sum. Where these begin at 2.5 times the band, six
/// leave 2e-5 of a part that is small itself.
pub(in crate::effects) const SERIES_TERMS: usize = 6;

/// Where what stands in a [`View`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::effects) struct Layout {
    /// Modes that are summed, rigid ones first.
    pub modes: usize,
    /// Rigid ones.
    pub rigid: usize,
    /// Active rows: force, response, then the elements.
    pub active: usize,
    /// Rows for derivatives by a place.
    pub slopes: usize,
    /// Parameters of the structure.
    pub parameters: usize,
}

/// $\lambda_m$, shapes, the series of the modes above, and derivatives of all.
#[derive(Debug, Clone)]
pub(in crate::effects) struct View {
    pub layout: Layout,
    pub numbers: Vec<f64>,
}

impl Layout {
    pub(in crate::effects) fn rows(&self) -> usize {
        self.active + self.slopes
    }

    /// Start of the shape of mode `m` in all rows.
    pub(in crate::effects) fn shape(&self, m: usize) -> usize {
        self.modes + m * self.rows()
    }

    /// Start of $C_k$: a line of the active rows for each of all rows.
    pub(in crate::effects) fn series(&self, k: usize) -> usize {
        self.shape(self.modes) + k * self.rows() * self.active
    }

    /// Start of what parameter `p` changes: $\lambda$, active shapes mode by mode, active $C_k$.
    pub(in crate::effects) fn by(&self, p: usize) -> usize {
        let each = self.modes * (1 + self.active) + SERIES_TERMS * self.active * self.active;
        self.series(SERIES_TERMS) + p * each
    }

    pub(in crate::effects) fn shape_by(&self, p: usize, m: usize) -> usize {
        self.by(p) + self.modes + m * self.active
    }

    pub(in crate::effects) fn series_by(&self, p: usize, k: usize) -> usize {
        self.shape_by(p, self.modes) + k * self.active * self.active
    }

    fn size(&self) -> usize {
        self.by(self.parameters)
    }
}

impl View {
    pub(in crate::effects) fn new(base: &ModalBase, active: &[Row], slopes: &[Row]) -> Result<Self, ModelError> {
        let layout = Layout {
            modes: base.near.len(),
            rigid: base.rigid,
            active: active.len(),
            slopes: slopes.len(),
            parameters: base.parameters,
        };
        let rows: Vec<Row> = active.iter().chain(slopes).copied().collect();
        let mut view = Self { layout, numbers: vec![0.0; layout.size()] };
        for (index, block) in base.blocks.iter().enumerate() {
            let shapes = base.rows(index, &rows)?;
            let summed: Vec<(usize, usize)> =
                base.near.iter().enumerate().filter(|(_, (b, _))| *b == index).map(|(m, (_, n))| (m, *n)).collect();
            let part = BlockPart::new(block, shapes, summed);
            view.add_near(&part);
            view.add_far(&part);
        }
        view.close(base, &rows);
        for difference in &base.differences {
            let [back, forth] = &difference.sides;
            let [back, forth] = [Self::new(back, active, &[])?, Self::new(forth, active, &[])?];
            view.set_difference(difference.parameter, [back, forth], difference.step);
        }
        Ok(view)
    }

    /// Writes derivatives by parameter `p` from views that lie two steps apart.
    fn set_difference(&mut self, p: usize, mut sides: [Self; 2], step: f64) {
        let Layout { modes, active, .. } = self.layout;
        for side in &mut sides {
            (0..modes).for_each(|m| side.turn_like(self, m));
        }
        let [back, forth] = &sides;
        let slope = |at: usize| (forth.numbers[at] - back.numbers[at]) / (2.0 * step);
        let layout = back.layout;
        for m in 0..modes {
            self.numbers[self.layout.by(p) + m] = slope(m);
            let to = self.layout.shape_by(p, m);
            (0..active).for_each(|row| self.numbers[to + row] = slope(layout.shape(m) + row));
        }
        for k in 0..SERIES_TERMS {
            let to = self.layout.series_by(p, k);
            (0..active * active).for_each(|i| self.numbers[to + i] = slope(layout.series(k) + i));
        }
    }

    /// Gives mode `m` the sign that it has in another view.
    fn turn_like(&mut self, other: &Self, m: usize) {
        let (here, there) = (self.layout.shape(m), other.layout.shape(m));
        let overlap: f64 =
            (0..self.layout.active).map(|row| self.numbers[here + row] * other.numbers[there + row]).sum();
        if overlap < 0.0 {
            (0..self.layout.active).for_each(|row| self.numbers[here + row] *= -1.0);
        }
    }

    fn add_near(&mut self, part: &BlockPart) {
        let Layout { active, .. } = self.layout;
        for &(m, n) in &part.summed {
            self.numbers[m] = part.block.lambda[n];
            let at = self.layout.shape(m);
            (0..self.layout.rows()).for_each(|row| self.numbers[at + row] = part.shapes[(row, n)]);
            for p in 0..self.layout.parameters {
                self.numbers[self.layout.by(p) + m] = part.perturbation(p, n, n);
                let at = self.layout.shape_by(p, m);
                for other in 0..part.block.lambda.len() {
                    let share = part.share(p, other, n);
                    (0..active).for_each(|row| self.numbers[at + row] += share * part.shapes[(row, other)]);
                }
            }
        }
    }

    fn add_far(&mut self, part: &BlockPart) {
        let Layout { active, parameters, .. } = self.layout;
        let rows = self.layout.rows();
        let far = part.far_shapes();
        let weighted: Vec<Mat<f64>> = (0..SERIES_TERMS)
            .map(|k| Mat::from_fn(rows, part.far.len(), |row, i| far[(row, i)] * part.power(i, k)))
            .collect();
        let heads: Vec<_> = weighted.iter().map(|matrix| matrix.subrows(0, active)).collect();
        let between = |j: usize, matrix: &Mat<f64>, k: usize| {
            product(product(heads[j], matrix.as_ref()).as_ref(), heads[k].transpose())
        };
        for (k, matrix) in weighted.iter().enumerate() {
            let series = product(matrix.as_ref(), far.subrows(0, active).transpose());
            let at = self.layout.series(k);
            add(&mut self.numbers[at..], &series);
        }
        for p in 0..parameters {
            let [stiffness, mass] = part.far_couplings(p);
            for k in 0..SERIES_TERMS {
                let mut by = part.towards_near(p, k, active);
                // Divided differences of λ^-(k+1), and of λ^-k for the mass.
                if stiffness.nrows() > 0 {
                    (0..=k).for_each(|j| by -= between(j, &stiffness, k - j));
                }
                if mass.nrows() > 0 {
                    (0..k).for_each(|j| by += between(j, &mass, k - 1 - j));
                }
                let at = self.layout.series_by(p, k);
                add(&mut self.numbers[at..], &by);
            }
        }
    }

    /// Puts the exact static flexibility in place of the basis' own, where the structure knows it.
    fn close(&mut self, base: &ModalBase, rows: &[Row]) {
        let layout = self.layout;
        for (row, &first) in rows.iter().enumerate() {
            for (column, &second) in rows.iter().take(layout.active).enumerate() {
                let Some(whole) = base.structure.static_flexibility(&base.values, [first, second]) else { return };
                let summed = (layout.rigid..layout.modes).map(|m| self.product(m, row, column) / self.numbers[m]);
                let rest = whole.value - summed.sum::<f64>();
                self.numbers[layout.series(0) + row * layout.active + column] = rest;
                if row >= layout.active {
                    continue;
                }
                let known = whole.by_constants.iter().map(|by| Some(*by));
                let terms = base.terms.iter().map(|term| whole.by_terms.get(*term).copied().flatten());
                for (p, by) in known.chain(terms).enumerate() {
                    let Some(by) = by else { continue };
                    let summed = (layout.rigid..layout.modes).map(|m| self.product_by(p, m, row, column));
                    let rest = by - summed.sum::<f64>();
                    self.numbers[layout.series_by(p, 0) + row * layout.active + column] = rest;
                }
            }
        }
    }

    fn product(&self, m: usize, row: usize, column: usize) -> f64 {
        let at = self.layout.shape(m);
        self.numbers[at + row] * self.numbers[at + column]
    }

    /// Derivative of $\phi_a\phi_b/\lambda$.
    fn product_by(&self, p: usize, m: usize, row: usize, column: usize) -> f64 {
        let (shape, by, lambda) = (self.layout.shape(m), self.layout.shape_by(p, m), self.numbers[m]);
        let turned = self.numbers[by + row] * self.numbers[shape + column]
            + self.numbers[shape + row] * self.numbers[by + column];
        (turned - self.product(m, row, column) * self.numbers[self.layout.by(p) + m] / lambda) / lambda
    }
}

fn add(into: &mut [f64], matrix: &Mat<f64>) {
    for row in 0..matrix.nrows() {
        for column in 0..matrix.ncols() {
            into[row * matrix.ncols() + column] += matrix[(row, column)];
        }
    }
}

/// One block's modes in the rows of a record, parted into those that are summed and those above.
struct BlockPart<'a> {
    block: &'a BlockModes,
    shapes: Mat<f64>,
    /// Position in the view and in the block.
    summed: Vec<(usize, usize)>,
    /// Positions in the block.
    far: Vec<usize>,
}

impl<'a> BlockPart<'a> {
    fn new(block: &'a BlockModes, shapes: Mat<f64>, summed: Vec<(usize, usize)>) -> Self {
        let far = (0..block.lambda.len()).filter(|n| !summed.iter().any(|(_, near)| near == n)).collect();
        Self { block, shapes, summed, far }
    }

    fn entry(&self, p: usize, kind: usize, m: usize, n: usize) -> f64 {
        let matrix = &self.block.couplings[p][kind];
        if matrix.nrows() > 0 { matrix[(m, n)] } else { 0.0 }
    }

    /// $\kappa_{mn} - \lambda_n\mu_{mn}$.
    fn perturbation(&self, p: usize, m: usize, n: usize) -> f64 {
        self.entry(p, 0, m, n) - self.block.lambda[n] * self.entry(p, 1, m, n)
    }

    /// The share of mode `m` in the derivative of mode `n`'s shape. Modes that coincide, as rigid ones do, only keep
    /// their norm and stay orthogonal.
    fn share(&self, p: usize, m: usize, n: usize) -> f64 {
        let gap = self.block.lambda[n] - self.block.lambda[m];
        if gap == 0.0 { -0.5 * self.entry(p, 1, m, n) } else { self.perturbation(p, m, n) / gap }
    }

    /// $\lambda^{-(k+1)}$ of far mode `i`.
    fn power(&self, i: usize, k: usize) -> f64 {
        self.block.lambda[self.far[i]].powi(-(k as i32 + 1))
    }

    fn far_shapes(&self) -> Mat<f64> {
        Mat::from_fn(self.shapes.nrows(), self.far.len(), |row, i| self.shapes[(row, self.far[i])])
    }

    fn far_couplings(&self, p: usize) -> [Mat<f64>; 2] {
        [0, 1].map(|kind| {
            let matrix = &self.block.couplings[p][kind];
            let size = if matrix.nrows() > 0 { self.far.len() } else { 0 };
            Mat::from_fn(size, size, |i, j| matrix[(self.far[i], self.far[j])])
        })
    }

    /// What the far modes gain of the near ones: $\sum\lambda_m^{-(k+1)}(\phi_m\phi_n^T + \phi_n\phi_m^T)$ times the shares.
    fn towards_near(&self, p: usize, k: usize, active: usize) -> Mat<f64> {
        let mut sum = Mat::zeros(active, active);
        for (i, &m) in self.far.iter().enumerate() {
            let gained: Vec<f64> = (0..active)
                .map(|row| self.summed.iter().map(|&(_, n)| self.share(p, n, m) * self.shapes[(row, n)]).sum())
                .collect();
            let power = self.power(i, k);
            for row in 0..active {
                for column in 0..active {
                    let pair = self.shapes[(row, m)] * gained[column] + gained[row] * self.shapes[(column, m)];
                    sum[(row, column)] += power * pair;
                }
            }
        }
        sum
    }
}
