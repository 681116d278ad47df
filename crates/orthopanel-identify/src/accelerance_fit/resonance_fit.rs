//! Resonances of one record over a straight background: what a search for their poles linearises.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::Mat;
use num_complex::Complex64;

use super::poles::{Pole, project_out};
use super::records::{PlaceRecord, variance_beneath_window};
use crate::least_squares::{Linearised, Minimum, Quadratic};

/// $H \approx \sum_kA_ks^2/d_k(s) + B + C(f-f_0)$ with $A_k$, $B$, $C$ complex and eliminated (variable projection).
///
/// Parameters are $\ln f_k$ and $\ln\zeta_k$, resonance by resonance.
pub(super) struct ResonanceFit<'a> {
    pub record: &'a PlaceRecord,
    pub lines: Range<usize>,
    /// What the resonances are to meet at these lines.
    pub value: Vec<Complex64>,
}

/// $s^2/d(s)$.
pub(super) fn resonance(s: Complex64, frequency: f64, zeta: f64) -> Complex64 {
    let omega = TAU * frequency;
    s * s / (s * s + 2.0 * zeta * omega * s + omega * omega)
}

impl ResonanceFit<'_> {
    pub(super) fn linearise(&self, parameters: &[f64]) -> Quadratic {
        let residuals = self.residuals(parameters);
        let columns: Vec<Vec<f64>> = (0..parameters.len())
            .map(|i| {
                // Well inside a half-power width: a frequency's counts in units of its damping ratio.
                let step = if i % 2 == 0 { 1e-3 * parameters[i + 1].exp() } else { 1e-3 };
                let shifted = |sign: f64| {
                    let mut at = parameters.to_vec();
                    at[i] += sign * step;
                    self.residuals(&at)
                };
                let (low, high) = (shifted(-1.0), shifted(1.0));
                high.iter().zip(&low).map(|(high, low)| (high - low) / (2.0 * step)).collect()
            })
            .collect();
        let jacobian = Mat::from_fn(residuals.len(), parameters.len(), |i, j| columns[j][i]);
        Linearised { jacobian, residuals }.quadratic()
    }

    fn residuals(&self, parameters: &[f64]) -> Vec<f64> {
        let Self { record, lines, .. } = self;
        let (from, to) = (record.frequency[lines.start], record.frequency[lines.end - 1]);
        let even = record.variance[lines.clone()].iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut columns = vec![Vec::with_capacity(lines.len()); parameters.len() / 2 + 2];
        let mut right = Vec::with_capacity(lines.len());
        for (line, value) in lines.clone().zip(&self.value) {
            // Variance counts real and imaginary part together. Where it is not told, all lines of a resonance weigh
            // alike: the strong ones near the peak hold what there is to know of its width.
            let variance = if record.variance_known { record.variance[line] } else { even };
            let weight = (2.0 / variance).sqrt();
            let s = record.s(line);
            let (resonances, straight) = columns.split_at_mut(parameters.len() / 2);
            for (column, pole) in resonances.iter_mut().zip(parameters.chunks_exact(2)) {
                let (frequency, zeta) = (pole[0].exp(), pole[1].exp());
                column.push(weight * 2.0 * zeta * resonance(s, frequency, zeta));
            }
            straight[0].push(Complex64::new(weight, 0.0));
            straight[1].push(Complex64::new(weight * (record.frequency[line] - 0.5 * (from + to)) / (to - from), 0.0));
            right.push(weight * value);
        }
        project_out(columns, right).into_iter().flat_map(|value| [value.re, value.im]).collect()
    }

    /// Resonance number `index` at a minimum, with lines `step` \[Hz\] apart about it; `None` where the curvature tells no deviation.
    pub(super) fn pole(&self, minimum: &Minimum, index: usize, step: f64) -> Option<Pole> {
        let covariance = minimum.at.covariance()?;
        // Each resonance has a complex amplitude beside its two parameters, and the background has two.
        let data = 2.0 * self.lines.len() as f64 - (2 * minimum.parameters.len() + 4) as f64;
        let scale = if data > 0.0 { (minimum.at.cost / data).max(1.0) } else { 1.0 };
        let (frequency, zeta) = (minimum.parameters[2 * index].exp(), minimum.parameters[2 * index + 1].exp());
        let mut pole = Pole { frequency, log_frequency_std: f64::INFINITY, zeta, log_zeta_std: f64::INFINITY };
        let beneath = variance_beneath_window(pole.decay_rate(), self.record.decay_rate, 1.0 / step);
        let std = |parameter: usize| (scale * beneath * covariance[(parameter, parameter)]).sqrt();
        (pole.log_frequency_std, pole.log_zeta_std) = (std(2 * index), std(2 * index + 1));
        Some(pole)
    }
}
