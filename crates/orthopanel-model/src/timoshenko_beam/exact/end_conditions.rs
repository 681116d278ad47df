//! Frequency equation and number of modes below a frequency, for each pair of ends.
//!
//! The number is that of Wittrick and Williams: with end coordinates held, a count known in closed form; freeing a
//! coordinate adds one where the dynamic stiffness along it is negative. We start from the beam pinned at both ends,
//! whose count is [`Waves::pinned_counts`], and clamp or free from there. Equal ends split into deflections even and
//! odd in $x$; there each step is one sign.

use super::waves::{DEFLECTION, Field, Fields, MOMENT, ROTATION, Ratios, SHEAR, Waves, even_fields, odd_fields};
use crate::{Boundary, End};

/// Which deflections a search looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    /// $w(-x) = w(x)$; only where both ends are held alike.
    Even,
    /// $w(-x) = -w(x)$; only where both ends are held alike.
    Odd,
    /// All, where the ends differ.
    Mixed,
}

/// The families into which the modes of a boundary split.
pub(super) fn families(boundary: Boundary) -> &'static [Family] {
    if boundary.left == boundary.right { &[Family::Even, Family::Odd] } else { &[Family::Mixed] }
}

/// The quantities that vanish at an end.
pub(super) fn vanishing(end: End) -> [usize; 2] {
    match end {
        End::Free => [MOMENT, SHEAR],
        End::Pinned => [DEFLECTION, MOMENT],
        End::Clamped => [DEFLECTION, ROTATION],
    }
}

/// What the waves at one frequency say about a family of modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Probe {
    /// Modes of the family at lower frequencies, rigid ones included.
    pub below: usize,
    /// Left side of the frequency equation: zero at each natural frequency, and without poles.
    pub residual: f64,
}

/// $a_ib_j - a_jb_i$ of the two waves of one parity, for quantities `i` and `j`.
fn minor(pair: &[Field; 2], i: usize, j: usize) -> f64 {
    pair[0][i] * pair[1][j] - pair[0][j] * pair[1][i]
}

/// Dynamic stiffness of one end coordinate in one parity: `numerator / denominator`.
fn stiffness(pair: &[Field; 2], force: usize, held: usize, coordinate: usize) -> f64 {
    minor(pair, force, held) / minor(pair, coordinate, held)
}

/// Whether that stiffness is negative: by the signs, since at a frequency of the end that the coordinate holds the denominator is zero.
fn yields(pair: &[Field; 2], force: usize, held: usize, coordinate: usize) -> bool {
    let (numerator, denominator) = (minor(pair, force, held), minor(pair, coordinate, held));
    numerator != 0.0 && numerator.is_sign_negative() != denominator.is_sign_negative()
}

/// Looks at a family at $\mu$.
pub(super) fn probe(ratios: Ratios, boundary: Boundary, family: Family, mu: f64) -> Probe {
    let waves = Waves::at(ratios, mu);
    let [even, odd] = waves.pinned_counts();
    match family {
        Family::Even => probe_parity(&even_fields(&waves, 0.5), boundary.left, even),
        Family::Odd => probe_parity(&odd_fields(&waves, 0.5), boundary.left, odd),
        Family::Mixed => {
            let ends = Fields::at(&waves, 0.5);
            let below = mixed_count(ratios, &ends, boundary, even + odd);
            Probe { below, residual: mixed_residual(&ends, boundary) }
        }
    }
}

/// The change of the count from pinned ends, and eq. 11's factor or its like.
fn probe_parity(pair: &[Field; 2], end: End, pinned: usize) -> Probe {
    let [i, j] = vanishing(end);
    let below = match end {
        End::Pinned => pinned,
        // Deflection set free, moment zero: one more where the force resists with a negative stiffness.
        End::Free => pinned + usize::from(yields(pair, SHEAR, MOMENT, DEFLECTION)),
        // Rotation clamped, deflection zero: the reverse step.
        End::Clamped => pinned - usize::from(yields(pair, MOMENT, DEFLECTION, ROTATION)).min(pinned),
    };
    Probe { below, residual: minor(pair, i, j) }
}

/// The count where the ends differ. With both parities the coordinate of one end alone carries the mean of the
/// stiffnesses of both.
fn mixed_count(ratios: Ratios, ends: &Fields, boundary: Boundary, pinned: usize) -> usize {
    let pairs = [&ends.even, &ends.odd];
    let clamped = |pair| stiffness(pair, MOMENT, DEFLECTION, ROTATION);
    let yielding = || pairs.iter().filter(|pair| yields(pair, MOMENT, DEFLECTION, ROTATION)).count();
    let clamped_count = || pinned - yielding().min(pinned);
    match (boundary.left, boundary.right) {
        (End::Free, End::Pinned) | (End::Pinned, End::Free) => {
            let sum: f64 = pairs.iter().map(|pair| stiffness(pair, SHEAR, MOMENT, DEFLECTION)).sum();
            pinned + usize::from(sum < 0.0)
        }
        (End::Clamped, End::Pinned) | (End::Pinned, End::Clamped) => {
            let sum: f64 = pairs.iter().map(|pair| clamped(pair)).sum();
            clamped_count() + usize::from(sum < 0.0)
        }
        _ => clamped_count() + negative_eigenvalues(end_stiffness(ratios, ends)),
    }
}

/// Sum over both parities of the stiffness of (deflection, rotation) at one end, the other end clamped, in units of
/// $EI$ and $a$: the force is the shear strain over $s^2$.
fn end_stiffness(ratios: Ratios, ends: &Fields) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for pair in [&ends.even, &ends.odd] {
        let determinant = minor(pair, DEFLECTION, ROTATION);
        sum[0] += minor(pair, SHEAR, ROTATION) / determinant / ratios.s2;
        sum[1] += minor(pair, MOMENT, ROTATION) / determinant;
        sum[2] += minor(pair, DEFLECTION, MOMENT) / determinant;
    }
    sum
}

/// Negative eigenvalues of $\begin{bmatrix}p&q\\\\q&r\end{bmatrix}$.
fn negative_eigenvalues([p, q, r]: [f64; 3]) -> usize {
    // Sylvester: the signs of the pivots.
    usize::from(p < 0.0) + usize::from(r - q * (q / p) < 0.0)
}

/// Determinant of the four end conditions over both parities, by Laplace's expansion in pairs of rows.
///
/// Rows: the two quantities at the right end, the two at the left. At the left, deflection and moment of the odd
/// waves and rotation and shear of the even ones change sign.
fn mixed_residual(ends: &Fields, boundary: Boundary) -> f64 {
    let rows = mixed_rows(ends, boundary);
    let two = |i: usize, j: usize, column: usize| {
        rows[i][column] * rows[j][column + 1] - rows[j][column] * rows[i][column + 1]
    };
    two(0, 1, 0) * two(2, 3, 2) - two(0, 2, 0) * two(1, 3, 2)
        + two(0, 3, 0) * two(1, 2, 2)
        + two(1, 2, 0) * two(0, 3, 2)
        - two(1, 3, 0) * two(0, 2, 2)
        + two(2, 3, 0) * two(0, 1, 2)
}

/// The end conditions as rows over the amplitudes (even, even, odd, odd).
pub(super) fn mixed_rows(ends: &Fields, boundary: Boundary) -> [[f64; 4]; 4] {
    let row = |quantity: usize, left: bool| {
        let odd_in_x = matches!(quantity, ROTATION | SHEAR);
        let (even_sign, odd_sign) = match (left, odd_in_x) {
            (false, _) => (1.0, 1.0),
            (true, false) => (1.0, -1.0),
            (true, true) => (-1.0, 1.0),
        };
        [
            even_sign * ends.even[0][quantity],
            even_sign * ends.even[1][quantity],
            odd_sign * ends.odd[0][quantity],
            odd_sign * ends.odd[1][quantity],
        ]
    };
    let ([right_1, right_2], [left_1, left_2]) = (vanishing(boundary.right), vanishing(boundary.left));
    [row(right_1, false), row(right_2, false), row(left_1, true), row(left_2, true)]
}
