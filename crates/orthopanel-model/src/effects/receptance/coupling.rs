//! One line: the sum over modes, the elements joined to it, and every derivative.
//!
//! With the bare receptances $H$, an element at row $p$ takes the force $g_p$, and $A_px_p = B_pg_p$ for its
//! displacement (see [`ElementLine`]). A unit force at $a$ moves the element's place by $x_p = H_{pa} - \sum_qH_{pq}g_q$,
//! so with $g = A\mu$, $x = B\mu$
//! $$(B + H_{PP}A)\,\mu_a = H_{Pa},\qquad H'_{ab} = H_{ab} - H_{aP}A\mu_b .$$
//! Derivatives follow from the effective shapes $\phi^a_m = \phi_m(a) - \sum_pg_{p}\phi_m(p)$: a change of the modes
//! acts as it would on the bare structure, one of an element as $-\mu_r(B\,dA - A\,dB)\mu_f$, and one of a place through
//! the slope of the motion there.

use std::ops::{Add, Mul};

use num_complex::Complex64;

use super::view::{Layout, SERIES_TERMS};
use crate::effects::ElementLine;

/// A number of a view: real, or complex where the modulus is.
pub(super) trait Number:
    Copy + Add<Output = Self> + Mul<Output = Self> + Mul<Complex64, Output = Complex64> + Into<Complex64>
{
    fn root(self) -> Self;
}

impl Number for f64 {
    fn root(self) -> Self {
        self.sqrt()
    }
}

impl Number for Complex64 {
    fn root(self) -> Self {
        self.sqrt()
    }
}

/// Where the derivatives of a line go; each list says which column takes what.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    /// Column of each parameter of the structure.
    pub structure: Vec<usize>,
    /// First column of the logarithms of the damping ratios, and how many flexible modes have one.
    pub zetas: (usize, usize),
    /// Element, number of its law, column, factor.
    pub elements: Vec<(usize, usize, usize, f64)>,
    /// Whether the derivative by $s$ is needed.
    pub frequency: bool,
    /// Active row whose place moves, and column; row `i` of the slopes belongs to entry `i`.
    pub places: Vec<(usize, usize)>,
}

/// Space for the numbers of one line.
#[derive(Debug, Clone, Default)]
pub(super) struct Coupling {
    /// $1/(s^2 + 2\zeta\omega s + \omega^2)$ and $\omega$ of each mode.
    gains: Vec<Complex64>,
    roots: Vec<Complex64>,
    /// Squared gain times both effective shapes: what a softer mode adds.
    weights: Vec<Complex64>,
    /// $H$ between the active rows.
    bare: Vec<Complex64>,
    system: Vec<Complex64>,
    /// $\mu$ for a unit force at the force's place and at the response's.
    states: [Vec<Complex64>; 2],
    /// What a unit force there puts on each active row.
    loads: [Vec<Complex64>; 2],
    /// Effective shapes.
    shapes: [Vec<Complex64>; 2],
}

/// A receptance with its derivative by $s$.
pub(super) struct Receptance {
    pub value: Complex64,
    pub by_s: Complex64,
}

impl Coupling {
    /// The receptance at $s$ between force (row 0) and response (row 1) of a view, and into `out` its derivatives.
    pub(super) fn line<T: Number>(
        &mut self,
        (layout, numbers): (&Layout, &[T]),
        zetas: &[f64],
        elements: &[ElementLine],
        columns: &Columns,
        s: Complex64,
        out: &mut [Complex64],
    ) -> Receptance {
        self.sum(layout, numbers, zetas, s);
        self.join(layout, elements);
        self.effective_shapes(layout, numbers);
        let mut value = self.bare[1];
        for (p, element) in elements.iter().enumerate() {
            value -= self.bare[layout.active + 2 + p] * element.pair[0] * self.states[0][p];
        }
        self.by_damping(layout, zetas, columns, s, out);
        for &(p, number, column, factor) in &columns.elements {
            out[column] += factor * self.change(elements, p, elements[p].by_numbers[number]);
        }
        self.by_structure((layout, numbers), zetas, columns, s, out);
        self.by_places((layout, numbers), columns, s, out);
        let zero = Complex64::ZERO;
        let by_s = if columns.frequency { self.by_frequency((layout, numbers), zetas, elements, s) } else { zero };
        Receptance { value, by_s }
    }

    /// Bare receptances between the active rows.
    fn sum<T: Number>(&mut self, layout: &Layout, numbers: &[T], zetas: &[f64], s: Complex64) {
        let n = layout.active;
        let s2 = s * s;
        self.bare.clear();
        self.bare.resize(n * n, Complex64::ZERO);
        self.gains.clear();
        self.roots.clear();
        // Horner in −s².
        for k in (0..SERIES_TERMS).rev() {
            let at = layout.series(k);
            for (total, &term) in self.bare.iter_mut().zip(&numbers[at..at + n * n]) {
                *total = term.into() - s2 * *total;
            }
        }
        for (m, &lambda) in numbers.iter().enumerate().take(layout.modes) {
            let root: Complex64 = lambda.root().into();
            let zeta = if m < layout.rigid { 0.0 } else { zetas[m - layout.rigid] };
            let gain = (s2 + 2.0 * zeta * root * s + lambda.into()).inv();
            self.gains.push(gain);
            self.roots.push(root);
            let shape = &numbers[layout.shape(m)..layout.shape(m) + n];
            for (a, &first) in shape.iter().enumerate() {
                let scaled = first * gain;
                for (b, &second) in shape.iter().enumerate().skip(a) {
                    self.bare[a * n + b] += second * scaled;
                }
            }
        }
        for a in 0..n {
            for b in 0..a {
                self.bare[a * n + b] = self.bare[b * n + a];
            }
        }
    }

    /// Solves for the elements' states.
    fn join(&mut self, layout: &Layout, elements: &[ElementLine]) {
        let (n, count) = (layout.active, elements.len());
        let width = count + 2;
        self.system.clear();
        for (p, row) in elements.iter().enumerate() {
            for (q, element) in elements.iter().enumerate() {
                let own = if p == q { row.pair[1] } else { Complex64::ZERO };
                self.system.push(own + self.bare[(2 + p) * n + 2 + q] * element.pair[0]);
            }
            self.system.extend([self.bare[(2 + p) * n], self.bare[(2 + p) * n + 1]]);
        }
        eliminate(&mut self.system, count);
        for side in 0..2 {
            self.states[side].clear();
            self.states[side].extend((0..count).map(|p| self.system[p * width + count + side]));
            self.loads[side].clear();
            self.loads[side].resize(2, Complex64::ZERO);
            self.loads[side][side] = Complex64::ONE;
            for (element, state) in elements.iter().zip(&self.states[side]) {
                self.loads[side].push(-element.pair[0] * state);
            }
        }
    }

    fn effective_shapes<T: Number>(&mut self, layout: &Layout, numbers: &[T]) {
        for (shapes, loads) in self.shapes.iter_mut().zip(&self.loads) {
            shapes.clear();
            for m in 0..layout.modes {
                let shape = &numbers[layout.shape(m)..layout.shape(m) + layout.active];
                shapes.push(shape.iter().zip(loads).map(|(&value, &load)| value * load).sum());
            }
        }
        let [forced, seen] = &self.shapes;
        self.weights.clear();
        self.weights.extend(self.gains.iter().zip(forced).zip(seen).map(|((gain, f), r)| gain * gain * f * r));
    }

    /// Derivatives by the damping ratios.
    fn by_damping(&self, layout: &Layout, zetas: &[f64], columns: &Columns, s: Complex64, out: &mut [Complex64]) {
        for (i, zeta) in zetas.iter().enumerate().take(columns.zetas.1) {
            let m = layout.rigid + i;
            out[columns.zetas.0 + i] -= self.weights[m] * (2.0 * zeta * self.roots[m] * s);
        }
    }

    /// The derivative by $s$.
    fn by_frequency<T: Number>(
        &self,
        (layout, numbers): (&Layout, &[T]),
        zetas: &[f64],
        elements: &[ElementLine],
        s: Complex64,
    ) -> Complex64 {
        let flexible = zetas.iter().zip(&self.roots[layout.rigid..]).zip(&self.weights[layout.rigid..]);
        let losses: Complex64 = flexible.map(|((zeta, root), weight)| 2.0 * zeta * root * weight).sum();
        let mut sum = -2.0 * s * self.weights.iter().sum::<Complex64>() - losses;
        let mut power = -2.0 * s;
        for k in 1..SERIES_TERMS {
            sum += k as f64 * power * self.form(&numbers[layout.series(k)..], layout.active);
            power *= -s * s;
        }
        sum + elements.iter().enumerate().map(|(p, element)| self.change(elements, p, element.by_s)).sum::<Complex64>()
    }

    /// $-\mu_r(B\,dA - A\,dB)\mu_f$ of element `p`.
    fn change(&self, elements: &[ElementLine], p: usize, by: [Complex64; 2]) -> Complex64 {
        let [a, b] = elements[p].pair;
        -self.states[0][p] * self.states[1][p] * (b * by[0] - a * by[1])
    }

    fn by_structure<T: Number>(
        &self,
        (layout, numbers): (&Layout, &[T]),
        zetas: &[f64],
        columns: &Columns,
        s: Complex64,
        out: &mut [Complex64],
    ) {
        let n = layout.active;
        for (p, &column) in columns.structure.iter().enumerate() {
            let mut sum = Complex64::ZERO;
            for m in 0..layout.modes {
                let gain = self.gains[m];
                let by = &numbers[layout.shape_by(p, m)..layout.shape_by(p, m) + n];
                let turned = |side: usize| -> Complex64 {
                    by.iter().zip(&self.loads[side]).map(|(&value, &load)| value * load).sum()
                };
                sum += gain * (turned(0) * self.shapes[1][m] + self.shapes[0][m] * turned(1));
                if m >= layout.rigid {
                    let stiffer = numbers[layout.by(p) + m] * (1.0 + zetas[m - layout.rigid] * s / self.roots[m]);
                    sum -= stiffer * self.weights[m];
                }
            }
            let mut power = Complex64::ONE;
            for k in 0..SERIES_TERMS {
                sum += power * self.form(&numbers[layout.series_by(p, k)..], n);
                power *= -s * s;
            }
            out[column] += sum;
        }
    }

    fn by_places<T: Number>(
        &self,
        (layout, numbers): (&Layout, &[T]),
        columns: &Columns,
        s: Complex64,
        out: &mut [Complex64],
    ) {
        let n = layout.active;
        for (slope, &(row, column)) in columns.places.iter().enumerate() {
            let at = n + slope;
            // Slope of the motion at that row under a unit force at either side.
            let [forced, seen] = [0, 1].map(|side| {
                let modes: Complex64 = (0..layout.modes)
                    .map(|m| numbers[layout.shape(m) + at] * (self.gains[m] * self.shapes[side][m]))
                    .sum();
                let mut power = Complex64::ONE;
                let mut rest = Complex64::ZERO;
                for k in 0..SERIES_TERMS {
                    let line = &numbers[layout.series(k) + at * n..layout.series(k) + (at + 1) * n];
                    let still: Complex64 = line.iter().zip(&self.loads[side]).map(|(&value, &load)| value * load).sum();
                    rest += power * still;
                    power *= -s * s;
                }
                modes + rest
            });
            out[column] += self.loads[0][row] * seen + self.loads[1][row] * forced;
        }
    }

    /// $u_r^TCu_f$ over the active rows.
    fn form<T: Number>(&self, matrix: &[T], n: usize) -> Complex64 {
        let [forced, seen] = &self.loads;
        let line = |a: usize| -> Complex64 {
            matrix[a * n..(a + 1) * n].iter().zip(forced).map(|(&value, &load)| value * load).sum()
        };
        seen.iter().enumerate().map(|(a, load)| load * line(a)).sum()
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
