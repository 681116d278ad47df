//! Lines far from every pole, where the accelerance is smooth, taken together.

use std::ops::Range;

use faer::MatMut;
use num_complex::Complex64;

/// Groups of neighbouring lines and, of each, the few combinations that are kept.
///
/// The combinations are an orthonormal basis of weighted parabolas over a group. Data and model are projected alike, so
/// nothing is approximated: what the projection drops is information that a smooth function does not carry, and noise.
#[derive(Debug, Clone)]
pub(super) struct LineGroups {
    groups: Vec<Group>,
    rows: usize,
}

#[derive(Debug, Clone)]
struct Group {
    lines: Range<usize>,
    /// One row a combination; empty where each line is kept by itself.
    basis: Vec<Vec<f64>>,
}

/// Combinations kept of a group: a parabola.
const KEPT: usize = 3;
/// Longest group, over the distance to the nearest pole: $1/(s-\lambda)$ then leaves a parabola by $10^{-3}$ of its size.
pub(super) const REACH: f64 = 0.5;

impl LineGroups {
    /// For lines with these weights, with the distance in lines from each to what is not smooth.
    pub(super) fn new(weight: &[f64], distance: impl Fn(usize) -> f64) -> Self {
        let (mut groups, mut rows, mut from) = (vec![], 0, 0);
        while from < weight.len() {
            let length = (REACH * distance(from)) as usize;
            // A group that begins far from a pole must not reach near it.
            let fits = |length: usize| length as f64 <= REACH * distance((from + length).min(weight.len() - 1)) + 1.0;
            let length = (1..=length.max(1)).rev().find(|&length| fits(length)).unwrap_or(1);
            let lines = from..(from + length).min(weight.len());
            from = lines.end;
            let basis = if lines.len() > KEPT { parabolas(&weight[lines.clone()]) } else { vec![] };
            rows += if basis.is_empty() { lines.len() } else { basis.len() };
            groups.push(Group { lines, basis });
        }
        Self { groups, rows: 2 * rows }
    }

    /// Real rows kept.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Writes what is kept of a complex function of the lines, real parts first.
    pub(super) fn project(&self, weight: &[f64], mut column: MatMut<'_, f64>, of_line: impl Fn(usize) -> Complex64) {
        let (mut row, half) = (0, self.rows / 2);
        let mut write = |value: Complex64| {
            column[(row, 0)] = value.re;
            column[(row + half, 0)] = value.im;
            row += 1;
        };
        for Group { lines, basis } in &self.groups {
            let weighted = |line: usize| weight[line] * of_line(line);
            if basis.is_empty() {
                lines.clone().map(weighted).for_each(&mut write);
                continue;
            }
            let mut kept = [Complex64::ZERO; KEPT];
            for (index, line) in lines.clone().enumerate() {
                let value = weighted(line);
                kept.iter_mut().zip(basis).for_each(|(sum, combination)| *sum += combination[index] * value);
            }
            kept.iter().take(basis.len()).for_each(|value| write(*value));
        }
    }
}

/// Orthonormal combinations that hold every weighted parabola.
fn parabolas(weight: &[f64]) -> Vec<Vec<f64>> {
    let middle = 0.5 * (weight.len() - 1) as f64;
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(KEPT);
    for power in 0..KEPT as i32 {
        let of_line = |(k, g): (usize, &f64)| g * ((k as f64 - middle) / middle).powi(power);
        let mut row: Vec<f64> = weight.iter().enumerate().map(of_line).collect();
        // Twice is enough (Kahan).
        for _ in 0..2 {
            for earlier in &basis {
                let part: f64 = earlier.iter().zip(&row).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(earlier).for_each(|(a, b)| *a -= part * b);
            }
        }
        let norm = row.iter().map(|v| v * v).sum::<f64>().sqrt();
        if norm > 0.0 {
            row.iter_mut().for_each(|v| *v /= norm);
            basis.push(row);
        }
    }
    basis
}
