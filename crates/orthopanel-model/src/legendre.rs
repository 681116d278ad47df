//! Legendre polynomials $P_n$ on $[-1, 1]$.

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
