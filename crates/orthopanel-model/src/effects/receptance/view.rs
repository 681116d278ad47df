//! What one record sees of the modes: numbers in one list, so that a complex modulus can interpolate between lists.

use faer::{Mat, MatRef};

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
            view.add_near(block, &shapes);
            view.add_far(block, &shapes);
            for (p, moved) in &base.moved {
                let change = product(moved.rows(index, active)?.as_ref(), block.vectors.as_ref());
                view.move_rows(*p, block, &shapes, &change);
            }
        }
        view.close(base, &rows);
        view.add_inertia(base, &rows);
        Ok(view)
    }

    /// Adds to the derivatives by parameter `p` what the modes' values in the active rows change where their coordinates stay.
    fn move_rows(&mut self, p: usize, block: &BlockModes, shapes: &Mat<f64>, change: &Mat<f64>) {
        let active = self.layout.active;
        for &(m, n) in &block.near {
            let at = self.layout.shape_by(p, m);
            (0..active).for_each(|row| self.numbers[at + row] += change[(row, n)]);
        }
        let far = |rows: &Mat<f64>| Mat::from_fn(active, block.far.len(), |row, i| rows[(row, block.far[i])]);
        let (shapes, change) = (far(shapes), far(change));
        for k in 0..SERIES_TERMS {
            let weighted = Mat::from_fn(active, block.far.len(), |row, i| shapes[(row, i)] * block.powers[(i, k)]);
            let one_way = product(change.as_ref(), weighted.transpose());
            let at = self.layout.series_by(p, k);
            add(&mut self.numbers[at..], (&one_way + one_way.transpose()).as_ref());
        }
    }

    fn add_near(&mut self, block: &BlockModes, shapes: &Mat<f64>) {
        let Layout { active, parameters, .. } = self.layout;
        for &(m, n) in &block.near {
            self.numbers[m] = block.lambda[n];
            let at = self.layout.shape(m);
            (0..self.layout.rows()).for_each(|row| self.numbers[at + row] = shapes[(row, n)]);
        }
        for (p, turn) in block.turns.iter().enumerate().take(parameters) {
            let turned = product(shapes.subrows(0, active), turn.near.as_ref());
            for (i, &(m, _)) in block.near.iter().enumerate() {
                self.numbers[self.layout.by(p) + m] = turn.lambda[i];
                let at = self.layout.shape_by(p, m);
                (0..active).for_each(|row| self.numbers[at + row] = turned[(row, i)]);
            }
        }
    }

    fn add_far(&mut self, block: &BlockModes, shapes: &Mat<f64>) {
        let Layout { active, parameters, .. } = self.layout;
        let (rows, far) = (self.layout.rows(), block.far.len());
        // All terms of the series below each other, so that one product does for all: row r of term k is r + k rows.
        let weighted = |rows: usize| {
            Mat::from_fn(rows * SERIES_TERMS, far, |row, i| {
                shapes[(row % rows, block.far[i])] * block.powers[(i, row / rows)]
            })
        };
        let (whole, heads) = (weighted(rows), weighted(active));
        let bare = Mat::from_fn(active, far, |row, i| shapes[(row, block.far[i])]);
        let near = Mat::from_fn(active, block.near.len(), |row, i| shapes[(row, block.near[i].1)]);
        let series = product(whole.as_ref(), bare.transpose());
        for k in 0..SERIES_TERMS {
            add(&mut self.numbers[self.layout.series(k)..], series.subrows(k * rows, rows));
        }
        for (p, turn) in block.turns.iter().enumerate().take(parameters) {
            // What the far modes gain of the near ones.
            let gained = product(near.as_ref(), turn.far.as_ref());
            let one_way = product(heads.as_ref(), gained.transpose());
            let between = |matrix: &Mat<f64>| {
                let is_there = matrix.nrows() > 0;
                is_there.then(|| product(product(heads.as_ref(), matrix.as_ref()).as_ref(), heads.transpose()))
            };
            let [stiffness, mass] = turn.between.each_ref().map(between);
            for k in 0..SERIES_TERMS {
                let own = one_way.subrows(k * active, active);
                let mut by = own + own.transpose();
                // Divided differences of λ^-(k+1), and of λ^-k for the mass.
                let mut take = |whole: &Mat<f64>, factor: f64, one: usize, other: usize| {
                    for column in 0..active {
                        for row in 0..active {
                            by[(row, column)] += factor * whole[(one * active + row, other * active + column)];
                        }
                    }
                };
                if let Some(stiffness) = &stiffness {
                    (0..=k).for_each(|j| take(stiffness, -1.0, j, k - j));
                }
                if let Some(mass) = &mass {
                    (0..k).for_each(|j| take(mass, 1.0, j, k - 1 - j));
                }
                add(&mut self.numbers[self.layout.series_by(p, k)..], by.as_ref());
            }
        }
    }

    /// Puts the exact static flexibility in place of the basis' own, where the structure knows it.
    fn close(&mut self, base: &ModalBase, rows: &[Row]) {
        let layout = self.layout;
        for (row, &first) in rows.iter().enumerate() {
            for (column, &second) in rows.iter().take(layout.active).enumerate() {
                let Some(whole) = base.structure.static_flexibility(&base.values, [first, second]) else {
                    self.add_remainder(base, [first, second], [row, column]);
                    continue;
                };
                let summed = (layout.rigid..layout.modes).map(|m| self.product(m, row, column) / self.numbers[m]);
                let rest = whole.value - summed.sum::<f64>();
                self.numbers[layout.series(0) + row * layout.active + column] = rest;
                if row >= layout.active {
                    continue;
                }
                let known = whole.by_constants.iter().map(|by| Some(*by));
                let terms = base.terms.iter().map(|term| {
                    let moved = base.moved.iter().find(|(_, moved)| moved.term == *term);
                    match moved {
                        Some((_, moved)) => moved.static_flexibility(&base.values, [first, second]),
                        None => whole.by_terms.get(*term).copied().flatten(),
                    }
                });
                for (p, by) in known.chain(terms).enumerate().take(layout.parameters) {
                    let Some(by) = by else { continue };
                    let summed = (layout.rigid..layout.modes).map(|m| self.product_by(p, m, row, column));
                    let rest = by - summed.sum::<f64>();
                    self.numbers[layout.series_by(p, 0) + row * layout.active + column] = rest;
                }
            }
        }
    }

    /// Adds what the basis lacks of the series' second term: most at a driving point, where the strain jumps.
    fn add_inertia(&mut self, base: &ModalBase, rows: &[Row]) {
        let layout = self.layout;
        let lacking = base.structure.inertial_remainders(&base.values, rows, layout.active);
        add_all(&mut self.numbers[layout.series(1)..], lacking.iter().map(|lacking| lacking.value));
        let active = &rows[..layout.active];
        let lacking = &lacking[..lacking.len().min(layout.active * layout.active)];
        let constants = base.values.len();
        for p in 0..layout.parameters {
            let into = &mut self.numbers[layout.series_by(p, 1)..];
            let Some(&term) = p.checked_sub(constants).and_then(|position| base.terms.get(position)) else {
                add_all(into, lacking.iter().map(|lacking| lacking.by_constants.get(p).copied().unwrap_or_default()));
                continue;
            };
            match base.moved.iter().find(|(_, moved)| moved.term == term) {
                Some((_, moved)) => add_all(into, moved.inertial_remainders(&base.values, active, active.len())),
                None => add_all(
                    into,
                    lacking.iter().map(|lacking| lacking.by_terms.get(term).copied().flatten().unwrap_or_default()),
                ),
            }
        }
    }

    /// Adds what the basis is known to lack.
    fn add_remainder(&mut self, base: &ModalBase, motions: [Row; 2], [row, column]: [usize; 2]) {
        let Some((value, by_coefficients)) = base.structure.static_remainder(&base.values, motions) else { return };
        let (layout, at) = (self.layout, row * self.layout.active + column);
        self.numbers[layout.series(0) + at] += value;
        let Ok(chain) = base.structure.coefficient_derivatives(&base.values) else { return };
        if row < layout.active {
            for p in 0..chain.ncols().min(layout.parameters) {
                let by: f64 = by_coefficients.iter().enumerate().map(|(i, by)| by * chain[(i, p)]).sum();
                self.numbers[layout.series_by(p, 0) + at] += by;
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

fn add_all(into: &mut [f64], values: impl IntoIterator<Item = f64>) {
    into.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

fn add(into: &mut [f64], matrix: MatRef<'_, f64>) {
    for row in 0..matrix.nrows() {
        for column in 0..matrix.ncols() {
            into[row * matrix.ncols() + column] += matrix[(row, column)];
        }
    }
}
