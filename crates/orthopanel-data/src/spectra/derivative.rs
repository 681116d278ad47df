//! Derivatives of sampled signals, so that velocities and displacements become accelerations.

/// Samples to either side that a derivative is taken from.
const REACH: usize = 64;

/// Shape of the Kaiser window over the exact kernel, which never ends: the error is below 1e-5 of the derivative up to 0.8 of half the
/// sampling rate, where anti-alias filters have long begun.
const KAISER: f64 = 16.0;

/// The derivative of a signal at each of its samples, at a sampling rate \[Hz\].
///
/// That of the band-limited signal, $\sum_k (-1)^{k+1} w_k (x_{n+k} - x_{n-k}) f_s/k$, without delay. Beyond its ends a signal goes on
/// as its mirror image through the last sample.
pub(super) fn derivative(values: &[f64], rate: f64) -> Vec<f64> {
    let Some(last) = values.len().checked_sub(1) else { return Vec::new() };
    let reach = REACH.min(last);
    let mirrored = |edge: f64, inside: f64| 2.0 * edge - inside;
    let (first_value, last_value) = (values[0], values[last]);
    let before = (1..=reach).rev().map(|k| mirrored(first_value, values[k]));
    let after = (1..=reach).map(|k| mirrored(last_value, values[last - k]));
    let extended: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
    let kernel = kernel(reach);
    let at = |n: usize| {
        let differences = kernel.iter().zip(1..).map(|(weight, k)| weight * (extended[n + k] - extended[n - k]));
        rate * differences.sum::<f64>()
    };
    (reach..reach + values.len()).map(at).collect()
}

/// Weights of the differences over 1, 2, ... samples to either side, scaled so that a straight line's slope is exact.
fn kernel(reach: usize) -> Vec<f64> {
    let beyond = (reach + 1) as f64;
    let weight = |k: usize| {
        let sign = if k % 2 == 1 { 1.0 } else { -1.0 };
        let place = k as f64 / beyond;
        sign / k as f64 * bessel_i0(KAISER * (1.0 - place * place).sqrt()) / bessel_i0(KAISER)
    };
    let weights: Vec<f64> = (1..=reach).map(weight).collect();
    let slope: f64 = weights.iter().zip(1..).map(|(weight, k)| 2.0 * f64::from(k) * weight).sum();
    weights.into_iter().map(|weight| weight / slope).collect()
}

/// Modified Bessel function of the first kind, order 0, by its series.
fn bessel_i0(x: f64) -> f64 {
    let quarter = x * x / 4.0;
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        let k = f64::from(k);
        term *= quarter / (k * k);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the derivative by hand, away from the ends, from a hundredth to 0.8 of half the rate.
    #[test]
    fn val_sines_are_differentiated() {
        let rate = 1000.0;
        for frequency in [5.0, 50.0, 200.0, 350.0, 400.0] {
            let omega = std::f64::consts::TAU * frequency;
            let signal: Vec<f64> = (0..1000).map(|n| (omega * f64::from(n) / rate).sin()).collect();
            let found = derivative(&signal, rate);
            for (n, found) in found.iter().enumerate().take(800).skip(200) {
                let due = omega * (omega * n as f64 / rate).cos();
                assert!((found - due).abs() < 1e-5 * omega, "{frequency} Hz: {found} for {due}");
            }
        }
    }

    #[test]
    fn val_lines_keep_their_slope_to_the_ends_and_short_signals_do_no_harm() {
        let line: Vec<f64> = (0..300).map(|n| 2.0 + 0.5 * f64::from(n)).collect();
        assert!(derivative(&line, 10.0).iter().all(|slope| (slope - 5.0).abs() < 1e-9));
        assert_eq!(derivative(&[], 1.0), [0.0; 0]);
        assert_eq!(derivative(&[3.0], 1.0), [0.0]);
        assert_eq!(derivative(&[0.0, 1.0], 1.0).len(), 2);
    }
}
