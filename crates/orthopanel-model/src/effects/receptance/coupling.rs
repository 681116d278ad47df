//! Some lines: the sum over modes, the elements joined to it, and every derivative.
//!
//! With the bare receptances $H$, an element at row $p$ takes the force $g_p$, and $A_px_p = B_pg_p$ for its
//! displacement (see [`ElementLine`]). A unit force at $a$ moves the element's place by $x_p = H_{pa} - \sum_qH_{pq}g_q$,
//! so with $g = A\mu$, $x = B\mu$
//! $$(B + H_{PP}A)\,\mu_a = H_{Pa},\qquad H'_{ab} = H_{ab} - H_{aP}A\mu_b .$$
//! Derivatives follow from the effective shapes $\phi^a_m = \phi_m(a) - \sum_pg_{p}\phi_m(p)$: a change of the modes
//! acts as it would on the bare structure, one of an element as $-\mu_r(B\,dA - A\,dB)\mu_f$, and one of a place through
//! the slope of the motion there.

use num_complex::Complex64;

use super::far_modes::FarModes;
use super::view::Layout;
use super::wide::{LINES, Numbers, Wide};
use crate::effects::ElementLine;

/// Where the derivatives of a line go; each list says which column takes what.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    /// Column of each parameter of the structure.
    pub structure: Vec<usize>,
    /// First column of the logarithms of the damping ratios, and how many flexible modes have one; the next is that of all
    /// modes beyond.
    pub zetas: (usize, usize),
    /// Element, number of its law, column, factor.
    pub elements: Vec<(usize, usize, usize, f64)>,
    /// Whether the derivative by $s$ is needed.
    pub frequency: bool,
    /// Active row whose place moves, and column; row `i` of the slopes belongs to entry `i`.
    pub places: Vec<(usize, usize)>,
}

/// Active rows where no element is joined: force and response, each loaded by its own unit force alone.
const BARE: usize = 2;

/// Space for the numbers of some lines.
#[derive(Debug, Clone, Default)]
pub(super) struct Coupling {
    /// $1/(s^2 + 2\zeta\omega s + \omega^2)$ and $\omega$ of each mode.
    gains: Vec<Wide>,
    roots: Vec<Wide>,
    /// Squared gain times both effective shapes: what a softer mode adds; and that times $-(1+\zeta s/\omega)$, what a
    /// greater $\lambda$ does.
    weights: Vec<Wide>,
    stiffer: Vec<Wide>,
    /// $H$ between the active rows.
    bare: Vec<Wide>,
    system: Vec<Complex64>,
    /// $\mu$ for a unit force at the force's place and at the response's.
    states: [Vec<Wide>; 2],
    /// What a unit force there puts on each active row.
    loads: [Vec<Wide>; 2],
    /// Effective shapes.
    shapes: [Vec<Wide>; 2],
    far: FarModes,
}

/// A receptance with its derivative by $s$.
pub(super) struct Receptance {
    pub value: Wide,
    pub by_s: Wide,
}

impl Coupling {
    /// The receptances at some $s$ between force (row 0) and response (row 1) of a view, and into `out` their derivatives,
    /// a [`Wide`] a column. `zetas` are those of the flexible modes that are summed and of all beyond, `elements` has [`LINES`]
    /// lines of each element.
    #[inline(always)]
    pub(super) fn lines(
        &mut self,
        (layout, numbers): (&Layout, &impl Numbers),
        zetas: &[f64],
        elements: &[Vec<ElementLine>],
        columns: &Columns,
        s: &Wide,
        out: &mut [Wide],
    ) -> Receptance {
        self.sum((layout, numbers), zetas, columns.frequency, s);
        self.join(layout, elements);
        self.effective_shapes((layout, numbers), zetas, s);
        let mut value = self.bare[1];
        for p in 0..elements.len() {
            value.add_product(&self.bare[layout.active + 2 + p], &self.loads[0][2 + p]);
        }
        self.by_damping((layout, numbers), zetas, columns, s, out);
        for &(p, number, column, factor) in &columns.elements {
            let change = self.change(&elements[p], p, |line| line.by_numbers[number]);
            out[column].add_scaled(factor, &change);
        }
        self.by_structure((layout, numbers), columns, out);
        self.by_places((layout, numbers), columns, out);
        let by_s =
            if columns.frequency { self.by_frequency((layout, numbers), zetas, elements, s) } else { Wide::ZERO };
        Receptance { value, by_s }
    }

    /// Bare receptances between the active rows.
    #[inline(always)]
    fn sum(&mut self, (layout, numbers): (&Layout, &impl Numbers), zetas: &[f64], by_s: bool, s: &Wide) {
        let n = layout.active;
        let s2 = s.times(s);
        if layout.modes > layout.rigid {
            let last = layout.modes - 1;
            let beyond = zetas[layout.modes - layout.rigid];
            self.far.set(s, beyond, [&numbers.wide(last), &numbers.root(last)], by_s);
        } else {
            self.far.set(s, 0.0, [&Wide::ONE, &Wide::ONE], by_s);
        }
        self.bare.clear();
        self.bare.resize(n * n, Wide::ZERO);
        self.gains.clear();
        self.roots.clear();
        // No one asks for the driving points of force and response.
        let needed = |a: usize, b: usize| a != b || a >= BARE;
        for a in 0..n {
            for b in (a..n).filter(|&b| needed(a, b)) {
                let total = &mut self.bare[a * n + b];
                for (k, power) in self.far.weights.iter().enumerate() {
                    numbers.add(layout.series(k) + a * n + b, power, total);
                }
            }
        }
        for m in 0..layout.modes {
            let root = numbers.root(m);
            let mut whole = s2;
            whole.add(&numbers.wide(m));
            if m >= layout.rigid {
                whole.add_product(&root.scaled(2.0 * zetas[m - layout.rigid]), s);
            }
            let gain = whole.inverse();
            let shape = layout.shape(m);
            for a in 0..n {
                for b in (a..n).filter(|&b| needed(a, b)) {
                    numbers.add_pair([shape + a, shape + b], &gain, &mut self.bare[a * n + b]);
                }
            }
            self.gains.push(gain);
            self.roots.push(root);
        }
        for a in 0..n {
            for b in 0..a {
                self.bare[a * n + b] = self.bare[b * n + a];
            }
        }
    }

    /// Solves for the elements' states.
    fn join(&mut self, layout: &Layout, elements: &[Vec<ElementLine>]) {
        let (n, count) = (layout.active, elements.len());
        let width = count + 2;
        for side in 0..2 {
            self.states[side].clear();
            self.states[side].resize(count, Wide::ZERO);
            self.loads[side].clear();
            self.loads[side].resize(n, Wide::ZERO);
            self.loads[side][side] = Wide::ONE;
        }
        if count == 0 {
            return;
        }
        for line in 0..LINES {
            self.system.clear();
            for (p, row) in elements.iter().enumerate() {
                for (q, element) in elements.iter().enumerate() {
                    let own = if p == q { row[line].pair[1] } else { Complex64::ZERO };
                    self.system.push(own + self.bare[(2 + p) * n + 2 + q].at(line) * element[line].pair[0]);
                }
                self.system.extend([0, 1].map(|side| self.bare[(2 + p) * n + side].at(line)));
            }
            eliminate(&mut self.system, count);
            for (p, element) in elements.iter().enumerate() {
                for side in 0..2 {
                    let state = self.system[p * width + count + side];
                    self.states[side][p].set(line, state);
                    self.loads[side][2 + p].set(line, -element[line].pair[0] * state);
                }
            }
        }
    }

    #[inline(always)]
    fn effective_shapes(&mut self, (layout, numbers): (&Layout, &impl Numbers), zetas: &[f64], s: &Wide) {
        let Self { gains, roots, weights, stiffer, shapes, loads, .. } = self;
        weights.clear();
        stiffer.clear();
        shapes.iter_mut().for_each(Vec::clear);
        for m in 0..layout.modes {
            let at = layout.shape(m);
            let squared = gains[m].times(&gains[m]);
            let mut weight = Wide::ZERO;
            if layout.active == BARE {
                numbers.add_pair([at, at + 1], &squared, &mut weight);
            } else {
                for (side, (shapes, loads)) in shapes.iter_mut().zip(&*loads).enumerate() {
                    let mut shape = numbers.wide(at + side);
                    for (row, load) in loads.iter().enumerate().skip(BARE) {
                        numbers.add(at + row, load, &mut shape);
                    }
                    shapes.push(shape);
                }
                weight = squared.times(&shapes[0][m].times(&shapes[1][m]));
            }
            let mut softening = weight.scaled(-1.0);
            if m >= layout.rigid {
                let slowness = numbers.inverse_root(m, &roots[m]);
                softening.add_product(&weight.times(s).scaled(-zetas[m - layout.rigid]), &slowness);
            }
            weights.push(weight);
            stiffer.push(softening);
        }
    }

    /// Derivatives by the damping ratios.
    #[inline(always)]
    fn by_damping(
        &self,
        (layout, numbers): (&Layout, &impl Numbers),
        zetas: &[f64],
        columns: &Columns,
        s: &Wide,
        out: &mut [Wide],
    ) {
        let (first, own) = columns.zetas;
        for (i, (zeta, m)) in zetas.iter().zip(layout.rigid..layout.modes).enumerate() {
            let loss = self.roots[m].times(s).scaled(-2.0 * zeta);
            out[first + i.min(own)].add_product(&self.weights[m], &loss);
        }
        let beyond = first + own.min(layout.modes - layout.rigid);
        self.add_far((layout, numbers), &self.far.by_damping, |k| layout.series(k), &mut out[beyond]);
    }

    /// The derivative by $s$.
    fn by_frequency(
        &self,
        (layout, numbers): (&Layout, &impl Numbers),
        zetas: &[f64],
        elements: &[Vec<ElementLine>],
        s: &Wide,
    ) -> Wide {
        let mut sum = Wide::ZERO;
        let mut weights = Wide::ZERO;
        self.weights.iter().for_each(|weight| weights.add(weight));
        sum.add_product(&s.scaled(-2.0), &weights);
        let flexible = zetas.iter().zip(&self.roots[layout.rigid..]).zip(&self.weights[layout.rigid..]);
        flexible.for_each(|((zeta, root), weight)| sum.add_product(&root.scaled(-2.0 * zeta), weight));
        self.add_far((layout, numbers), &self.far.by_s, |k| layout.series(k), &mut sum);
        for (p, element) in elements.iter().enumerate() {
            sum.add(&self.change(element, p, |line| line.by_s));
        }
        sum
    }

    /// $-\mu_r(B\,dA - A\,dB)\mu_f$ of element `p`.
    fn change(&self, element: &[ElementLine], p: usize, by: impl Fn(&ElementLine) -> [Complex64; 2]) -> Wide {
        Wide::from_fn(|line| {
            let ([a, b], [by_a, by_b]) = (element[line].pair, by(&element[line]));
            -self.states[0][p].at(line) * self.states[1][p].at(line) * (b * by_a - a * by_b)
        })
    }

    #[inline(always)]
    fn by_structure(&self, (layout, numbers): (&Layout, &impl Numbers), columns: &Columns, out: &mut [Wide]) {
        let n = layout.active;
        let mut far_by_lambda = Wide::ZERO;
        self.add_far((layout, numbers), &self.far.by_lambda, |k| layout.series(k), &mut far_by_lambda);
        for (p, &column) in columns.structure.iter().enumerate() {
            let mut sum = Wide::ZERO;
            numbers.add(layout.by(p) + layout.modes - 1, &far_by_lambda, &mut sum);
            for m in 0..layout.modes {
                let (by, shape) = (layout.shape_by(p, m), layout.shape(m));
                if n == BARE {
                    numbers.add_pair([by, shape + 1], &self.gains[m], &mut sum);
                    numbers.add_pair([by + 1, shape], &self.gains[m], &mut sum);
                } else {
                    let mut turned = [Wide::ZERO; 2];
                    for (side, turned) in turned.iter_mut().enumerate() {
                        *turned = numbers.wide(by + side);
                        for (row, load) in self.loads[side].iter().enumerate().skip(BARE) {
                            numbers.add(by + row, load, turned);
                        }
                    }
                    let mut both = turned[0].times(&self.shapes[1][m]);
                    both.add_product(&turned[1], &self.shapes[0][m]);
                    sum.add_product(&self.gains[m], &both);
                }
                if m >= layout.rigid {
                    numbers.add(layout.by(p) + m, &self.stiffer[m], &mut sum);
                }
            }
            self.add_far((layout, numbers), &self.far.weights, |k| layout.series_by(p, k), &mut sum);
            out[column].add(&sum);
        }
    }

    #[inline(always)]
    fn by_places(&self, (layout, numbers): (&Layout, &impl Numbers), columns: &Columns, out: &mut [Wide]) {
        let n = layout.active;
        for (slope, &(row, column)) in columns.places.iter().enumerate() {
            let at = n + slope;
            // Slope of the motion at that row under a unit force at either side.
            let [forced, seen] = [0, 1].map(|side| {
                let mut moved = Wide::ZERO;
                for m in 0..layout.modes {
                    if n == BARE {
                        numbers.add_pair([layout.shape(m) + side, layout.shape(m) + at], &self.gains[m], &mut moved);
                    } else {
                        let lever = self.gains[m].times(&self.shapes[side][m]);
                        numbers.add(layout.shape(m) + at, &lever, &mut moved);
                    }
                }
                for (k, power) in self.far.weights.iter().enumerate() {
                    let mut still = Wide::ZERO;
                    let row = layout.series(k) + at * n;
                    if n == BARE {
                        numbers.add(row + side, power, &mut moved);
                        continue;
                    }
                    for b in std::iter::once(side).chain(BARE..n) {
                        numbers.add(row + b, &self.loads[side][b], &mut still);
                    }
                    moved.add_product(power, &still);
                }
                moved
            });
            out[column].add_product(&self.loads[0][row], &seen);
            out[column].add_product(&self.loads[1][row], &forced);
        }
    }

    /// Adds $\sum_kw_ku_r^TC_ku_f$, with $C_k$ from `at` on.
    #[inline(always)]
    fn add_far(
        &self,
        (layout, numbers): (&Layout, &impl Numbers),
        weights: &[Wide],
        at: impl Fn(usize) -> usize,
        sum: &mut Wide,
    ) {
        let n = layout.active;
        for (k, weight) in weights.iter().enumerate() {
            if n == BARE {
                numbers.add(at(k) + n, weight, sum);
            } else {
                sum.add_product(weight, &self.form(numbers, at(k), n));
            }
        }
    }

    /// $u_r^TCu_f$ over the active rows, with $C$ from `at` on.
    #[inline(always)]
    fn form(&self, numbers: &impl Numbers, at: usize, n: usize) -> Wide {
        let [forced, seen] = &self.loads;
        // A unit force loads no other row than its own and those of elements.
        let loaded = |side: usize| std::iter::once(side).chain(BARE..n);
        let mut sum = Wide::ZERO;
        for a in loaded(1) {
            let mut line = Wide::ZERO;
            for b in loaded(0) {
                numbers.add(at + a * n + b, &forced[b], &mut line);
            }
            sum.add_product(&seen[a], &line);
        }
        sum
    }
}

/// Gauss's elimination with pivots on `count` rows of `count + 2` numbers: the last two columns become the solutions.
fn eliminate(system: &mut [Complex64], count: usize) {
    let width = count + 2;
    for column in 0..count {
        let size = |row: &usize| system[row * width + column].norm_sqr();
        let pivot = (column..count).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(column);
        if pivot != column {
            (0..width).for_each(|j| system.swap(pivot * width + j, column * width + j));
        }
        let inverse = system[column * width + column].inv();
        (column..width).for_each(|j| system[column * width + j] *= inverse);
        for row in (0..count).filter(|row| *row != column) {
            let share = system[row * width + column];
            for j in column..width {
                let taken = share * system[column * width + j];
                system[row * width + j] -= taken;
            }
        }
    }
}
