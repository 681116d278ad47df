//! Accelerances made ready for a fit: one variance a line, places by number.

use num_complex::Complex64;
use orthopanel_data::Accelerance;
use orthopanel_model::Place;

use super::line_block::{BLOCK, LineBlock};
use super::line_noise::line_variance;

/// One accelerance of one piece.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlaceRecord {
    pub force_at: Place,
    pub response_at: Place,
    /// Lines \[Hz\].
    pub frequency: Vec<f64>,
    /// Accelerance at each line.
    pub value: Vec<Complex64>,
    /// $E|\hat H-H|^2$ of each line, smooth and greater than zero.
    pub variance: Vec<f64>,
    /// Whether the variance was told by the records, or assumed even.
    pub variance_known: bool,
    /// $\sigma$ of $s = \sigma + j\omega$ \[1/s\].
    pub decay_rate: f64,
}

impl PlaceRecord {
    pub(super) fn of(accelerance: &Accelerance) -> Self {
        let variance = line_variance(accelerance);
        // A line whose noise is unbounded says nothing.
        let usable: Vec<usize> = (0..accelerance.value.len()).filter(|&line| variance[line].is_finite()).collect();
        Self {
            force_at: accelerance.force_at,
            response_at: accelerance.response_at,
            frequency: usable.iter().map(|&line| accelerance.frequency[line]).collect(),
            value: usable.iter().map(|&line| accelerance.value[line]).collect(),
            variance: usable.iter().map(|&line| variance[line]).collect(),
            variance_known: accelerance.variance.is_some(),
            decay_rate: accelerance.decay_rate,
        }
    }

    /// $s$ of a line.
    pub(super) fn s(&self, line: usize) -> Complex64 {
        Complex64::new(self.decay_rate, std::f64::consts::TAU * self.frequency[line])
    }

    /// $s$ of the lines from one on; past the record's end its last line again.
    pub(super) fn s_block(&self, from: usize) -> LineBlock {
        LineBlock::filled((from..self.frequency.len()).map(|line| self.s(line)))
    }

    /// $\sqrt{2/\mathrm{var}}$ of the lines from one on, since the variance counts real and imaginary part together; past
    /// the record's end 0.
    pub(super) fn weights(&self, from: usize) -> [f64; BLOCK] {
        let mut weights = [0.0; BLOCK];
        for (weight, variance) in weights.iter_mut().zip(self.variance.iter().skip(from)) {
            *weight = (2.0 / variance).sqrt();
        }
        weights
    }

    /// Highest line \[Hz\].
    pub(super) fn band_end(&self) -> f64 {
        self.frequency.last().copied().unwrap_or(0.0)
    }
}
