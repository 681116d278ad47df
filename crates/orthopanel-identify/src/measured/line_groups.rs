//! Lines far from every pole, where the accelerance is smooth, taken together.

use std::ops::Range;

use faer::MatMut;
use num_complex::Complex64;

/// Groups of neighbouring lines and, of each, the few combinations that are kept.
///
/// The combinations are an orthonormal basis of weighted parabolas over a group. Data and model are projected alike: what the projection
/// drops is information that a smooth function does not carry, and noise. A function as smooth as a pole is from afar need not be known on
/// every line: [`LineGroups::nodes`] are enough.
#[derive(Debug, Clone)]
pub(super) struct LineGroups {
    groups: Vec<Group>,
    nodes: Vec<usize>,
    rows: usize,
}

#[derive(Debug, Clone)]
struct Group {
    lines: Range<usize>,
    /// One row a combination; empty where each line is kept by itself.
    basis: Vec<Vec<f64>>,
    /// The combinations of a function that is known on the group's nodes, a row each.
    of_nodes: Vec<Vec<f64>>,
}

impl Group {
    /// Combinations that are kept of it.
    fn rows(&self) -> usize {
        if self.basis.is_empty() { self.lines.len() } else { self.basis.len() }
    }
}

/// Nodes of a group that has more lines: through so many a polynomial meets $1/(s-\lambda)$ within $10^{-6}$ over a group.
const NODES: usize = 7;

/// Combinations kept of a group: a parabola.
const KEPT: usize = 3;
/// Longest group, over the distance to the nearest pole: $1/(s-\lambda)$ then leaves a parabola by $10^{-3}$ of its size.
pub(super) const REACH: f64 = 0.5;

impl LineGroups {
    /// For lines with these weights, with the distance in lines from each to what is not smooth.
    pub(super) fn new(weight: &[f64], distance: impl Fn(usize) -> f64) -> Self {
        let (mut groups, mut nodes, mut from) = (Vec::<Group>::new(), vec![], 0);
        while from < weight.len() {
            let length = (REACH * distance(from)) as usize;
            // A group that begins far from a pole must not reach near it.
            let fits = |length: usize| length as f64 <= REACH * distance((from + length).min(weight.len() - 1)) + 1.0;
            let length = (1..=length.max(1)).rev().find(|&length| fits(length)).unwrap_or(1);
            let lines = from..(from + length).min(weight.len());
            from = lines.end;
            let basis = if lines.len() > KEPT { parabolas(&weight[lines.clone()]) } else { vec![] };
            let own = if basis.is_empty() { lines.clone().collect() } else { nodes_of(&lines) };
            let of_nodes = by_nodes(&basis, &weight[lines.clone()], &own, lines.start);
            groups.push(Group { lines, basis, of_nodes });
            nodes.extend(own);
        }
        let rows = 2 * groups.iter().map(Group::rows).sum::<usize>();
        Self { groups, nodes, rows }
    }

    /// The lines on which a smooth function has to be known for [`LineGroups::project_smooth`].
    pub(super) fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// As [`LineGroups::project`], of a function that is known on the nodes, by their order.
    pub(super) fn project_smooth(&self, weight: &[f64], mut column: MatMut<'_, f64>, at_node: &[Complex64]) {
        let (mut row, mut node, half) = (0, 0, self.rows / 2);
        let mut write = |value: Complex64| {
            column[(row, 0)] = value.re;
            column[(row + half, 0)] = value.im;
            row += 1;
        };
        for Group { lines, of_nodes, .. } in &self.groups {
            let count = of_nodes.first().map_or(lines.len(), Vec::len);
            let own = &at_node[node..node + count];
            node += count;
            if of_nodes.is_empty() {
                lines.clone().zip(own).for_each(|(line, value)| write(weight[line] * value));
            }
            for combination in of_nodes {
                write(combination.iter().zip(own).map(|(factor, value)| factor * value).sum());
            }
        }
    }

    /// Real rows kept.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Real data among the rows where so many lines share one datum.
    pub(super) fn data(&self, per_datum: f64) -> f64 {
        let of_group = |group: &Group| (group.rows() as f64).min(group.lines.len() as f64 / per_datum);
        2.0 * self.groups.iter().map(of_group).sum::<f64>()
    }

    /// Writes what is kept of a complex function of the lines, real parts first.
    pub(super) fn project(&self, weight: &[f64], mut column: MatMut<'_, f64>, of_line: impl Fn(usize) -> Complex64) {
        let (mut row, half) = (0, self.rows / 2);
        let mut write = |value: Complex64| {
            column[(row, 0)] = value.re;
            column[(row + half, 0)] = value.im;
            row += 1;
        };
        for Group { lines, basis, .. } in &self.groups {
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

/// Lines near Chebyshev's points of a group, the ends among them.
fn nodes_of(lines: &Range<usize>) -> Vec<usize> {
    let last = lines.len() - 1;
    if last < NODES {
        return lines.clone().collect();
    }
    let part = |node: usize| 0.5 - 0.5 * (std::f64::consts::PI * node as f64 / (NODES - 1) as f64).cos();
    let mut nodes: Vec<usize> =
        (0..NODES).map(|node| lines.start + (part(node) * last as f64).round() as usize).collect();
    nodes.dedup();
    nodes
}

/// What each combination makes of the polynomial through a group's nodes, by the values there (barycentric formula: Berrut and Trefethen,
/// SIAM Rev. 46, 2004).
fn by_nodes(basis: &[Vec<f64>], weight: &[f64], nodes: &[usize], start: usize) -> Vec<Vec<f64>> {
    let mut of_nodes = vec![vec![0.0; nodes.len()]; basis.len()];
    let apart = |a: usize, b: usize| a as f64 - b as f64;
    let share = |&node: &usize| {
        let others = nodes.iter().filter(|other| **other != node);
        others.map(|other| apart(node, *other)).product::<f64>().recip()
    };
    let shares: Vec<f64> = nodes.iter().map(share).collect();
    let mut of_line = vec![0.0; nodes.len()];
    for (k, weight) in weight.iter().enumerate() {
        if let Some(on) = nodes.iter().position(|node| *node == start + k) {
            of_line.iter_mut().enumerate().for_each(|(node, part)| *part = if node == on { 1.0 } else { 0.0 });
        } else {
            let whole: f64 = nodes.iter().map(|node| apart(start + k, *node)).product();
            let parts = of_line.iter_mut().zip(nodes).zip(&shares);
            parts.for_each(|((part, node), share)| *part = whole * share / apart(start + k, *node));
        }
        for (of_nodes, combination) in of_nodes.iter_mut().zip(basis) {
            let factor = combination[k] * weight;
            of_nodes.iter_mut().zip(&of_line).for_each(|(sum, part)| *sum += factor * part);
        }
    }
    of_nodes
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

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;

    /// A pole that is as near as groups allow is projected from its nodes as from all lines.
    #[test]
    fn val_nodes_are_enough_for_a_pole() {
        let weight: Vec<f64> = (0..4000).map(|line| 1.0 + 0.5 * (0.003 * line as f64).sin()).collect();
        let pole = Complex64::new(-3.0, 700.3);
        let distance = |line: usize| (Complex64::new(0.0, line as f64) - pole).norm();
        let groups = LineGroups::new(&weight, distance);
        assert!(groups.nodes().len() < 1000, "{}", groups.nodes().len());
        for power in [1, 2] {
            let of_line = |line: usize| (Complex64::new(0.0, line as f64) - pole).powi(-power);
            let mut columns = Mat::zeros(groups.rows(), 2);
            groups.project(&weight, columns.col_mut(0).as_mat_mut(), of_line);
            let at_nodes: Vec<Complex64> = groups.nodes().iter().map(|line| of_line(*line)).collect();
            groups.project_smooth(&weight, columns.col_mut(1).as_mat_mut(), &at_nodes);
            let whole = columns.col(0).norm_l2();
            for row in 0..groups.rows() {
                let apart = (columns[(row, 0)] - columns[(row, 1)]).abs();
                assert!(apart < 1e-6 * whole, "power {power}, row {row}: {apart:e} of {whole:e}");
            }
        }
    }
}
