//! One record as weighted spectral lines, and how a pole shows in them.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::Place;

/// The accelerance of one pair of places on the lines of a transform.
///
/// Each line's real and imaginary part have the standard deviation $1/g_k$ as far as smooth functions of the lines see it. Under an exponential
/// window $e^{-\sigma t}$ over a record that lasts $T$, noise of variance $\sigma_k^2$ is correlated from line to line by
/// $1/(1 + j\,\pi k/\sigma T)$, which sums to $\sigma T\coth\sigma T$ lines a datum: $1/g_k^2$ is so many times $\sigma_k^2$.
#[derive(Debug, Clone)]
pub(super) struct RecordLines {
    pub force_at: Place,
    pub response_at: Place,
    /// $s_k$ of each line \[1/s\].
    pub s: Vec<Complex64>,
    /// Accelerance \[(m/s²)/N\].
    pub value: Vec<Complex64>,
    /// $g_k$ \[N/(m/s²)\].
    pub weight: Vec<f64>,
    /// Lines that share one datum: one where noise is independent from line to line, more under an exponential window.
    pub per_datum: f64,
    /// What the end of each hit's record cuts off; none where the accelerance is whole.
    pub truncations: Option<Truncations>,
    /// Relative variance of $H$ by the noise of the force, which moves all of a mode alike: see [`super::MeasuredModes`].
    pub force_noise: Vec<f64>,
}

/// Hits whose responses ring on when their records end.
#[derive(Debug, Clone)]
pub(super) struct Truncations {
    /// Sampling step $\Delta t$ \[s\].
    pub step: f64,
    /// $e^{-s_k\Delta t}$ of each line.
    pub back: Vec<Complex64>,
    pub hits: Vec<TruncatedHit>,
}

/// A hit whose response rings on when its record ends.
#[derive(Debug, Clone)]
pub(super) struct TruncatedHit {
    /// Force times the sampling step \[N s\], sample by sample over the blow.
    pub impulse: Vec<f64>,
    /// From the last of these samples to the record's end \[s\].
    pub left: f64,
    /// Share of the hit in each line's mean, $\bar F_k/(v_kG_k)$ of its force's transform, see [`super::hits`], times $e^{-s_kT}$ with the record's
    /// length $T$.
    pub share: Vec<Complex64>,
}

/// How a pole and its conjugate show on some lines.
pub(super) struct PoleColumns {
    /// By the real part of the residue, and by its imaginary part.
    pub by_residue: [Vec<Complex64>; 2],
    /// Derivatives of these by $\lambda$, where $\bar\lambda$ moves along.
    pub by_pole: [Vec<Complex64>; 2],
}

/// Free vibrations below this part of what they were at the blow change no line.
const DECAYED: f64 = 1e-10;

impl TruncatedHit {
    /// $F(\lambda)e^{\lambda T}$ and its derivative by $\lambda$: the free vibration at the record's end. `None` where nothing is left of it.
    fn at_end(&self, lambda: Complex64, step: f64) -> Option<[Complex64; 2]> {
        if (lambda.re * self.left).exp() < DECAYED {
            return None;
        }
        // Horner's scheme from the first sample: $\sum_nf_ne^{\lambda(N-n)\Delta t}$, and the same times $(N-n)\Delta t$.
        let ratio = (lambda * step).exp();
        let (mut sum, mut moment) = (Complex64::ZERO, Complex64::ZERO);
        for impulse in &self.impulse {
            moment = (moment + sum * step) * ratio;
            sum = sum * ratio + impulse;
        }
        let rest = (lambda * self.left).exp();
        Some([sum * rest, (moment + sum * self.left) * rest])
    }
}

impl RecordLines {
    /// The lines between two frequencies \[Hz\].
    pub(super) fn between(&self, band: [f64; 2]) -> Self {
        let [from, to] = band.map(|end| self.s.partition_point(|s| s.im < TAU * end));
        let cut = |values: &[f64]| values.get(from..to).map(<[f64]>::to_vec).unwrap_or_default();
        let of_hit = |hit: &TruncatedHit| TruncatedHit { share: hit.share[from..to].to_vec(), ..hit.clone() };
        let truncations = self.truncations.as_ref().map(|all| Truncations {
            step: all.step,
            back: all.back[from..to].to_vec(),
            hits: all.hits.iter().map(of_hit).collect(),
        });
        Self {
            force_at: self.force_at,
            response_at: self.response_at,
            s: self.s[from..to].to_vec(),
            value: self.value[from..to].to_vec(),
            weight: cut(&self.weight),
            per_datum: self.per_datum,
            truncations,
            force_noise: cut(&self.force_noise),
        }
    }

    /// Adds what a pole with this residue shows, to values that stand one a line.
    pub(super) fn add_pole(&self, values: &mut [Complex64], lambda: Complex64, residue: Complex64) {
        let lines: Vec<usize> = (0..self.s.len()).collect();
        let [real, imaginary] = self.pole(lambda, &lines).by_residue;
        for (value, (real, imaginary)) in values.iter_mut().zip(real.iter().zip(&imaginary)) {
            *value += residue.re * real + residue.im * imaginary;
        }
    }

    /// How a pole shows on these lines.
    ///
    /// With the record's end at $T$ a hit shows of $1/(s-\lambda)$ no more than
    /// $$\frac{1}{s-\lambda} - \frac{F(\lambda)e^{(\lambda-s)T}}{F(s)}\,\frac{\Delta t}{1-e^{(\lambda-s)\Delta t}},$$
    /// the transform of samples up to there: the free vibration after $T$ is a geometric series. Several hits show it in the mean that
    /// their accelerances have.
    pub(super) fn pole(&self, lambda: Complex64, lines: &[usize]) -> PoleColumns {
        let count = lines.len();
        let columns = || [Vec::with_capacity(count), Vec::with_capacity(count)];
        let mut pole = PoleColumns { by_residue: columns(), by_pole: columns() };
        let ends: Vec<(&TruncatedHit, [Complex64; 2])> = self
            .truncations
            .iter()
            .flat_map(|all| all.hits.iter().filter_map(|hit| Some((hit, hit.at_end(lambda, all.step)?))))
            .collect();
        let ratio = self.truncations.as_ref().map_or(Complex64::ZERO, |all| (lambda * all.step).exp());
        for &k in lines {
            let s = self.s[k];
            let [one, other] = [(s - lambda).inv(), (s - lambda.conj()).inv()];
            let (mut values, mut derivatives) = ([one, other], [one * one, other * other]);
            if let (Some(all), false) = (&self.truncations, ends.is_empty()) {
                let mut cut = [[Complex64::ZERO; 2]; 2];
                for (hit, [end, by_lambda]) in &ends {
                    let share = hit.share[k];
                    cut[0] = [cut[0][0] + share * end, cut[0][1] + share * by_lambda];
                    cut[1] = [cut[1][0] + share * end.conj(), cut[1][1] + share * by_lambda.conj()];
                }
                for (of, ratio) in [ratio * all.back[k], ratio.conj() * all.back[k]].into_iter().enumerate() {
                    let tail = all.step * (1.0 - ratio).inv();
                    let [end, by_lambda] = cut[of];
                    values[of] -= end * tail;
                    derivatives[of] -= tail * (by_lambda + end * tail * ratio);
                }
            }
            for (columns, [one, other]) in [(&mut pole.by_residue, values), (&mut pole.by_pole, derivatives)] {
                columns[0].push(one + other);
                columns[1].push(Complex64::I * (one - other));
            }
        }
        pole
    }
}
