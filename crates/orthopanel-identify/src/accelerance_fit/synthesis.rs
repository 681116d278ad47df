//! The model's accelerance between two places, with exact derivatives.

use num_complex::Complex64;
use orthopanel_model::SensitiveModes;

use super::line_block::{BLOCK, LineBlock};
use super::smooth_part::SmoothPart;

/// How a mode loses energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DampingLaw {
    /// Viscous, as in eq. 20: $d_m = s^2 + 2\zeta_m\omega_ms + \omega_m^2$.
    #[default]
    Viscous,
    /// Hysteretic, loss factor $\eta_m = 2\zeta_m$: $d_m = s^2 + \omega_m^2(1 + 2j\zeta_m)$.
    Hysteretic,
}

impl DampingLaw {
    /// `viscous` or `hysteretic`.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Viscous => "viscous",
            Self::Hysteretic => "hysteretic",
        }
    }

    pub(super) fn other(self) -> Self {
        match self {
            Self::Viscous => Self::Hysteretic,
            Self::Hysteretic => Self::Viscous,
        }
    }

    /// $(\alpha, \beta)$ of the damping term $\alpha s + j\beta$ of $d_m$.
    fn loss(self, omega: f64, zeta: f64) -> (f64, f64) {
        match self {
            Self::Viscous => (2.0 * zeta * omega, 0.0),
            Self::Hysteretic => (0.0, 2.0 * zeta * omega * omega),
        }
    }

    /// The derivatives of $\alpha$ and $\beta$ by $\omega_m^2$.
    fn loss_by_omega2(self, omega: f64, zeta: f64) -> (f64, f64) {
        match self {
            Self::Viscous => (zeta / omega, 0.0),
            Self::Hysteretic => (0.0, 2.0 * zeta),
        }
    }

    /// $d_m(s)$ less $s^2 + \omega_m^2$: what the mode loses.
    pub(super) fn term(self, omega: f64, zeta: f64, s: Complex64) -> Complex64 {
        let (slope, constant) = self.loss(omega, zeta);
        slope * s + Complex64::new(0.0, constant)
    }
}

/// Terms of the series in $s^2$ that stands for the modes above the sum: with these at least 2.5 times above the band,
/// six leave 2e-5 of a part that is small itself.
const SERIES_TERMS: usize = 6;

/// The accelerance of one pair of places as a sum over modes,
/// $$H(s) = \sum_{rigid}P + \sum_m\frac{P_ms^2}{d_m(s)} + s^2C_0 - s^4C_1 + s^6C_2 - \dots$$
/// with $P_m = W_m(l_1)W_m(l_x)$. $C_0$ is the static flexibility less that of the modes in the sum, so cutting the sum
/// leaves no bias; $C_k = \sum P/\omega^{2(k+1)}$ over the higher modes.
///
/// Only modes with a damping ratio of their own are summed at every line. The rest has no resonance inside the band and
/// is tabulated as a [`SmoothPart`], value and derivatives.
pub(super) struct PairModel {
    law: DampingLaw,
    near: Vec<NearMode>,
    coefficients: usize,
    smooth: SmoothPart,
}

struct NearMode {
    omega2: f64,
    omega: f64,
    zeta: f64,
    product: f64,
    omega2_by: Vec<f64>,
    product_by: Vec<f64>,
}

impl PairModel {
    /// Between places number `force` and `response` of `modes`.
    ///
    /// `flexibility` is the static one with its derivatives; `zetas` has the ratio of every mode in the sum, the first
    /// `near` of which are free; the lines lie at $s = \sigma + j\omega$ with $\sigma$ = `decay_rate`, up to `band` in Hz.
    pub(super) fn new(
        modes: &SensitiveModes,
        (force, response): (usize, usize),
        flexibility: (f64, Vec<f64>),
        law: DampingLaw,
        (zetas, near): (&[f64], usize),
        (decay_rate, band): (f64, f64),
    ) -> Self {
        let mut summed: Vec<NearMode> = modes
            .flexible
            .iter()
            .zip(zetas)
            .map(|(mode, &zeta)| NearMode {
                omega2: mode.omega2,
                omega: mode.omega2.sqrt(),
                zeta,
                product: mode.shape[force] * mode.shape[response],
                omega2_by: mode.omega2_by.clone(),
                product_by: mode
                    .shape_by
                    .iter()
                    .map(|by| by[force] * mode.shape[response] + mode.shape[force] * by[response])
                    .collect(),
            })
            .collect();
        let mut series = [0.0; SERIES_TERMS];
        series[0] = flexibility.0 - summed.iter().map(|mode| mode.product / mode.omega2).sum::<f64>();
        for (omega2, shape) in &modes.higher {
            let mut term = shape[force] * shape[response] / omega2;
            for coefficient in series.iter_mut().skip(1) {
                term /= omega2;
                *coefficient += term;
            }
        }
        // Derivatives of C1 and beyond are left out: too small to steer a search, and the value itself is whole.
        let static_by: Vec<f64> = (0..flexibility.1.len())
            .map(|i| {
                let of_mode = |mode: &NearMode| {
                    (mode.product_by[i] - mode.product * mode.omega2_by[i] / mode.omega2) / mode.omega2
                };
                flexibility.1[i] - summed.iter().map(of_mode).sum::<f64>()
            })
            .collect();
        let rigid: f64 = modes.rigid.iter().map(|shape| shape[force] * shape[response]).sum();
        let far = summed.split_off(near.min(summed.len()));
        let coefficients = static_by.len();
        let smooth = SmoothPart::tabulate(decay_rate, band, 1 + coefficients, |s, out| {
            let Some((value, by_coefficients)) = out.split_first_mut() else { return };
            let power = |s2| series.iter().rev().fold(Complex64::ZERO, |sum, coefficient| *coefficient - s2 * sum);
            *value = LineBlock::filled(s.values().map(|s| s * s * power(s * s) + rigid));
            for (total, by) in by_coefficients.iter_mut().zip(&static_by) {
                *total = LineBlock::filled(s.values().map(|s| s * s * *by));
            }
            let mut unused = LineBlock::ZERO;
            for mode in &far {
                mode.add(law, s, out, &mut unused);
            }
        });
        Self { law, near: summed, coefficients, smooth }
    }

    /// Number of the structure's coefficients.
    pub(super) fn coefficients(&self) -> usize {
        self.coefficients
    }

    /// Number of functions that [`Self::lines`] writes.
    pub(super) fn functions(&self) -> usize {
        1 + self.coefficients + self.near.len()
    }

    /// Writes into `out`: $H(s)$, its derivatives by the structure's coefficients, then by each near mode's $\ln\zeta$.
    pub(super) fn lines(&self, s: &LineBlock, out: &mut [LineBlock]) {
        let (structural, by_zeta) = out.split_at_mut((1 + self.coefficients).min(out.len()));
        self.smooth.at(s, structural);
        for (mode, by) in self.near.iter().zip(by_zeta) {
            mode.add(self.law, s, structural, by);
        }
    }
}

impl NearMode {
    /// Adds the mode's part to value and derivatives by coefficients; writes that by $\ln\zeta$.
    fn add(&self, law: DampingLaw, s: &LineBlock, out: &mut [LineBlock], by_log_zeta: &mut LineBlock) {
        let (slope, constant) = law.loss(self.omega, self.zeta);
        let (slope_by, constant_by) = law.loss_by_omega2(self.omega, self.zeta);
        let (mut gain, mut by_omega2) = (LineBlock::ZERO, LineBlock::ZERO);
        for line in 0..BLOCK {
            let (a, b) = (s.re[line], s.im[line]);
            let (s2_re, s2_im) = (a * a - b * b, 2.0 * a * b);
            let (loss_re, loss_im) = (slope * a, slope * b + constant);
            let (d_re, d_im) = (s2_re + loss_re + self.omega2, s2_im + loss_im);
            let scale = 1.0 / (d_re * d_re + d_im * d_im);
            let (inverse_re, inverse_im) = (d_re * scale, -d_im * scale);
            let (gain_re, gain_im) = (s2_re * inverse_re - s2_im * inverse_im, s2_re * inverse_im + s2_im * inverse_re);
            // By d itself: -P s²/d².
            let by_re = -self.product * (gain_re * inverse_re - gain_im * inverse_im);
            let by_im = -self.product * (gain_re * inverse_im + gain_im * inverse_re);
            let (d_by_re, d_by_im) = (1.0 + slope_by * a, slope_by * b + constant_by);
            (gain.re[line], gain.im[line]) = (gain_re, gain_im);
            by_omega2.re[line] = by_re * d_by_re - by_im * d_by_im;
            by_omega2.im[line] = by_re * d_by_im + by_im * d_by_re;
            by_log_zeta.re[line] = by_re * loss_re - by_im * loss_im;
            by_log_zeta.im[line] = by_re * loss_im + by_im * loss_re;
        }
        let Some((value, by_coefficients)) = out.split_first_mut() else { return };
        value.add_multiple(&gain, self.product);
        for ((total, omega2_by), product_by) in by_coefficients.iter_mut().zip(&self.omega2_by).zip(&self.product_by) {
            total.add_multiple(&by_omega2, *omega2_by);
            total.add_multiple(&gain, *product_by);
        }
    }
}
