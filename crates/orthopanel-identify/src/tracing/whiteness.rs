//! How far the residuals are from white: neighbouring lines that err alike are no independent witnesses.

use num_complex::Complex64;

use super::fit::{Fit, LAST};
use super::records_of_test::TestRecords;
use crate::IdentifyError;
use crate::outcome::IndependentLines;

/// Most lines apart at which lines are compared.
const REACH: usize = 60;

/// What a fit misses of every record.
fn missed(records: &TestRecords, fit: &Fit) -> Result<Vec<Vec<Complex64>>, IdentifyError> {
    let problem = records.problem(LAST);
    let lines = problem.lines(&fit.state)?;
    let pairs = problem.records.iter().zip(lines);
    Ok(pairs.map(|(record, model)| record.value.iter().zip(model).map(|(a, b)| a - b).collect()).collect())
}

/// The residuals of every record at a fit, each over its noise.
pub(super) fn residuals(records: &TestRecords, fit: &Fit) -> Result<Vec<Vec<Complex64>>, IdentifyError> {
    let mut missed = missed(records, fit)?;
    for (record, missed) in records.problem(LAST).records.iter().zip(&mut missed) {
        missed.iter_mut().zip(&record.variance).for_each(|(missed, variance)| *missed /= variance.sqrt());
    }
    Ok(missed)
}

/// The same over the noise that lines do not share, without what they share: each real number has the deviation 1.
pub(super) fn whitened(records: &TestRecords, fit: &Fit) -> Result<Vec<Vec<Complex64>>, IdentifyError> {
    let missed = missed(records, fit)?;
    let whitened = records.problem(LAST).records.iter().zip(missed).map(|(record, missed)| {
        let noise = record.noise();
        let own = missed.iter().zip(&noise.weights).map(|(missed, weight)| weight * missed);
        let (mut re, mut im): (Vec<f64>, Vec<f64>) = own.map(|own| (own.re, own.im)).unzip();
        noise.whiten(0, [&mut re, &mut im]);
        re.into_iter().zip(im).map(|(re, im)| Complex64::new(re, im)).collect()
    });
    Ok(whitened.collect())
}

/// The part of the lines that counts as independent, $1/(1+2\sum_k\rho_k)$, from 0 to 1: $\rho_k$ is the correlation of
/// residuals $k$ lines apart, over all records, summed as long as it stands out of its own scatter.
///
/// The window $e^{-\sigma t}$ alone ties lines $\Delta$ apart by $2\sigma/(2\sigma + j2\pi\Delta)$.
pub(super) fn independent_part(residuals: &[Vec<Complex64>]) -> f64 {
    let lines: usize = residuals.iter().map(Vec::len).sum();
    let power: f64 = residuals.iter().flatten().map(Complex64::norm_sqr).sum();
    if power <= 0.0 {
        return 1.0;
    }
    let scatter = 1.0 / (lines.max(1) as f64).sqrt();
    let mut sum = 0.0;
    for apart in 1..=REACH {
        let pairs = residuals.iter().flat_map(|record| record.iter().zip(record.iter().skip(apart)));
        let correlation = pairs.map(|(a, b)| (a.conj() * b).re).sum::<f64>() / power;
        if correlation < 2.0 * scatter {
            break;
        }
        sum += correlation;
    }
    1.0 / (1.0 + 2.0 * sum)
}

/// How white the residuals of two fits are beside noise on the lines $s$ of every record.
///
/// Of the lines' power as much is independent as $1/(1+2\sum_k|\rho_k|^2)$ tells (Bartlett): unlike [`independent_part`] it is the same
/// whatever moment the phases count from.
pub(super) fn independent_lines(
    before: &[Vec<Complex64>],
    after: &[Vec<Complex64>],
    lines: &[Vec<Complex64>],
) -> IndependentLines {
    let [before, after] = [before, after].map(|residuals| {
        let power: f64 = residuals.iter().flatten().map(Complex64::norm_sqr).sum();
        if power > 0.0 && power.is_finite() { independent_power(residuals, |a, b| a.conj() * b / power) } else { 1.0 }
    });
    let count: usize = lines.iter().map(Vec::len).sum();
    let noise = independent_power(lines, |a, b| {
        // Lines D apart in white noise under a window $e^{-\sigma t}$.
        let window = 2.0 * a.re;
        if window > 0.0 { window / (window + (b - a)) / count as f64 } else { Complex64::ZERO }
    });
    IndependentLines { before, after, noise }
}

/// From the share that each pair of lines so many apart has in their correlation.
fn independent_power(records: &[Vec<Complex64>], share: impl Fn(Complex64, Complex64) -> Complex64) -> f64 {
    let lines: usize = records.iter().map(Vec::len).sum();
    let scatter = 1.0 / (lines.max(1) as f64).sqrt();
    let mut sum = 0.0;
    for apart in 1..=REACH {
        let pairs = records.iter().flat_map(|record| record.iter().zip(record.iter().skip(apart)));
        let correlation: Complex64 = pairs.map(|(a, b)| share(*a, *b)).sum();
        if correlation.norm().max(0.0) < 2.0 * scatter {
            break;
        }
        sum += correlation.norm_sqr();
    }
    1.0 / (1.0 + 2.0 * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number between -1 and 1, as good as drawn: the generator splitmix64 at this index.
    fn draw(index: usize) -> f64 {
        let mut z = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// White noise in time, faded as records are, on every line of its transform.
    #[test]
    fn val_faded_noise_is_as_dependent_as_its_window_says() {
        let (samples, duration, decay_rate) = (1024, 0.6, 6.0);
        let faded: Vec<f64> =
            (0..samples).map(|n| draw(n) * f64::exp(-decay_rate * duration * n as f64 / samples as f64)).collect();
        let line = |k: usize| {
            let turn = |n: usize| Complex64::cis(-std::f64::consts::TAU * (k * n % samples) as f64 / samples as f64);
            faded.iter().enumerate().map(|(n, value)| turn(n) * value).sum()
        };
        let residuals: Vec<Complex64> = (1..samples / 2).map(line).collect();
        let s = |k: usize| Complex64::new(decay_rate, std::f64::consts::TAU * k as f64 / duration);
        let lines: Vec<Complex64> = (1..samples / 2).map(s).collect();
        // Phases that count from another moment change nothing.
        let shifted: Vec<Complex64> =
            residuals.iter().zip(&lines).map(|(r, s)| r * Complex64::cis(0.02 * s.im)).collect();
        let IndependentLines { before, after, noise } = independent_lines(&[shifted], &[residuals], &[lines]);
        // tanh(x)/x with x = sigma T, if the sum went on for ever.
        let x = decay_rate * duration;
        assert!((noise / (x.tanh() / x) - 1.0).abs() < 0.2, "{noise}");
        assert!(
            (after / noise - 1.0).abs() < 0.2 && (before / after - 1.0).abs() < 1e-9,
            "{before} {after}, noise {noise}"
        );
        let without_window = [Complex64::new(0.0, 1.0), Complex64::new(0.0, 2.0)];
        assert_eq!(independent_lines(&[], &[], &[without_window.to_vec()]).noise, 1.0);
    }

    #[test]
    fn white_residuals_all_count() {
        let white: Vec<Complex64> = (0..4000).map(|i| Complex64::new(draw(2 * i), draw(2 * i + 1))).collect();
        assert!(independent_part(&[white]) > 0.9);
    }

    #[test]
    fn val_a_running_mean_of_four_leaves_a_quarter() {
        let white: Vec<Complex64> = (0..40_000).map(|i| Complex64::new(draw(2 * i), draw(2 * i + 1))).collect();
        let mean: Vec<Complex64> = white.windows(4).map(|four| four.iter().sum()).collect();
        // rho = 3/4, 1/2, 1/4: 1 + 2 * 1.5 = 4.
        assert!((independent_part(&[mean]) - 0.25).abs() < 0.02);
    }
}
