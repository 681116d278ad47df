//! Neighbouring lines seen through a short window: few numbers tell what they do there at any time.

use std::f64::consts::TAU;

use faer::{Mat, MatRef};
use num_complex::Complex64;

/// Terms of $e^{jx}$ taken for the lines about the middle of a group.
const TERMS: usize = 9;
/// Greatest $|x|$ in a group, at twice the window's half width: what is left out is $0.6^9/9! = 3\cdot10^{-8}$.
const REACH: f64 = 0.6;

/// Lines with a strength $y_k$ each, so near to one another that with $x_k = (\omega_k-\omega_c)h$ the series
/// $$e^{j\omega_kt} = e^{j\omega_ct}\sum_q\frac{(jt/h)^q\,x_k^q}{q!}$$
/// is short as long as $|t| \le 2h$.
pub(super) struct LineGroup {
    /// $\omega_c$ \[1/s\].
    centre: f64,
    /// $h$ \[s\].
    half_width: f64,
    /// $x_k$ and $y_k$.
    lines: Vec<(f64, Complex64)>,
}

impl LineGroup {
    /// How many of these lines \[Hz\] make up one group, from the first on.
    pub(super) fn count(lines: &[f64], half_width: f64) -> usize {
        let Some(first) = lines.first() else { return 0 };
        lines.iter().take_while(|line| TAU * half_width * (*line - first) <= REACH).count().max(1)
    }

    pub(super) fn of(frequencies: &[f64], strengths: &[Complex64], half_width: f64) -> Self {
        let ends = frequencies.first().zip(frequencies.last());
        let centre = ends.map_or(0.0, |(first, last)| 0.5 * TAU * (first + last));
        let offset = |frequency: &f64| (TAU * frequency - centre) * half_width;
        Self { centre, half_width, lines: frequencies.iter().map(offset).zip(strengths.iter().copied()).collect() }
    }

    /// Number of lines.
    pub(super) fn size(&self) -> usize {
        self.lines.len()
    }

    /// Adds $\sum_k\mathrm{Re}(\overline{y_k}J_ke^{j\omega_kt})$ at these times, $|t| \le 2h$; a line's $J_k$ is a row of `re` and `im`.
    pub(super) fn add_to(&self, times: &[f64], (re, im): (MatRef<f64>, MatRef<f64>), sums: &mut Mat<f64>) {
        let count = self.lines.len();
        let (mut by_re, mut by_im) = (Mat::<f64>::zeros(2 * TERMS, count), Mat::<f64>::zeros(2 * TERMS, count));
        for (line, (offset, strength)) in self.lines.iter().enumerate() {
            let (by_re, by_im) = (by_re.col_as_slice_mut(line), by_im.col_as_slice_mut(line));
            let mut term = *strength;
            for q in 0..TERMS {
                (by_re[q], by_re[TERMS + q]) = (term.re, -term.im);
                (by_im[q], by_im[TERMS + q]) = (term.im, term.re);
                term *= offset / (q + 1) as f64;
            }
        }
        let moments = by_re * re + by_im * im;
        let mut in_time = Mat::<f64>::zeros(times.len(), 2 * TERMS);
        for (row, time) in times.iter().enumerate() {
            let (part, mut term) = (time / self.half_width, Complex64::from_polar(1.0, self.centre * time));
            for q in 0..TERMS {
                (in_time[(row, q)], in_time[(row, TERMS + q)]) = (term.re, -term.im);
                term = Complex64::new(-part * term.im, part * term.re);
            }
        }
        *sums += in_time * moments;
    }

    /// Adds $\sum_k|y_k|^2\cos\omega_kt$ at every multiple of this time, from zero up to $2h$.
    pub(super) fn add_powers(&self, step: f64, sums: &mut [f64]) {
        let mut moments = [0.0; TERMS];
        for (offset, strength) in &self.lines {
            let mut term = strength.norm_sqr();
            for (q, moment) in moments.iter_mut().enumerate() {
                *moment += term;
                term *= offset / (q + 1) as f64;
            }
        }
        let (mut now, onwards) = (Complex64::ONE, Complex64::from_polar(1.0, self.centre * step));
        for (multiple, sum) in sums.iter_mut().enumerate() {
            let turned = Complex64::new(0.0, multiple as f64 * step / self.half_width);
            let series = moments.iter().rev().fold(Complex64::ZERO, |series, moment| series * turned + moment);
            *sum += (now * series).re;
            now *= onwards;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sums over lines as they are written down.
    #[test]
    fn val_groups_make_the_sums_over_lines() {
        let half_width = 2.4e-3;
        let frequencies: Vec<f64> = (0..64).map(|line| 700.0 + 0.5 * f64::from(line)).collect();
        let strengths: Vec<Complex64> = (0..64)
            .map(|line| Complex64::from_polar(1.0 + (0.3 * f64::from(line)).sin(), 0.7 * f64::from(line)))
            .collect();
        assert_eq!(LineGroup::count(&frequencies, half_width), 64);
        assert_eq!(LineGroup::count(&frequencies, 10.0 * half_width), 8);
        let group = LineGroup::of(&frequencies, &strengths, half_width);
        let rows = |turn: f64| Mat::from_fn(64, 2, |row, column| (turn + row as f64 * (1.0 + column as f64)).cos());
        let (re, im) = (rows(0.1), rows(0.9));
        let times = [-half_width, 0.3e-3, half_width];
        let mut sums = Mat::zeros(3, 2);
        group.add_to(&times, (re.as_ref(), im.as_ref()), &mut sums);
        let mut powers = vec![0.0; 5];
        group.add_powers(0.5 * half_width, &mut powers);
        let turned = |line: usize, time: f64| Complex64::from_polar(1.0, TAU * frequencies[line] * time);
        for (row, time) in times.into_iter().enumerate() {
            for column in 0..2 {
                let at = |line: usize| Complex64::new(re[(line, column)], im[(line, column)]);
                let sum: f64 = (0..64).map(|line| (strengths[line].conj() * at(line) * turned(line, time)).re).sum();
                assert!((sums[(row, column)] - sum).abs() < 1e-7 * 64.0, "{} {sum}", sums[(row, column)]);
            }
        }
        for (multiple, power) in powers.into_iter().enumerate() {
            let time = 0.5 * half_width * multiple as f64;
            let sum: f64 = (0..64).map(|line| strengths[line].norm_sqr() * turned(line, time).re).sum();
            assert!((power - sum).abs() < 1e-7 * 64.0, "{power} {sum}");
        }
    }
}
