//! Complex functions on a short run of lines, real and imaginary parts apart, so that several lines are summed at once.

use num_complex::Complex64;

/// Lines in a run: the functions of a dozen modes stay in the processor's first cache.
pub(super) const BLOCK: usize = 64;

/// Values of one function at [`BLOCK`] lines.
#[derive(Debug, Clone)]
pub(super) struct LineBlock {
    pub re: [f64; BLOCK],
    pub im: [f64; BLOCK],
}

impl LineBlock {
    pub(super) const ZERO: Self = Self { re: [0.0; BLOCK], im: [0.0; BLOCK] };

    /// The values of an iterator; where it ends early the last one stands in its place, so that every entry is a line.
    pub(super) fn filled(values: impl Iterator<Item = Complex64>) -> Self {
        let mut block = Self::ZERO;
        let mut last = Complex64::ZERO;
        let mut values = values.fuse();
        for (re, im) in block.re.iter_mut().zip(&mut block.im) {
            last = values.next().unwrap_or(last);
            (*re, *im) = (last.re, last.im);
        }
        block
    }

    /// The values, one a line.
    pub(super) fn values(&self) -> impl Iterator<Item = Complex64> + '_ {
        self.re.iter().zip(&self.im).map(|(&re, &im)| Complex64::new(re, im))
    }

    /// Adds a multiple of another function.
    pub(super) fn add_multiple(&mut self, other: &Self, factor: f64) {
        self.re.iter_mut().zip(&other.re).for_each(|(sum, value)| *sum += factor * value);
        self.im.iter_mut().zip(&other.im).for_each(|(sum, value)| *sum += factor * value);
    }

    /// Takes values away, as many as there are.
    pub(super) fn subtract(&mut self, values: &[Complex64]) {
        for ((re, im), value) in self.re.iter_mut().zip(&mut self.im).zip(values) {
            *re -= value.re;
            *im -= value.im;
        }
    }

    /// Writes the real parts, then the imaginary ones, times the weight of each line.
    pub(super) fn write_weighted(&self, weights: &[f64; BLOCK], out: &mut [f64]) {
        let both = [&self.re, &self.im].into_iter().flat_map(|part| part.iter().zip(weights));
        out.iter_mut().zip(both).for_each(|(out, (value, weight))| *out = weight * value);
    }
}
