//! A core's modulus as a rational function: what a time stepper can hold in internal variables.

use std::f64::consts::TAU;

use faer::Mat;
use num_complex::Complex64;

use super::CoreModulus;
use crate::ModelError;
use crate::dense::Cholesky;

/// Oscillators of one fit, so that the number of internal variables never depends on the numbers of the core.
const TERMS: usize = 6;
/// Damping ratios tried, the same for all of one fit.
const RATIOS: [f64; 3] = [1.0, 2.0, 4.0];
/// Where the lowest and the highest oscillator are tried, over the ends of the band.
const LOWEST: [f64; 4] = [1.0, 0.3, 0.1, 0.03];
const HIGHEST: [f64; 4] = [1.0, 3.0, 10.0, 30.0];
/// Lines of the fit, and of the check of its error, evenly spaced in the logarithm of frequency.
const LINES: usize = 60;
const CHECKED: usize = 241;

/// The fit of a core's modulus factor over a band,
/// $$g(s) \approx 1 + \sum_i a_i\frac{s^2 + 2\zeta\omega_is}{s^2 + 2\zeta\omega_is + \omega_i^2},\quad a_i \ge 0.$$
///
/// Each term is an oscillator that the shear strain drives. With $a_i \ge 0$ mass, damping and stiffness of the enlarged
/// panel are positive, so it never gives energy. Sources: Golla and Hughes, J. Appl. Mech. 52 (1985) 897; McTavish and Hughes,
/// J. Vib. Acoust. 115 (1993) 103.
#[derive(Debug, Clone, PartialEq)]
pub struct CoreFit {
    /// $a_i$ \[1\] and $\omega_i$ \[rad/s\].
    pub terms: Vec<[f64; 2]>,
    /// $\zeta$ \[1\].
    pub ratio: f64,
    /// Band \[Hz\] of the fit.
    pub band: [f64; 2],
    /// Greatest $|g_{fit}-g|/|g|$ in the band \[1\].
    pub error: f64,
}

impl CoreFit {
    /// The best of some placings of the oscillators, for the band `from` to `to` \[Hz\].
    ///
    /// # Errors
    /// [`ModelError::NotFinite`] for a band or numbers of the core that have no physical meaning.
    pub fn new(core: &CoreModulus, band: [f64; 2]) -> Result<Self, ModelError> {
        let [from, to] = band;
        if !(from.is_finite() && to.is_finite() && 0.0 < from && from < to) {
            return Err(ModelError::NotFinite { what: "band of a core's fit", value: to });
        }
        let lines = spaced(from, to, LINES);
        let exact: Vec<Complex64> = lines.iter().map(|f| core.factor(at(*f))).collect();
        let mut best: Option<(f64, Self)> = None;
        for ratio in RATIOS {
            for (low, high) in LOWEST.iter().flat_map(|low| HIGHEST.iter().map(move |high| (low, high))) {
                let omegas: Vec<f64> = spaced(from * low, to * high, TERMS).iter().map(|f| TAU * f).collect();
                let terms = weights(&lines, &exact, &omegas, ratio).into_iter().zip(omegas).map(|(a, w)| [a, w]);
                let fit = Self { terms: terms.collect(), ratio, band, error: 0.0 };
                let error = fit.greatest(&lines, &exact);
                if best.as_ref().is_none_or(|(least, _)| error < *least) {
                    best = Some((error, fit));
                }
            }
        }
        let Some((error, fit)) = best else {
            return Err(ModelError::NotFinite { what: "core modulus", value: f64::NAN });
        };
        if !error.is_finite() {
            return Err(ModelError::NotFinite { what: "core modulus", value: error });
        }
        let lines = spaced(from, to, CHECKED);
        let exact: Vec<Complex64> = lines.iter().map(|f| core.factor(at(*f))).collect();
        Ok(Self { error: fit.greatest(&lines, &exact), ..fit })
    }

    /// $g$ of the fit at $s$.
    pub fn factor(&self, s: Complex64) -> Complex64 {
        1.0 + self.terms.iter().map(|&[weight, omega]| weight * oscillator(s, omega, self.ratio)).sum::<Complex64>()
    }

    fn greatest(&self, lines: &[f64], exact: &[Complex64]) -> f64 {
        let miss = |(f, g): (&f64, &Complex64)| (self.factor(at(*f)) - g).norm() / g.norm();
        lines.iter().zip(exact).map(miss).fold(0.0, |most, miss| if miss > most || miss.is_nan() { miss } else { most })
    }
}

fn at(frequency: f64) -> Complex64 {
    Complex64::new(0.0, TAU * frequency)
}

fn oscillator(s: Complex64, omega: f64, ratio: f64) -> Complex64 {
    let moving = s * s + 2.0 * ratio * omega * s;
    moving / (moving + omega * omega)
}

/// Evenly in the logarithm, both ends told.
fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    let step = (to / from).ln() / (count - 1) as f64;
    (0..count).map(|index| from * (step * index as f64).exp()).collect()
}

/// The $a_i \ge 0$ with small $\sum|g_{fit}-g|^2/|g|^2$: least squares, without the most negative one until none is.
fn weights(lines: &[f64], exact: &[Complex64], omegas: &[f64], ratio: f64) -> Vec<f64> {
    let column = |omega: &f64| -> Vec<Complex64> {
        lines.iter().zip(exact).map(|(f, g)| oscillator(at(*f), *omega, ratio) / g.norm()).collect()
    };
    let columns: Vec<Vec<Complex64>> = omegas.iter().map(column).collect();
    let wanted: Vec<Complex64> = exact.iter().map(|g| (g - 1.0) / g.norm()).collect();
    let inner = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>();
    let mut kept: Vec<usize> = (0..omegas.len()).collect();
    let mut weights = vec![0.0; omegas.len()];
    while !kept.is_empty() {
        let size = |i: usize| inner(&columns[kept[i]], &columns[kept[i]]).sqrt();
        let normal = Mat::from_fn(kept.len(), kept.len(), |i, j| {
            inner(&columns[kept[i]], &columns[kept[j]]) / (size(i) * size(j)) + if i == j { 1e-13 } else { 0.0 }
        });
        let mut solution = Mat::from_fn(kept.len(), 1, |i, _| inner(&columns[kept[i]], &wanted) / size(i));
        let Some(factor) = Cholesky::new(&normal) else { break };
        factor.solve_lower(&mut solution);
        factor.solve_upper(&mut solution);
        let least = (0..kept.len()).min_by(|&i, &j| solution[(i, 0)].total_cmp(&solution[(j, 0)]));
        match least.filter(|&i| solution[(i, 0)] < 0.0) {
            Some(negative) => {
                kept.remove(negative);
            }
            None => {
                (0..kept.len()).for_each(|i| weights[kept[i]] = solution[(i, 0)] / size(i));
                break;
            }
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over two and a half decades, from a standard solid to the flattest law: weights that are never negative, and an error
    /// that is what it says on lines of its own.
    #[test]
    fn val_the_error_stated_is_the_greatest_in_the_band() {
        let band = [30.0, 10_000.0];
        for (strength, tau, alpha) in
            [(0.5, 1e-4, 0.5), (0.1, 1e-4, 0.6), (0.5, 1e-3, 0.8), (3.0, 1e-5, 0.1), (0.3, 1e-4, 1.0), (0.3, 1e-6, 0.4)]
        {
            let core = CoreModulus { strength, tau, alpha };
            let fit = CoreFit::new(&core, band).unwrap();
            assert!(fit.error < 6e-3, "{core:?}: {}", fit.error);
            assert!(fit.terms.len() == TERMS && fit.terms.iter().all(|[weight, omega]| *weight >= 0.0 && *omega > 0.0));
            let lines = spaced(band[0], band[1], 1777);
            let worst = lines.iter().map(|f| {
                let exact = core.factor(at(*f));
                (fit.factor(at(*f)) - exact).norm() / exact.norm()
            });
            let worst = worst.fold(0.0, f64::max);
            assert!((worst / fit.error - 1.0).abs() < 0.02, "{core:?}: {worst} stated {}", fit.error);
        }
    }

    /// A passive modulus loses energy at every frequency, within the band and outside.
    #[test]
    fn val_the_loss_is_never_negative() {
        let fit = CoreFit::new(&CoreModulus { strength: 1.0, tau: 1e-4, alpha: 0.4 }, [50.0, 5000.0]).unwrap();
        for frequency in spaced(1e-3, 1e9, 400) {
            assert!(fit.factor(at(frequency)).im >= 0.0, "{frequency}");
        }
        let whole: f64 = fit.terms.iter().map(|[weight, _]| weight).sum();
        assert!((fit.factor(at(1e-4)).re - 1.0).abs() < 1e-6 && (fit.factor(at(1e12)).re - 1.0 - whole).abs() < 1e-6);
    }

    #[test]
    fn a_band_without_meaning_is_refused() {
        let core = CoreModulus { strength: 0.5, tau: 1e-4, alpha: 0.5 };
        for band in [[0.0, 100.0], [100.0, 10.0], [f64::NAN, 10.0], [1.0, f64::INFINITY]] {
            assert!(CoreFit::new(&core, band).is_err(), "{band:?}");
        }
    }
}
