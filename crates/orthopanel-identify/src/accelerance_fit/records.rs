//! Accelerances made ready for a fit: one variance a line, places by number.

use num_complex::Complex64;
use orthopanel_data::{Accelerance, ReadAs};
use orthopanel_model::Place;

use super::line_block::{BLOCK, LineBlock};
use super::line_noise::line_variance;
use super::tied_noise::TiedNoise;
use crate::AcceleranceFit;

/// Power of all lines over that of their noise, below which no signal is in them: few hits tell a variance to some per cent.
const MERE_NOISE: f64 = 1.05;

/// Part of its size within which a line is known at best, ...
const DIGITS: f64 = 1e-6;
/// ... and of the record's lines, rms: a step of a converter of 16 bits. Computed hits agree to the last digit, and weighed by that
/// no model meets them.
const STEP: f64 = 1e-5;

/// Part of a line by which the force's noise makes it too low, up to which that is known well enough to be taken out: it is told to
/// first order, and beyond the force is mostly noise.
const MOST_BIAS: f64 = 0.3;

/// The same part from which that noise counts in the weights of lines.
const COUNTS: f64 = 1e-3;

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
    /// Whether several hits tell it by their scatter. One hit tells the noise of its channels above the band at best, where a
    /// hammer still has force and the piece modes; then it is told anew by what a fit leaves.
    pub scatter_told: bool,
    /// $\sigma$ of $s = \sigma + j\omega$ \[1/s\].
    pub decay_rate: f64,
    /// By how much a window may have moved the decay rate of a resonance \[1/s\].
    pub decay_rate_in_doubt: f64,
    /// How many independent data each line is worth, at most one: an exponential window ties neighbouring lines together.
    pub worth: Vec<f64>,
    /// $r$ of the lines' variance $l(1 + r|H|^2)$ where the force's noise counts, for then that of $|H|^2$ counts, too: a line that
    /// noise makes great has a great variance, and a fit that takes both as they are finds all lines too low. Not under a force
    /// window, where what is left of that noise is tied together and the same for neighbours.
    pub by_strength: Option<f64>,
    /// What of the variance a force window ties together over many lines.
    pub tied: Option<TiedNoise>,
    /// As what the record was read.
    pub read_as: ReadAs,
}

#[cfg(test)]
impl PlaceRecord {
    /// Lines at one place, of noise that nothing tells.
    pub(super) fn even(frequency: Vec<f64>, value: Vec<Complex64>) -> Self {
        let place = Place { x: 0.0, y: 0.0 };
        Self {
            force_at: place,
            response_at: place,
            variance: vec![1.0; frequency.len()],
            variance_known: false,
            scatter_told: false,
            decay_rate: 0.0,
            decay_rate_in_doubt: 0.0,
            worth: vec![1.0; frequency.len()],
            by_strength: None,
            tied: None,
            read_as: ReadAs::SI,
            frequency,
            value,
        }
    }
}

impl PlaceRecord {
    pub(super) fn of(accelerance: &Accelerance) -> Self {
        let (mut variance, ratio) = line_variance(accelerance);
        let noise = accelerance.force_noise.as_ref();
        // A window makes the scatter of few hits wander over its whole width: where they happen to scatter little, what is
        // known of the force's noise stands.
        variance
            .iter_mut()
            .zip(noise.iter().flat_map(|noise| &noise.variance))
            .for_each(|(all, of)| *all = all.max(*of));
        let power = || accelerance.value.iter().map(|value| value.norm_sqr());
        let floor = STEP * STEP * power().sum::<f64>() / power().len() as f64;
        variance.iter_mut().zip(power()).for_each(|(all, power)| *all += DIGITS * DIGITS * power + floor);
        // A line whose noise is unbounded says nothing.
        let usable: Vec<usize> = (0..accelerance.value.len()).filter(|&line| variance[line].is_finite()).collect();
        let biases = accelerance.bias.as_deref().unwrap_or_default();
        let bias = |line: usize| biases.get(line).copied().filter(|bias| *bias < MOST_BIAS).unwrap_or_default();
        let unbiased = |line: usize| accelerance.value[line] / (1.0 - bias(line));
        Self {
            force_at: accelerance.force_at,
            response_at: accelerance.response_at,
            frequency: usable.iter().map(|&line| accelerance.frequency[line]).collect(),
            value: usable.iter().map(|&line| unbiased(line)).collect(),
            variance: usable.iter().map(|&line| variance[line]).collect(),
            variance_known: accelerance.variance.is_some(),
            scatter_told: accelerance.variance.is_some() && accelerance.hits != 1,
            decay_rate: accelerance.decay_rate,
            decay_rate_in_doubt: accelerance.decay_rate_in_doubt,
            worth: vec![1.0; usable.len()],
            by_strength: (accelerance.hits > 1 && noise.is_none() && (0..biases.len()).any(|line| bias(line) > COUNTS))
                .then_some(ratio),
            tied: noise.map(|noise| TiedNoise::of(noise, accelerance, &usable)),
            read_as: accelerance.read_as,
        }
    }

    /// The record that a fit was of.
    pub(super) fn of_fit(fit: &AcceleranceFit, read_as: ReadAs) -> Self {
        Self {
            force_at: fit.force_at,
            response_at: fit.response_at,
            frequency: fit.frequency.clone(),
            value: fit.measured.clone(),
            variance: fit.variance.clone().unwrap_or_else(|| vec![1.0; fit.measured.len()]),
            variance_known: fit.variance.is_some(),
            scatter_told: false,
            decay_rate: fit.decay_rate,
            decay_rate_in_doubt: 0.0,
            worth: vec![1.0; fit.measured.len()],
            by_strength: None,
            tied: None,
            read_as,
        }
    }

    /// The same over that part of its noise which is independent from line to line; `None` where no window ties any.
    pub(super) fn independent(&self) -> Option<Self> {
        let noise = self.tied.as_ref()?;
        Some(Self { variance: noise.independent.clone(), tied: None, ..self.clone() })
    }

    /// The same times $s^n$, with its noise.
    pub(super) fn times_s(&self, derivatives: i8) -> Self {
        let mut taken = Self { tied: None, ..self.clone() };
        for line in 0..taken.frequency.len() {
            let by = self.s(line).powi(i32::from(derivatives));
            taken.value[line] *= by;
            taken.variance[line] *= by.norm_sqr();
        }
        taken
    }

    /// Takes $|H|^2$ in the variance of each line from a model of it.
    pub(super) fn weigh_by(&mut self, model: &[Complex64]) {
        let Some(ratio) = self.by_strength.take() else { return };
        let of = |value: &Complex64| 1.0 + ratio * value.norm_sqr();
        let lines = self.variance.iter_mut().zip(&self.value).zip(model);
        lines.for_each(|((variance, measured), model)| *variance *= of(model) / of(measured));
    }

    /// Whether its lines are no greater than their noise makes them.
    pub(super) fn is_mere_noise(&self) -> bool {
        let lines = self.value.iter().zip(&self.variance);
        let power: f64 = lines.map(|(value, variance)| value.norm_sqr() / variance).sum();
        self.variance_known && power < MERE_NOISE * self.value.len() as f64
    }

    /// The same with every few lines only, so that no more than `most` are left.
    pub(super) fn thinned(&self, most: usize) -> Self {
        let stride = self.value.len().div_ceil(most.max(1)).max(1);
        let every = |of: &[f64]| of.iter().step_by(stride).copied().collect();
        Self {
            frequency: every(&self.frequency),
            value: self.value.iter().step_by(stride).copied().collect(),
            variance: every(&self.variance),
            worth: every(&self.worth),
            tied: None,
            ..*self
        }
    }

    /// Distance between lines \[Hz\]; zero of a single one.
    pub(super) fn line_step(&self) -> f64 {
        self.frequency.get(1).zip(self.frequency.first()).map_or(0.0, |(second, first)| second - first)
    }

    /// Takes into account how the window ties lines together, by the decay rates $\zeta\omega$ \[1/s\] and frequencies
    /// \[Hz\] of the poles: each line by the nearest one.
    pub(super) fn heed_window(&mut self, poles: &[(f64, f64)]) {
        let step = self.line_step();
        for (worth, line) in self.worth.iter_mut().zip(&self.frequency) {
            let distance = |pole: &&(f64, f64)| (pole.1 - line).abs();
            if let Some((decay, _)) = poles.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) {
                *worth = 1.0 / variance_beneath_window(*decay, self.decay_rate, 1.0 / step);
            }
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

    /// $\sqrt{2w/\mathrm{var}}$ of the lines from one on, with what each is worth, since the variance counts real and
    /// imaginary part together; past the record's end 0.
    pub(super) fn weights(&self, from: usize) -> [f64; BLOCK] {
        let mut weights = [0.0; BLOCK];
        let lines = self.variance.iter().zip(&self.worth).skip(from);
        for (weight, (variance, worth)) in weights.iter_mut().zip(lines) {
            *weight = (2.0 * worth / variance).sqrt();
        }
        weights
    }

    /// Highest line \[Hz\].
    pub(super) fn band_end(&self) -> f64 {
        self.frequency.last().copied().unwrap_or(0.0)
    }
}

/// Variance of what a fit finds under the window $e^{-\sigma t}$, over what it would be if the lines were independent.
///
/// Even noise $n(t)$ under $w = e^{-\sigma t}$ ties lines together. A response of decay rate $\delta$ depends on its pole
/// as $J = te^{-\delta t}$, which the fit weighs with $w^2$: the variance of what it finds is $\int w^4J^2/(\int w^2J^2)^2$,
/// that of independent lines of the same noise $\overline{w^2}/\int w^2J^2$. With $T$ the record's length,
/// $$r = \left(\frac{\delta+\sigma}{\delta+2\sigma}\right)^3\frac{2\sigma T}{1-e^{-2\sigma T}},$$
/// at least one here: a fit is not said to be better for its window. One where there is no window.
pub(super) fn variance_beneath_window(decay: f64, window: f64, length: f64) -> f64 {
    let both = 2.0 * window * length;
    if both > 0.0 && both.is_finite() {
        (((decay + window) / (decay + 2.0 * window)).powi(3) * both / -(-both).exp_m1()).max(1.0)
    } else {
        1.0
    }
}
