//! What a force on a panel presses on, and what stands on it: a square foot.

use super::edge_basis::EdgeBasis;
use super::field::Field;

/// Side of what stands on a panel \[m\]: a stud, an accelerometer. Twice as much changes $R(0)$ by $\ln2/2\pi\sqrt{A_{44}A_{55}}$.
pub(crate) const FOOT: f64 = 0.01;

/// Values of the functions of deflection along one side, in the mean over a foot about a place, between edges half a side from the middle: by Gauss'
/// two points, exact to the third degree.
pub(super) fn mean_over_foot(basis: &EdgeBasis, (place, half): (f64, f64)) -> Vec<f64> {
    let [before, after] = gauss_points(place, half).map(|place| basis.values_at(Field::Deflection, place));
    before.iter().zip(after).map(|(before, after)| 0.5 * (before + after)).collect()
}

/// Gauss' two points of a foot along one side.
pub(super) fn gauss_points(place: f64, half: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|side| (place + side * 0.5 * FOOT / 3.0_f64.sqrt()).clamp(-half, half))
}
