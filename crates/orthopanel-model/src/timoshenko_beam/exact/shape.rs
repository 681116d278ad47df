//! Shape of one mode (eq. 10), mass-normalised (eq. 18), and its energies in closed form.

use super::end_conditions::{Family, mixed_rows, vanishing};
use super::waves::{Field, Fields, Ratios, Waves};
use crate::Boundary;

/// A combination of the four waves at one frequency, in units of $a$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WaveShape {
    waves: Waves,
    even: [f64; 2],
    odd: [f64; 2],
}

/// $\int\bar w^2$, $\int\psi^2$, $\int\psi'^2$ and $\int(\bar w'+\psi)^2$ over $\xi$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Integrals {
    pub deflection: f64,
    pub rotation: f64,
    pub moment: f64,
    pub shear: f64,
}

impl WaveShape {
    /// The combination that meets the end conditions at a natural frequency.
    pub(super) fn of_mode(ratios: Ratios, boundary: Boundary, family: Family, mu: f64) -> Self {
        let waves = Waves::at(ratios, mu);
        let ends = Fields::at(&waves, 0.5);
        let (even, odd) = match family {
            Family::Even => (pair_amplitudes(&ends.even, vanishing(boundary.left)), [0.0; 2]),
            Family::Odd => ([0.0; 2], pair_amplitudes(&ends.odd, vanishing(boundary.left))),
            Family::Mixed => {
                let [a, b, c, d] = null_vector(mixed_rows(&ends, boundary));
                ([a, b], [c, d])
            }
        };
        Self { waves, even, odd }
    }

    /// Deflection, rotation, moment and shear strain at $\xi$.
    pub(super) fn field(&self, xi: f64) -> Field {
        let fields = Fields::at(&self.waves, xi);
        let mut sum = [0.0; 4];
        let parts = [(&fields.even, self.even), (&fields.odd, self.odd)];
        for (pair, amplitudes) in parts {
            for (wave, amplitude) in pair.iter().zip(amplitudes) {
                for (total, value) in sum.iter_mut().zip(wave) {
                    *total += amplitude * value;
                }
            }
        }
        sum
    }

    /// Energies over the whole length. Even and odd parts do not mix in any of them.
    pub(super) fn integrals(&self) -> Integrals {
        let Waves { alpha, beta2, m1, m2, shear, .. } = self.waves;
        let products = WaveProducts::of(&self.waves);
        let (even, odd) = (self.even, self.odd);
        let weighted = |[a, b]: [f64; 2], on: [f64; 2]| [a * on[0], b * on[1]];
        Integrals {
            deflection: products.cosines(even) + products.sines(weighted(odd, [1.0, beta2])),
            rotation: products.sines(weighted(even, [m1 / alpha, -m2]))
                + products.cosines(weighted(odd, [-m1 / alpha, -m2])),
            moment: products.cosines(weighted(even, [m1, -m2])) + products.sines(weighted(odd, [m1, -m2 * beta2])),
            shear: products.sines(weighted(even, [-shear / alpha, -shear]))
                + products.cosines(weighted(odd, [shear / alpha, -shear])),
        }
    }

    /// The same shape times `factor`.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        for amplitude in self.even.iter_mut().chain(&mut self.odd) {
            *amplitude *= factor;
        }
        self
    }
}

/// Integrals over $|\xi| \le 1/2$ of products of $\cos\alpha\xi$, $\cosh\beta\xi$ and of $\sin\alpha\xi$,
/// $\sinh(\beta\xi)/\beta$.
struct WaveProducts {
    cosine: [f64; 3],
    sine: [f64; 3],
}

impl WaveProducts {
    fn of(waves: &Waves) -> Self {
        let Waves { alpha, beta2, beta, .. } = *waves;
        let (cosh, sinh) = waves.second_wave(0.5);
        let (sin, cos) = (0.5 * alpha).sin_cos();
        // cosh² − sinh² in the scale of `second_wave`.
        let unit = if beta2 > 0.0 { 4.0 * (-beta).exp() / (1.0 + (-beta).exp()).powi(2) } else { 1.0 };
        let sinh_squared = if beta2.abs() < 1e-2 {
            // The closed form cancels here; the series is exact to rounding.
            let series = [1.0 / 12.0, 1.0 / 240.0, 1.0 / 10_080.0, 1.0 / 725_760.0];
            unit * series.iter().rev().fold(0.0, |sum, term| sum * beta2 + term)
        } else {
            (cosh * sinh - 0.5 * unit) / beta2
        };
        let sum_of_squares = waves.m1 + waves.m2;
        let swing = alpha.sin() / (2.0 * alpha);
        Self {
            cosine: [
                0.5 + swing,
                2.0 * (alpha * sin * cosh + beta2 * cos * sinh) / sum_of_squares,
                0.5 * unit + cosh * sinh,
            ],
            sine: [0.5 - swing, 2.0 * (sin * cosh - alpha * cos * sinh) / sum_of_squares, sinh_squared],
        }
    }

    /// $\int(p\cos\alpha\xi + q\cosh\beta\xi)^2$.
    fn cosines(&self, amplitudes: [f64; 2]) -> f64 {
        quadratic(self.cosine, amplitudes)
    }

    /// $\int(p\sin\alpha\xi + q\sinh(\beta\xi)/\beta)^2$.
    fn sines(&self, amplitudes: [f64; 2]) -> f64 {
        quadratic(self.sine, amplitudes)
    }
}

fn quadratic([first, mixed, second]: [f64; 3], [p, q]: [f64; 2]) -> f64 {
    p * p * first + 2.0 * p * q * mixed + q * q * second
}

/// Amplitudes of the two waves of one parity for which both quantities vanish at the end.
fn pair_amplitudes(pair: &[Field; 2], vanishing: [usize; 2]) -> [f64; 2] {
    let rows = vanishing.map(|quantity| [pair[0][quantity], pair[1][quantity]]);
    let candidate = |row: [f64; 2]| [row[1], -row[0]];
    let misfit = |row: [f64; 2], [p, q]: [f64; 2]| {
        let size = (row[0] * p).abs() + (row[1] * q).abs();
        if size > 0.0 { (row[0] * p + row[1] * q).abs() / size } else { f64::INFINITY }
    };
    let (first, second) = (candidate(rows[0]), candidate(rows[1]));
    // Either row gives the amplitudes, unless it is nothing but rounding; then the other row shows it.
    let zero = |[p, q]: [f64; 2]| p == 0.0 && q == 0.0;
    let chosen = if zero(second) || (!zero(first) && misfit(rows[1], first) <= misfit(rows[0], second)) {
        first
    } else {
        second
    };
    let size = chosen[0].abs().max(chosen[1].abs());
    if size > 0.0 { chosen.map(|amplitude| amplitude / size) } else { [1.0, 0.0] }
}

/// A vector that all four rows send to zero, as nearly as the rows allow: elimination with full pivoting.
fn null_vector(mut rows: [[f64; 4]; 4]) -> [f64; 4] {
    for row in &mut rows {
        let size = row.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        if size > 0.0 {
            row.iter_mut().for_each(|value| *value /= size);
        }
    }
    let mut columns = [0, 1, 2, 3];
    for step in 0..3 {
        let (mut best, mut at) = (-1.0, (step, step));
        for (i, row) in rows.iter().enumerate().skip(step) {
            for (j, &column) in columns.iter().enumerate().skip(step) {
                if row[column].abs() > best {
                    (best, at) = (row[column].abs(), (i, j));
                }
            }
        }
        rows.swap(step, at.0);
        columns.swap(step, at.1);
        let pivot_row = rows[step];
        let pivot = pivot_row[columns[step]];
        if pivot == 0.0 {
            break;
        }
        for row in rows.iter_mut().skip(step + 1) {
            let factor = row[columns[step]] / pivot;
            for (value, above) in row.iter_mut().zip(pivot_row) {
                *value -= factor * above;
            }
        }
    }
    let mut solution = [0.0; 4];
    solution[columns[3]] = 1.0;
    for step in (0..3).rev() {
        let known: f64 = (step + 1..4).map(|j| rows[step][columns[j]] * solution[columns[j]]).sum();
        let pivot = rows[step][columns[step]];
        solution[columns[step]] = if pivot == 0.0 { 0.0 } else { -known / pivot };
    }
    solution
}
