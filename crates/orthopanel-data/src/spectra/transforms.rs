//! Discrete Fourier transforms of real records: the one place where they are planned.

use num_complex::Complex64;
use realfft::RealFftPlanner;

/// Discrete Fourier transforms of real records of any length, whose plans are kept.
///
/// ```
/// let record: Vec<f64> = (0..8).map(|n| (std::f64::consts::TAU * f64::from(n) / 8.0).cos()).collect();
/// let mut transforms = orthopanel_data::Transforms::default();
/// let lines = transforms.lines(record.clone());
/// assert!((lines[1].re - 4.0).abs() < 1e-12);
/// let again = transforms.samples(lines, 8);
/// assert!(record.iter().zip(again).all(|(a, b)| (8.0 * a - b).abs() < 1e-12));
/// ```
#[derive(Default)]
pub struct Transforms {
    planner: RealFftPlanner<f64>,
}

impl std::fmt::Debug for Transforms {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Transforms").finish_non_exhaustive()
    }
}

impl Transforms {
    /// Lines $X_k = \sum_n x_n e^{-2\pi jkn/N}$ for $0 \le k \le N/2$ of $N$ samples.
    pub fn lines(&mut self, mut samples: Vec<f64>) -> Vec<Complex64> {
        let transform = self.planner.plan_fft_forward(samples.len());
        let mut lines = transform.make_output_vec();
        let done = transform.process(&mut samples, &mut lines);
        // It fails for other lengths than planned only.
        debug_assert!(done.is_ok());
        lines
    }

    /// $x_n = \sum_k X_k e^{2\pi jkn/N}$ over positive and negative lines, for `count` $= N$ samples: $N$ times what [`Self::lines`] began
    /// with. Lines beyond those given are zero, and the imaginary parts of the first one and of that at $N/2$ do not count.
    pub fn samples(&mut self, mut lines: Vec<Complex64>, count: usize) -> Vec<f64> {
        let transform = self.planner.plan_fft_inverse(count);
        lines.resize(count / 2 + 1, Complex64::default());
        // Lines that are their own mirror image are real; rounding must not say otherwise.
        let highest = if count.is_multiple_of(2) { count / 2 } else { 0 };
        for own_mirror in [0, highest] {
            if let Some(line) = lines.get_mut(own_mirror) {
                line.im = 0.0;
            }
        }
        let mut samples = transform.make_output_vec();
        let done = transform.process(&mut lines, &mut samples);
        debug_assert!(done.is_ok());
        samples
    }
}
