//! What is done to a record line by line of its spectrum.

use std::ops::RangeInclusive;

use num_complex::Complex64;
use orthopanel_data::Transforms;

/// The record without its lines outside `band` \[Hz\]; `rate` is its sampling rate \[Hz\].
pub(super) fn within(transforms: &mut Transforms, values: &[f64], rate: f64, band: &RangeInclusive<f64>) -> Vec<f64> {
    let count = values.len();
    let mut lines = transforms.lines(values.to_vec());
    for (k, line) in lines.iter_mut().enumerate() {
        let inside = band.contains(&(k as f64 * rate / count as f64));
        *line = if inside { *line / count as f64 } else { Complex64::default() };
    }
    transforms.samples(lines, count)
}

/// The second derivative of the band-limited function through the samples, at the samples.
pub(super) fn second_derivative(transforms: &mut Transforms, values: &[f64], rate: f64) -> Vec<f64> {
    let count = values.len();
    let mut lines = transforms.lines(values.to_vec());
    for (k, line) in lines.iter_mut().enumerate() {
        let omega = std::f64::consts::TAU * k as f64 * rate / count as f64;
        *line *= -omega * omega / count as f64;
    }
    transforms.samples(lines, count)
}

/// The band-limited function through the samples, `finer` times as densely sampled, such that straight lines
/// between the new samples have its spectrum.
///
/// Straight lines over a step $h$ act as the filter $\mathrm{sinc}^2(fh)$; its inverse, $1.013$ at most for 8 steps
/// or more a sample, is put on the new samples. The record is taken to be periodic: it should end as it begins.
pub(super) fn finer(transforms: &mut Transforms, values: &[f64], finer: usize) -> Vec<f64> {
    let count = values.len();
    let fine_count = finer * count;
    let mut lines = transforms.lines(values.to_vec());
    for (k, line) in lines.iter_mut().enumerate() {
        let phase = std::f64::consts::PI * k as f64 / fine_count as f64;
        let sinc = if k == 0 { 1.0 } else { phase.sin() / phase };
        *line /= count as f64 * sinc * sinc;
    }
    if let Some(line) = lines.get_mut(count / 2)
        && count.is_multiple_of(2)
        && finer > 1
    {
        // The line at half the rate stood for itself and its mirror image, which now are two.
        *line /= 2.0;
    }
    let mut fine = transforms.samples(lines, fine_count);
    fine.truncate(fine_count + 1 - finer);
    fine
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn cosine(count: usize, cycles: f64, steps: usize) -> Vec<f64> {
        (0..count).map(|n| (TAU * cycles * n as f64 / steps as f64 + 0.3).cos()).collect()
    }

    #[test]
    fn val_a_band_keeps_its_own_cosine_alone() {
        for count in [100, 101] {
            let (low, high) = (cosine(count, 5.0, count), cosine(count, 20.0, count));
            let both: Vec<f64> = low.iter().zip(&high).map(|(a, b)| a + b + 2.0).collect();
            // One cycle a record is 1 Hz at a rate of as many samples.
            let kept = |band| within(&mut Transforms::default(), &both, count as f64, &band);
            for (expected, found) in [(&low, kept(1.0..=10.0)), (&high, kept(10.0..=50.0))] {
                let worst = expected.iter().zip(found).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
                assert!(worst < 1e-13, "{worst}");
            }
        }
    }

    #[test]
    fn val_a_cosine_s_second_derivative_is_its_own() {
        for (count, cycles) in [(100, 7.0), (101, 50.0), (64, 0.0)] {
            let values = cosine(count, cycles, count);
            let derivative = second_derivative(&mut Transforms::default(), &values, count as f64);
            let square = (TAU * cycles).powi(2);
            let errors = values.iter().zip(derivative).map(|(value, found)| (found + square * value).abs());
            assert!(errors.fold(0.0, f64::max) < 1e-12 * (square + 1.0), "{cycles} of {count}");
        }
    }

    /// The Fourier line of straight lines through the finer samples is that of the cosine itself.
    #[test]
    fn val_straight_lines_between_finer_samples_have_the_cosine_s_line() {
        for (count, cycles) in [(64, 0.0), (64, 7.0), (64, 31.0), (65, 32.0)] {
            let times = 16;
            let fine = finer(&mut Transforms::default(), &cosine(count, cycles, count), times);
            assert_eq!(fine.len(), times * (count - 1) + 1);
            let sinc = |x: f64| if x == 0.0 { 1.0 } else { (x * TAU / 2.0).sin() / (x * TAU / 2.0) };
            let loss = sinc(cycles / (times * count) as f64).powi(2);
            let exact = cosine(fine.len(), cycles, times * count);
            let worst = fine.iter().zip(exact).fold(0.0_f64, |worst, (a, b)| worst.max((a * loss - b).abs()));
            assert!(worst < 1e-12, "{cycles} cycles: {worst}");
        }
    }
}
