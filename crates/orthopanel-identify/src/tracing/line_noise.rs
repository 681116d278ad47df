//! Noise of accelerances, and what lines share of it: that of the force's channel is one error for some hundred hertz.
//!
//! The blow is cut out of its channel by a window of the length $T$, so the noise in its transform keeps its value over
//! $1/T$, as does the error $-H\,\delta F/F$ that it makes of all the lines there. Taken for as many errors as there are lines
//! it would make a fit far too sure of what is smooth, as the damping of modes above the band is. Over a stretch of lines the noise has the
//! covariance $\sigma^2(I + zz^H)$ with $z_l = \sqrt{v_l}\,H_l/(|H_l|\sigma_l)$, $v$ the variance by the force; and with
//! $$ r - \gamma z\,z^Hr,\qquad \gamma = \frac{1-(1+|z|^2)^{-1/2}}{|z|^2} $$
//! of what is missed over $\sigma$, and of its derivatives, sums of squares are those under this covariance.

use num_complex::Complex64;
use orthopanel_model::LineBlock;

use super::reactions::blow::HALF_WIDTH;

/// Part of the noise that is the same over a stretch: the mean of $\sin(\pi fT)/(\pi fT)$ over all pairs of lines of
/// [`STRETCH`].
const SHARE: f64 = 0.85;
/// Length of a stretch times that of the window.
const STRETCH: f64 = 0.77;

/// Noise of the lines of a record or of a hit: each line's own, and what the force's makes them share.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LineNoise {
    /// One over the deviation of each real number by what no other line shares.
    pub weights: Vec<f64>,
    /// $z$ of each line, and how many lines make a stretch; empty where none share anything.
    ties: Vec<Complex64>,
    stretch: usize,
    /// $\gamma$ of each stretch.
    taken: Vec<f64>,
}

impl LineNoise {
    /// Of lines `step` \[Hz\] apart with these values, variances and parts of the variance by the force.
    pub(super) fn of(value: &[Complex64], [variance, by_force]: [&[f64]; 2], step: f64) -> Self {
        // The variance counts real and imaginary part together.
        let weights = |left: &[f64]| left.iter().map(|left| (2.0 / left).sqrt()).collect();
        let stretch = stretch(step);
        if by_force.len() != value.len() || stretch < 2 {
            return Self { weights: weights(variance), ties: vec![], stretch, taken: vec![] };
        }
        let left: Vec<f64> = variance.iter().zip(by_force).map(|(all, by_force)| all - SHARE * by_force).collect();
        let tie = |((value, by_force), left): ((&Complex64, &f64), &f64)| {
            *value / value.norm().max(f64::MIN_POSITIVE) * (SHARE * by_force / left).sqrt()
        };
        let ties: Vec<Complex64> = value.iter().zip(by_force).zip(&left).map(tie).collect();
        let taken = ties.chunks(stretch).map(|ties| {
            let size: f64 = ties.iter().map(Complex64::norm_sqr).sum();
            if size > 0.0 { (1.0 - (1.0 + size).sqrt().recip()) / size } else { 0.0 }
        });
        let taken = taken.collect();
        Self { weights: weights(&left), ties, stretch, taken }
    }

    /// Takes what lines share off real and imaginary parts of lines from `first` on, which is where a stretch begins.
    pub(super) fn whiten(&self, first: usize, [re, im]: [&mut [f64]; 2]) {
        if self.ties.is_empty() {
            return;
        }
        let stretches =
            re.chunks_mut(self.stretch).zip(im.chunks_mut(self.stretch)).zip(self.ties[first..].chunks(self.stretch));
        for (((re, im), ties), taken) in stretches.zip(&self.taken[first / self.stretch..]) {
            let (mut sum_re, mut sum_im) = (0.0, 0.0);
            for ((re, im), tie) in re.iter().zip(&*im).zip(ties) {
                sum_re += tie.re * re + tie.im * im;
                sum_im += tie.re * im - tie.im * re;
            }
            let (sum_re, sum_im) = (taken * sum_re, taken * sum_im);
            for ((re, im), tie) in re.iter_mut().zip(im).zip(ties) {
                *re -= tie.re * sum_re - tie.im * sum_im;
                *im -= tie.re * sum_im + tie.im * sum_re;
            }
        }
    }
}

/// Lines of a stretch where lines lie `step` \[Hz\] apart: a power of two, so that stretches fill a [`LineBlock`].
fn stretch(step: f64) -> usize {
    let lines = (STRETCH / (2.0 * HALF_WIDTH * step)) as usize;
    let power = if lines > 1 { 1 << lines.ilog2() } else { 1 };
    power.min(LineBlock::MOST)
}

#[cfg(test)]
mod tests {
    use faer::Mat;
    use faer::prelude::Solve;

    use super::*;

    /// Sums of squares are those under the covariance $\sigma^2(I+zz^H)$, stretch by stretch.
    #[test]
    fn val_products_are_those_under_the_covariance() {
        let (step, lines) = (6.0, 40);
        let value: Vec<Complex64> =
            (0..lines).map(|l| Complex64::from_polar(1.0 + 0.1 * l as f64, 0.3 * l as f64)).collect();
        let by_force: Vec<f64> = value.iter().map(|h| 1e-4 * h.norm_sqr()).collect();
        let variance: Vec<f64> = by_force.iter().map(|by_force| by_force + 3e-4).collect();
        let noise = LineNoise::of(&value, [&variance, &by_force], step);
        assert_eq!(noise.stretch, 16);
        let left: Vec<f64> = noise.weights.iter().map(|weight| 2.0 / (weight * weight)).collect();
        let missed: Vec<Complex64> = (0..lines).map(|l| Complex64::new((l * l) as f64 % 7.0, l as f64 % 5.0)).collect();
        let (mut re, mut im): (Vec<f64>, Vec<f64>) =
            missed.iter().zip(&left).map(|(r, left)| (r.re / left.sqrt(), r.im / left.sqrt())).unzip();
        noise.whiten(0, [&mut re, &mut im]);
        let found: f64 = re.iter().chain(&im).map(|part| part * part).sum();
        let mut wanted = 0.0;
        for from in (0..lines).step_by(16) {
            let own = from..(from + 16).min(lines);
            let phase = |l: usize| value[l] / value[l].norm() * (SHARE * by_force[l]).sqrt();
            let covariance = Mat::from_fn(own.len(), own.len(), |i, j| {
                let white = if i == j { left[own.start + i] } else { 0.0 };
                phase(own.start + i) * phase(own.start + j).conj() + white
            });
            let right = Mat::from_fn(own.len(), 1, |i, _| missed[own.start + i]);
            wanted += (right.adjoint() * covariance.partial_piv_lu().solve(&right))[(0, 0)].re;
        }
        assert!((found / wanted - 1.0).abs() < 1e-12, "{found} {wanted}");
    }

    /// The mean of $\sin(\pi fT)/(\pi fT)$ over pairs of lines of a stretch.
    #[test]
    fn val_a_stretch_shares_what_is_said() {
        let count = 400;
        let apart = |i: usize, j: usize| {
            let x = std::f64::consts::PI * STRETCH * i.abs_diff(j) as f64 / f64::from(count as u32);
            if x == 0.0 { 1.0 } else { x.sin() / x }
        };
        let sum: f64 = (0..count).flat_map(|i| (0..count).map(move |j| apart(i, j))).sum();
        assert!((sum / (count * count) as f64 - SHARE).abs() < 0.01);
    }

    #[test]
    fn lines_far_apart_share_nothing() {
        let value = [Complex64::ONE; 4];
        let noise = LineNoise::of(&value, [&[1.0; 4], &[0.5; 4]], 200.0);
        assert_eq!((noise.ties, noise.weights), (vec![], vec![2.0_f64.sqrt(); 4]));
    }
}
