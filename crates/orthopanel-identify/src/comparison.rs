//! What is compared: measured and predicted frequencies, residues and remainders, in one list of numbers.

use std::ops::Range;

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};
use num_complex::Complex64;

use crate::measured::MeasuredModes;
use crate::whitening::Split;

/// Predicted modes without a pole that are counted, the strongest first.
pub(crate) const UNSEEN: usize = 4;
/// What a predicted mode without a pole may have of a typical residue: so weak a mode is not found.
const UNSEEN_DEVIATION: f64 = 0.01;
/// What the carrier itself misses of the logarithm of a frequency: residual shapes stand for all modes beyond.
const CARRIER: f64 = 2e-6;

/// Deviation of the logarithm of what damps a mode beside effects: damping ratios of a panel lie within a factor of three of each other.
pub(crate) const OWN_DAMPING: f64 = 1.1;
/// Least part of the usual damping ratio that the logarithm is taken of: a hypothesis may leave a mode less than none, as far from where it ends.
const LEAST_DAMPING: f64 = 0.05;

/// What the few terms of a series miss of a remainder, or of its deviation where that is larger: they make all its values follow from a few.
const SERIES: f64 = 1e-3;

/// Values from which on their covariance is split: its factor takes more time than that.
const MANY: usize = 400;

/// The measured values in units that make them alike, with the covariance of their noise: $\ln\omega_m$ of each pole; a record after the
/// other its residues over the rms of that pole's, and its remainder times the mass of the piece, each as real and imaginary part;
/// then a zero for each predicted mode that no pole belongs to, and for what damps each pole beside effects as much as usual.
pub(crate) struct Comparison<'a> {
    pub measured: &'a MeasuredModes,
    /// Rms over the records of each pole's residues.
    pub residue: Vec<f64>,
    /// Accelerance of the piece as a rigid body at its centre \[1/kg\].
    pub rigid: f64,
    /// Median of the damping ratios.
    damping: f64,
    pub values: Vec<f64>,
    pub noise: Mat<f64>,
}

impl<'a> Comparison<'a> {
    pub(crate) fn new(measured: &'a MeasuredModes, mass: f64) -> Self {
        let (poles, records) = (measured.poles.len(), measured.records.len());
        let rms = |pole: usize| {
            let squares: f64 = measured.records.iter().map(|record| record.residues[pole].norm_sqr()).sum();
            (squares / records.max(1) as f64).sqrt().max(f64::MIN_POSITIVE)
        };
        let residue: Vec<f64> = (0..poles).map(rms).collect();
        let mut ratios: Vec<f64> = measured.poles.iter().filter_map(|pole| pole.damping_ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let damping = ratios.get(ratios.len() / 2).copied().unwrap_or(1.0);
        let mut comparison =
            Self { measured, residue, rigid: mass.recip(), damping, values: vec![], noise: Mat::new() };
        let scales: Vec<f64> = (0..comparison.size()).map(|place| comparison.scale(place)).collect();
        let damped = ratios.len();
        // Damping ratios are nearly free: what effects leave of them stands at the end.
        let own = |place: usize| if place < poles { place } else { place + damped };
        let measured_values = measured.values();
        let told = comparison.unseen().start;
        comparison.values = (0..comparison.size())
            .map(|place| if place < told { measured_values[own(place)] / scales[place] } else { 0.0 })
            .collect();
        comparison.noise = Mat::from_fn(comparison.size(), comparison.size(), |i, j| {
            let of_noise = if i < told && j < told {
                measured.covariance[(own(i), own(j))] / (scales[i] * scales[j])
            } else {
                0.0
            };
            let beside = match i {
                _ if i != j => 0.0,
                _ if i < poles => CARRIER.powi(2),
                _ if i < told && comparison.is_remainder(i) => {
                    SERIES.powi(2) * of_noise.max(comparison.variance_of_size(i))
                }
                _ if i < told => f64::EPSILON,
                _ if i < comparison.unseen().end => UNSEEN_DEVIATION.powi(2),
                _ => OWN_DAMPING.powi(2),
            };
            of_noise + beside
        });
        comparison
    }

    /// The ranges that noise and the errors of each record tie together, and what the noise of the poles brings to all: given the poles, records
    /// are independent. `None` where there are few values.
    pub(crate) fn split(&self) -> Option<Split> {
        let (poles, records, size) = (self.measured.poles.len(), self.measured.records.len(), self.size());
        if size < MANY {
            return None;
        }
        let damped = self.measured.poles.iter().filter(|pole| pole.damping_ratio.is_some()).count();
        let of_poles = poles + damped;
        let own = |place: usize| if place < poles { place } else { place + damped };
        let covariance = &self.measured.covariance;
        let factor = covariance.submatrix(0, 0, of_poles, of_poles).llt(Side::Lower).ok()?;
        let told = self.unseen().start;
        // A row a value: its covariance with the poles, times $L^{-T}$.
        let mut common = Mat::from_fn(of_poles, size, |pole, place| {
            if place < told { covariance[(own(place), pole)] / self.scale(place) } else { 0.0 }
        });
        solve_lower_triangular_in_place(factor.L(), common.as_mut(), Par::Seq);
        let records = (0..records).map(|record| self.block_of(record));
        let ranges = std::iter::once(0..poles).chain(records).chain(std::iter::once(told..size));
        let ranges = ranges.filter(|range| !range.is_empty());
        Some(Split { ranges: ranges.collect(), common: common.transpose().to_owned() })
    }

    /// Number of values.
    pub(crate) fn size(&self) -> usize {
        self.own_damping_place(self.measured.poles.len())
    }

    /// Where a residue's real part stands; the imaginary part follows.
    pub(crate) fn residue_place(&self, record: usize, pole: usize) -> usize {
        self.measured.poles.len() + record * self.block() + 2 * pole
    }

    /// Where the real part of a value of a remainder stands.
    pub(crate) fn remainder_place(&self, record: usize, number: usize) -> usize {
        self.residue_place(record, self.measured.poles.len() + number)
    }

    /// The record that a value is of; `None` of what all have together.
    pub(crate) fn record_of(&self, place: usize) -> Option<usize> {
        let record = place.checked_sub(self.measured.poles.len())? / self.block().max(1);
        (record < self.measured.records.len()).then_some(record)
    }

    /// Where the modes without a pole stand.
    pub(crate) fn unseen(&self) -> Range<usize> {
        let from = self.measured.poles.len() + self.measured.records.len() * self.block();
        let count = if self.measured.records.is_empty() { 0 } else { UNSEEN };
        from..from + count
    }

    /// Where stands what damps a pole beside effects.
    pub(crate) fn own_damping_place(&self, pole: usize) -> usize {
        self.unseen().end + if self.measured.records.is_empty() { 0 } else { pole }
    }

    /// The logarithm of what damps a pole beside effects over what is usual.
    pub(crate) fn own_damping(&self, pole: usize, of_effects: f64) -> f64 {
        let own = (self.measured.poles[pole].damping_ratio.unwrap_or(self.damping) - of_effects) / self.damping;
        own.max(LEAST_DAMPING).ln()
    }

    /// All values of a record.
    pub(crate) fn block_of(&self, record: usize) -> Range<usize> {
        self.residue_place(record, 0)..self.residue_place(record + 1, 0)
    }

    /// Variance of a value that tells no more than its size.
    pub(crate) fn variance_of_size(&self, place: usize) -> f64 {
        self.values[place].powi(2).max(1.0)
    }

    fn block(&self) -> usize {
        2 * (self.measured.poles.len() + self.measured.remainder_frequencies.len())
    }

    fn is_remainder(&self, place: usize) -> bool {
        let poles = self.measured.poles.len();
        place >= poles && (place - poles) % self.block() >= 2 * poles
    }

    fn scale(&self, place: usize) -> f64 {
        let poles = self.measured.poles.len();
        match place.checked_sub(poles) {
            None => 1.0,
            Some(_) if place >= self.unseen().start => 1.0,
            Some(within) => self.residue.get(within % self.block() / 2).copied().unwrap_or(self.rigid),
        }
    }

    /// Puts a complex number at a place and the next, in the units of the values.
    pub(crate) fn put(&self, values: &mut [f64], place: usize, value: Complex64) {
        let scale = self.scale(place);
        values[place] = value.re / scale;
        values[place + 1] = value.im / scale;
    }
}
