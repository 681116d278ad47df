//! What is measured of one piece: poles, residues and remainders with their covariance.

use faer::Mat;
use num_complex::Complex64;
use orthopanel_model::{NamedShapes, Place};

use super::joint_fit;

/// Poles, residues and remainders of a set of records of one piece, with their covariance.
///
/// The poles are those of a joint fit: $\omega_m$ and $\zeta_m$ in common, everything linear projected out record by record (variable projection:
/// Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973; Kaufman, BIT 15, 1975). Hits are not windowed: what the end of a record cuts off a
/// vibration that rings on is part of the fit. A pole is kept where it lowers the misfit by more than the logarithm of the number of data
/// for each of its parameters (Schwarz, Ann. Stat. 6, 1978).
///
/// # Limits
/// Modes much closer than their half-width are told apart by several places alone. A panel whose frequencies change from hit to hit, or whose force is not
/// linear, shows a `chi_square` far above one, and its poles are no modes. The covariance holds the noise of the data, not what hits fall beside their
/// marks or records differ in gain.
///
/// With $R$ records and $M$ modes the accelerance of record $r$ is
/// $$H_r(s) = \sum_{m=1}^{M}\left(\frac{q_{rm}}{s-\lambda_m} + \frac{\bar q_{rm}}{s-\bar\lambda_m}\right) + B_r(s),\qquad
/// \lambda_m = \omega_m\left(-\zeta_m + j\sqrt{1-\zeta_m^2}\right),$$
/// with $e^{+j\omega t}$. The remainder $B_r$ holds rigid modes, modes outside the band and every mode inside it whose skirts leave
/// the band. It is known as values at [`MeasuredModes::remainder_frequencies`], $s = 2\pi jf$, never as coefficients:
/// these are strongly correlated, the values are not.
#[derive(Debug, Clone)]
pub struct MeasuredModes {
    /// Index of the piece in the test, from 0.
    pub piece: usize,
    /// The poles, rising in frequency.
    pub poles: Vec<Pole>,
    /// Poles of the fit that do not stand by themselves, as those whose skirts leave the band: what they are is part of the remainders.
    pub beside: Vec<Pole>,
    /// One entry a record; empty where only frequencies were measured.
    pub records: Vec<MeasuredRecord>,
    /// Where a sensor sat while only frequencies were measured, if that is told.
    pub sensor_at: Option<Place>,
    /// Where the remainders are given \[Hz\], rising.
    pub remainder_frequencies: Vec<f64>,
    /// Lowest and highest frequency that was fitted \[Hz\].
    pub band: [f64; 2],
    /// Covariance of [`MeasuredModes::values`]: symmetric, in the same order.
    pub covariance: Mat<f64>,
    /// Misfit of the modal fit per degree of freedom in units of the noise, by which the covariance is scaled already; `None` for lists.
    pub chi_square: Option<f64>,
    /// Frequency of the line \[Hz\] that the modal fit misses most, over its noise; `None` for lists.
    pub missed_most: Option<f64>,
    /// Decay rate \[1/s\] of the noise of the hits, as under an exponential window, which poles, residues and remainders are free of; mostly zero.
    pub undone_decay: f64,
    /// Shapes by which a plate's list names its poles.
    pub(crate) named: NamedShapes,
    /// Of the list of a beam that passes modes over the number of each pole among those that bend along, from 0; empty where none is passed over.
    pub(crate) order: Vec<usize>,
}

impl MeasuredModes {
    /// Number of a pole of a list among the modes of a beam, from 0.
    pub(crate) fn number_in_order(&self, pole: usize) -> usize {
        self.order.get(pole).copied().unwrap_or(pole)
    }

    /// Modes of a beam up to the last one that a list holds.
    pub(crate) fn modes_in_order(&self) -> usize {
        self.order.iter().max().map_or(self.poles.len(), |last| last + 1)
    }

    /// Whether records hold what neither poles nor noise make, as a tone beside the response or a force that is not linear.
    pub(crate) fn is_not_modal(&self) -> bool {
        self.chi_square.is_some_and(|chi_square| chi_square > joint_fit::SYSTEMATIC)
    }
}

/// A pole common to all records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pole {
    /// Undamped natural angular frequency $\omega_m$ \[rad/s\].
    pub angular_frequency: f64,
    /// Damping ratio $\zeta_m$; `None` where only frequencies were measured.
    pub damping_ratio: Option<f64>,
}

/// What one record, a pair of places, shows of the modes.
#[derive(Debug, Clone)]
pub struct MeasuredRecord {
    /// Where the force acts.
    pub force_at: Place,
    /// Where the acceleration is measured.
    pub response_at: Place,
    /// $q_{rm}$ \[(m/s²)/N · 1/s\], one a pole.
    pub residues: Vec<Complex64>,
    /// $B_r$ \[(m/s²)/N\] at each of the remainder's frequencies.
    pub remainder: Vec<Complex64>,
}

/// Nodal lines across x and across y of each pole of a list, where they are told.
pub(crate) type Names = Vec<Option<[usize; 2]>>;
