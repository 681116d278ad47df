//! Legendre polynomials $P_n$ on $[-1, 1]$.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use faer::Mat;

/// $P_0(t), \dots, P_{count-1}(t)$ by the three-term recurrence.
pub(crate) fn legendre(count: usize, t: f64) -> Vec<f64> {
    let mut values = Vec::with_capacity(count);
    let (mut current, mut previous) = (1.0, 0.0);
    for n in 0..count {
        values.push(current);
        let degree = n as f64;
        let next = ((2.0 * degree + 1.0) * t * current - degree * previous) / (degree + 1.0);
        (previous, current) = (current, next);
    }
    values
}

/// The same at many points: a row a point, a column a polynomial.
pub(crate) fn legendre_at(count: usize, points: &[f64]) -> Mat<f64> {
    let mut values = Mat::zeros(points.len(), count);
    let (mut current, mut previous) = (vec![1.0; points.len()], vec![0.0; points.len()]);
    for n in 0..count {
        values.col_as_slice_mut(n).copy_from_slice(&current);
        let degree = n as f64;
        let (ahead, behind) = ((2.0 * degree + 1.0) / (degree + 1.0), degree / (degree + 1.0));
        for ((current, previous), t) in current.iter_mut().zip(&mut previous).zip(points) {
            (*previous, *current) = (*current, ahead * t * *current - behind * *previous);
        }
    }
    values
}

/// $\int_{-1}^{1}P_n^2\,dt = 2/(2n+1)$.
pub(crate) fn norm(n: usize) -> f64 {
    2.0 / (2 * n + 1) as f64
}

/// Legendre coefficients of an antiderivative of $\sum c_nP_n$: that which adds no constant of its own and,
/// for $n \ge 1$, vanishes at both ends, $\int P_n = (P_{n+1}-P_{n-1})/(2n+1)$.
pub(crate) fn antiderivative(coefficients: &[f64]) -> Vec<f64> {
    let mut integral = vec![0.0; coefficients.len() + 1];
    for (n, &coefficient) in coefficients.iter().enumerate() {
        let share = coefficient / (2 * n + 1) as f64;
        integral[n + 1] += share;
        if n > 0 {
            integral[n - 1] -= share;
        }
    }
    integral
}

/// Points and weights.
pub(crate) type Rule = Arc<[(f64, f64)]>;

/// Points and weights of Gauss and Legendre on $[-1, 1]$: exact for polynomials of degree $2\,\text{count}-1$.
pub(crate) fn gauss_legendre(count: usize) -> Rule {
    // A search assembles thousands of uneven beams with one rule.
    static KNOWN: Mutex<BTreeMap<usize, Rule>> = Mutex::new(BTreeMap::new());
    let Ok(mut known) = KNOWN.lock() else { return solved_rule(count) };
    Arc::clone(known.entry(count).or_insert_with(|| solved_rule(count)))
}

fn solved_rule(count: usize) -> Rule {
    let n = count as f64;
    let point = |i: usize| {
        let mut t = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's steps double the digits: five pass any count.
        for _ in 0..8 {
            let values = legendre(count + 1, t);
            let [Some(before), Some(value)] = [values.get(count - 1), values.get(count)] else { break };
            slope = n * (before - t * value) / (1.0 - t * t);
            t -= value / slope;
        }
        (t, 2.0 / ((1.0 - t * t) * slope * slope))
    };
    (0..count).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_gauss_legendre_integrates_powers() {
        for count in [1, 2, 5, 61] {
            for power in (0..2 * count).step_by(2) {
                let sum: f64 = gauss_legendre(count).iter().map(|(t, weight)| weight * t.powi(power as i32)).sum();
                assert!((sum - 2.0 / (power as f64 + 1.0)).abs() < 1e-13, "{count} points, power {power}: {sum}");
            }
        }
    }
}
