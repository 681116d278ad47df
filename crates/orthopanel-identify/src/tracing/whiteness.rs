//! How far the residuals are from white: neighbouring lines that err alike are no independent witnesses.

use num_complex::Complex64;

use super::fit::{Fit, LAST};
use super::records_of_test::TestRecords;
use crate::IdentifyError;

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
