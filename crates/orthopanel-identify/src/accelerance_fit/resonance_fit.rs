//! Resonances of one record over a straight background: what a search for their poles linearises.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::Mat;
use num_complex::Complex64;

use super::pole::Pole;
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
    /// Residuals $r = P^\perp y$ and, after Kaufman (BIT 15, 1975), $\partial r/\partial\theta_k \approx -P^\perp(\partial\Phi/\partial\theta_k)c$ with the amplitudes
    /// $c = \Phi^+y$: the gradient is exact, and the curvature is that of the parameters alone.
    pub(super) fn linearise(&self, parameters: &[f64]) -> Quadratic {
        let Self { record, lines, .. } = self;
        let (from, to) = (record.frequency[lines.start], record.frequency[lines.end - 1]);
        let even = record.variance[lines.clone()].iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let poles: Vec<(f64, f64)> =
            parameters.chunks_exact(2).map(|pole| (TAU * pole[0].exp(), pole[1].exp())).collect();
        let mut columns = vec![Vec::with_capacity(lines.len()); poles.len() + 2];
        let mut slopes = vec![Vec::with_capacity(lines.len()); parameters.len()];
        let mut right = Vec::with_capacity(lines.len());
        for (line, value) in lines.clone().zip(&self.value) {
            // Variance counts real and imaginary part together. Where it is not told, all lines of a resonance weigh
            // alike: the strong ones near the peak hold what there is to know of its width.
            let variance = if record.variance_known { record.variance[line] } else { even };
            let weight = (2.0 / variance).sqrt();
            let s = record.s(line);
            for (number, &(omega, zeta)) in poles.iter().enumerate() {
                let damped = 2.0 * zeta * omega * s;
                let inverse = (s * s + damped + omega * omega).inv();
                let column = weight * 2.0 * zeta * s * s * inverse;
                columns[number].push(column);
                slopes[2 * number].push(-column * (damped + 2.0 * omega * omega) * inverse);
                slopes[2 * number + 1].push(column * (1.0 - damped * inverse));
            }
            columns[poles.len()].push(Complex64::new(weight, 0.0));
            let along = (record.frequency[line] - 0.5 * (from + to)) / (to - from);
            columns[poles.len() + 1].push(Complex64::new(weight * along, 0.0));
            right.push(weight * value);
        }
        let space = Orthonormal::of(columns);
        let amplitudes = space.project_out(&mut right);
        for (number, slope) in slopes.iter_mut().enumerate() {
            slope.iter_mut().for_each(|value| *value *= -amplitudes[number / 2]);
            space.project_out(slope);
        }
        let parts = |values: &[Complex64]| values.iter().flat_map(|value| [value.re, value.im]).collect::<Vec<f64>>();
        let slopes: Vec<Vec<f64>> = slopes.iter().map(|slope| parts(slope)).collect();
        let residuals = parts(&right);
        let jacobian = Mat::from_fn(residuals.len(), parameters.len(), |i, j| slopes[j][i]);
        Linearised { jacobian, residuals }.quadratic()
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

/// What columns span, $\Phi = QR$: Gram-Schmidt, twice for its rounding.
struct Orthonormal {
    directions: Vec<Vec<Complex64>>,
    /// $R$, a column each.
    triangle: Vec<Vec<Complex64>>,
}

impl Orthonormal {
    fn of(columns: Vec<Vec<Complex64>>) -> Self {
        let mut space = Self { directions: Vec::with_capacity(columns.len()), triangle: vec![] };
        for mut column in columns {
            let mut shares = space.removed(&mut column);
            let norm = column.iter().map(|value| value.norm_sqr()).sum::<f64>().sqrt();
            if norm > 0.0 {
                column.iter_mut().for_each(|value| *value /= norm);
            }
            shares.push(Complex64::new(norm, 0.0));
            space.directions.push(column);
            space.triangle.push(shares);
        }
        space
    }

    /// Takes all directions off a vector: $Q^Hv$.
    fn removed(&self, from: &mut [Complex64]) -> Vec<Complex64> {
        let mut shares = vec![Complex64::ZERO; self.directions.len()];
        for _ in 0..2 {
            for (direction, sum) in self.directions.iter().zip(&mut shares) {
                let share: Complex64 = direction.iter().zip(from.iter()).map(|(d, f)| d.conj() * f).sum();
                from.iter_mut().zip(direction).for_each(|(value, d)| *value -= share * d);
                *sum += share;
            }
        }
        shares
    }

    /// Leaves of a vector what no combination of the columns can make; the combination, $c$ of $Rc = Q^Hv$.
    fn project_out(&self, from: &mut [Complex64]) -> Vec<Complex64> {
        let mut left = self.removed(from);
        for index in (0..left.len()).rev() {
            let own = self.triangle[index][index];
            left[index] = if own == Complex64::ZERO { own } else { left[index] / own };
            for above in 0..index {
                let taken = self.triangle[index][above] * left[index];
                left[above] -= taken;
            }
        }
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes of the sum of squares against differences of it, where two resonances overlap and neither is met.
    #[test]
    fn val_the_gradient_is_that_of_what_is_left() {
        let frequency: Vec<f64> = (0..200).map(|line| 90.0 + 0.1 * f64::from(line)).collect();
        let value: Vec<Complex64> = frequency
            .iter()
            .map(|&line| {
                let s = Complex64::new(0.0, TAU * line);
                Complex64::new(2.0, 0.3) * resonance(s, 99.0, 0.004)
                    + resonance(s, 101.0, 0.006)
                    + 0.1 * (line * 7.0).sin()
            })
            .collect();
        let record = PlaceRecord::even(frequency, value.clone());
        let fit = ResonanceFit { record: &record, lines: 0..200, value };
        let at = [99.2_f64.ln(), 0.005_f64.ln(), 100.7_f64.ln(), 0.005_f64.ln()];
        let found = fit.linearise(&at);
        for (number, slope) in found.gradient.iter().enumerate() {
            let cost = |sign: f64| {
                let mut moved = at;
                moved[number] += sign * 1e-6;
                fit.linearise(&moved).cost
            };
            let difference = (cost(1.0) - cost(-1.0)) / 2e-6;
            assert!((difference / (2.0 * slope) - 1.0).abs() < 1e-5, "{number}: {difference} {slope}");
        }
    }
}
