//! Measured modes: what any data say of a test before any physics is asked.
//!
//! Every kind of data becomes [`MeasuredModes`]: poles common to the records, the residues of every record, what modes
//! below and above the band leave of it, and the covariance that the noise of the data gives all of these together.

mod accelerances;
mod frequencies;
mod hits;
mod line_groups;
mod lines;
mod modal_fit;
mod pole_search;
mod records;
#[cfg(test)]
mod tests;

use faer::Mat;
use num_complex::Complex64;
use orthopanel_model::Place;

/// Poles, residues and remainders of a set of records of one piece, with their covariance.
///
/// With $R$ records and $M$ modes the accelerance of record $r$ is
/// $$H_r(s) = \sum_{m=1}^{M}\left(\frac{q_{rm}}{s-\lambda_m} + \frac{\bar q_{rm}}{s-\bar\lambda_m}\right) + B_r(s),\qquad
/// \lambda_m = \omega_m\left(-\zeta_m + j\sqrt{1-\zeta_m^2}\right),$$
/// with $e^{+j\omega t}$. The remainder $B_r$ holds rigid modes, modes outside the band and every mode inside it whose skirts leave
/// the band. It is known as values at [`MeasuredModes::remainder_frequencies`], $s = 2\pi jf$, never as coefficients:
/// these are strongly correlated, the values are not.
#[derive(Debug, Clone)]
pub(crate) struct MeasuredModes {
    /// The poles, rising in frequency.
    pub poles: Vec<Pole>,
    /// One entry a record; empty where only frequencies were measured.
    pub records: Vec<MeasuredRecord>,
    /// Where the remainders are given \[Hz\], rising.
    pub remainder_frequencies: Vec<f64>,
    /// Lowest and highest frequency of the records \[Hz\]: no mode between them that the places can show is missing from `poles` by
    /// being outside.
    pub band: [f64; 2],
    /// Covariance of [`MeasuredModes::values`]: symmetric, in the same order.
    pub covariance: Mat<f64>,
    /// Misfit of the modal fit per degree of freedom in units of the noise, by which the covariance is scaled already; `None` for lists.
    pub chi_square: Option<f64>,
}

/// A pole common to all records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pole {
    /// Undamped natural angular frequency $\omega_m$ \[rad/s\].
    pub angular_frequency: f64,
    /// Damping ratio $\zeta_m$; `None` where only frequencies were measured.
    pub damping_ratio: Option<f64>,
}

/// What one record, a pair of places, shows of the modes.
#[derive(Debug, Clone)]
pub(crate) struct MeasuredRecord {
    /// Where the force acts.
    pub force_at: Place,
    /// Where the acceleration is measured.
    pub response_at: Place,
    /// $q_{rm}$ \[(m/s²)/N · 1/s\], one a pole.
    pub residues: Vec<Complex64>,
    /// $B_r$ \[(m/s²)/N\] at each of the remainder's frequencies.
    pub remainder: Vec<Complex64>,
}

impl Pole {
    /// $\lambda = \omega(-\zeta + j\sqrt{1-\zeta^2})$ \[rad/s\]; undamped where the damping is not known.
    pub(crate) fn lambda(&self) -> Complex64 {
        let zeta = self.damping_ratio.unwrap_or(0.0);
        self.angular_frequency * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt())
    }
}

impl MeasuredModes {
    /// All measured values in the order of the covariance: $\ln\omega_m$ of every pole; $\ln\zeta_m$ of every pole that tells it; then
    /// record by record the real and the imaginary part of each residue in turn, and of each value of the remainder.
    pub(crate) fn values(&self) -> Vec<f64> {
        let frequencies = self.poles.iter().map(|pole| pole.angular_frequency.ln());
        let damping = self.poles.iter().filter_map(|pole| pole.damping_ratio.map(f64::ln));
        let parts = |value: &Complex64| [value.re, value.im];
        let records = self.records.iter().flat_map(|record| record.residues.iter().chain(&record.remainder));
        frequencies.chain(damping).chain(records.flat_map(parts)).collect()
    }
}
