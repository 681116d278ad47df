//! Waves between two edges, their means over a foot and their moments with polynomials.

use super::foot::FOOT;
use crate::End;

/// A wave between two edges, with one for the integral of its square.
#[derive(Debug, Clone)]
pub(super) struct WaveBetween {
    /// $k$.
    pub(super) number: f64,
    /// Where its sine or cosine is one; and of its mean over a foot there.
    pub(super) at_point: f64,
    pub(super) largest: f64,
    pub(super) from_held: bool,
}

impl WaveBetween {
    pub(super) fn new(m: usize, size: f64, edges: [End; 2]) -> Self {
        let held = edges.map(|end| end != End::Free);
        // Half-waves of the first.
        let first = match held {
            [false, false] => 0.0,
            [true, true] => 1.0,
            _ => 0.5,
        };
        let number = std::f64::consts::PI * (m as f64 + first) / size;
        let half = 0.5 * number * FOOT;
        let at_point = if number > 0.0 { (2.0 / size).sqrt() } else { size.sqrt().recip() };
        let largest = if number > 0.0 { at_point * half.sin() / half } else { at_point };
        Self { number, at_point, largest, from_held: held[0] }
    }

    pub(super) fn square(&self) -> f64 {
        self.number * self.number
    }

    /// The mean over a foot, or of its first derivative, at a place from the first edge on.
    pub(super) fn over_foot(&self, order: usize, from_edge: f64) -> f64 {
        let (sin, cos) = (self.number * from_edge).sin_cos();
        let shape = match (order, self.from_held) {
            (0, true) => sin,
            (0, false) => cos,
            (_, true) => self.number * cos,
            (_, false) => -self.number * sin,
        };
        self.largest * shape
    }

    /// Its moment with the Legendre polynomial $p_n$ that is normalised on a side, about a middle from the first edge on with this half length $h$, or that of
    /// its first derivative: $\int p_ne^{ikx}dx = \sqrt{2(2n+1)h}\,i^nj_n(kh)e^{ikx_0}$.
    pub(super) fn moment(&self, order: usize, ([middle, half], degree): ([f64; 2], usize)) -> f64 {
        let (sin, cos) = (self.number * middle).sin_cos();
        // Of i^n e^{ikx}, times ik of a derivative.
        let turns = degree + order;
        let [real, imaginary] = match turns % 4 {
            0 => [cos, sin],
            1 => [-sin, cos],
            2 => [-cos, -sin],
            _ => [sin, -cos],
        };
        let shape = if self.from_held { imaginary } else { real };
        let size = (2.0 * (2.0 * degree as f64 + 1.0) * half).sqrt() * spherical_bessel(degree, self.number * half);
        self.at_point * shape * size * if order == 0 { 1.0 } else { self.number }
    }
}

/// $j_n(x)$ for $x \ge 0$.
fn spherical_bessel(degree: usize, x: f64) -> f64 {
    // Upward it is as good as the first two from its degree on, and below that a series converges at once.
    if x < degree as f64 + 1.0 {
        let first: f64 = (1..=degree).map(|n| x / (2.0 * n as f64 + 1.0)).product();
        let (mut term, mut sum) = (first, 0.0);
        for k in 1.. {
            sum += term;
            if term.abs() <= f64::EPSILON * sum.abs() {
                break;
            }
            term *= -0.5 * x * x / (k as f64 * (2.0 * (degree + k) as f64 + 1.0));
        }
        return sum;
    }
    let (sin, cos) = x.sin_cos();
    let (mut before, mut own) = (cos / x, sin / x);
    for n in 0..degree {
        (before, own) = (own, (2.0 * n as f64 + 1.0) / x * own - before);
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::legendre::legendre;

    /// Moments of waves, and of their slopes, by a sum over small steps.
    #[test]
    fn val_moments_of_waves_are_those_of_a_sum() {
        let (size, side) = (1.2, [0.47, 0.04]);
        let steps = 20_000_u32;
        for ends in [[End::Free; 2], [End::Clamped; 2], [End::Clamped, End::Free], [End::Free, End::Clamped]] {
            for (m, degree, order) in [(0, 0, 0), (1, 1, 0), (5, 2, 1), (40, 3, 0), (40, 3, 1), (200, 1, 1), (3, 3, 1)]
            {
                let wave = WaveBetween::new(m, size, ends);
                let value = |from_edge: f64| {
                    let (sin, cos) = (wave.number * from_edge).sin_cos();
                    let [shape, slope] = if wave.from_held { [sin, cos] } else { [cos, -sin] };
                    wave.at_point * if order == 0 { shape } else { wave.number * slope }
                };
                let of_step = |step: u32| {
                    let t = 2.0 * (f64::from(step) + 0.5) / f64::from(steps) - 1.0;
                    let polynomial = ((degree as f64 + 0.5) / side[1]).sqrt() * legendre(degree + 1, t)[degree];
                    polynomial * value(side[0] + side[1] * t) * 2.0 * side[1] / f64::from(steps)
                };
                let sum: f64 = (0..steps).map(of_step).sum();
                let moment = wave.moment(order, (side, degree));
                assert!((moment - sum).abs() < 1e-6 * (1.0 + wave.number), "{m} {degree} {order}: {moment} {sum}");
            }
        }
    }
}
