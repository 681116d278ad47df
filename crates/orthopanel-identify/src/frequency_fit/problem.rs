//! Eq. 22 over the measurements of a test.

use faer::Mat;
use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::{BEAM_CONSTANTS, Boundary, Constant, Piece};

use super::prediction::{Prediction, beam_frequencies, beam_predictions};
use crate::IdentifyError;
use crate::elastic_constants::held_constants;
use crate::least_squares::Linearised;

/// Measured frequencies of one piece.
#[derive(Debug, Clone)]
pub(super) struct FrequencySet {
    /// Index of the piece in the test.
    pub piece: usize,
    pub sizes: Piece,
    pub boundary: Boundary,
    /// Frequencies \[Hz\] of flexible modes 1, 2, ...
    pub measured: Vec<f64>,
    /// Standard deviation of each by rounding to a bin \[Hz\], where the bin is stated.
    pub rounding: Vec<f64>,
}

impl FrequencySet {
    pub(super) fn frequencies(&self, constants: &[f64; 2]) -> Result<Vec<f64>, IdentifyError> {
        Ok(beam_frequencies(&self.sizes, self.boundary, *constants, self.measured.len())?)
    }

    pub(super) fn predict(&self, constants: &[f64; 2]) -> Result<Vec<Prediction>, IdentifyError> {
        Ok(beam_predictions(&self.sizes, self.boundary, *constants, self.measured.len())?)
    }
}

/// The measurements, and which constants are free.
#[derive(Debug, Clone)]
pub(super) struct FrequencyProblem {
    pub constants: [Constant; 2],
    /// Values of the constants that are held; free ones are `None`.
    pub held: [Option<f64>; 2],
    /// Positions of the free constants.
    pub free: Vec<usize>,
    pub sets: Vec<FrequencySet>,
}

impl FrequencyProblem {
    pub(super) fn of(test: &ImpactTest) -> Result<Self, IdentifyError> {
        let constants = BEAM_CONSTANTS;
        let held = held_constants(test)?;
        let free: Vec<usize> = (0..constants.len()).filter(|&index| held[index].is_none()).collect();
        let sets = frequency_sets(test)?;
        let problem = Self { constants, held, free, sets };
        if problem.count() < problem.free.len() {
            return Err(IdentifyError::TooFewFrequencies {
                found: problem.count(),
                needed: problem.free.len(),
                names: problem.free.iter().map(|&index| constants[index].name).collect::<Vec<_>>().join(", "),
            });
        }
        Ok(problem)
    }

    /// Number of measured frequencies.
    pub(super) fn count(&self) -> usize {
        self.sets.iter().map(|set| set.measured.len()).sum()
    }

    /// All constants at these logarithms of the free ones.
    pub(super) fn values(&self, logs: &[f64]) -> [f64; 2] {
        let mut values = self.held.map(|held| held.unwrap_or(f64::NAN));
        for (&index, log) in self.free.iter().zip(logs) {
            // exp(ln x) may pass a bound by rounding.
            values[index] = log.exp().clamp(self.constants[index].low, self.constants[index].high);
        }
        values
    }

    /// Bounds of the free constants' logarithms.
    pub(super) fn log_bounds(&self) -> Vec<(f64, f64)> {
        self.free.iter().map(|&index| (self.constants[index].low.ln(), self.constants[index].high.ln())).collect()
    }

    /// Relative residuals $(f_{cal}-f_{exp})/f_{exp}$ and their derivatives by the logarithms.
    pub(super) fn linearise(&self, logs: &[f64]) -> Result<Linearised, IdentifyError> {
        let values = self.values(logs);
        let mut residuals = Vec::with_capacity(self.count());
        let mut rows = Vec::with_capacity(self.count());
        for set in &self.sets {
            let predicted = set.predict(&values)?;
            for (prediction, measured) in predicted.iter().zip(&set.measured) {
                let ratio = prediction.frequency / measured;
                residuals.push(ratio - 1.0);
                rows.push(prediction.log_sensitivity.map(|sensitivity| ratio * sensitivity));
            }
        }
        let jacobian = Mat::from_fn(rows.len(), self.free.len(), |i, j| rows[i][self.free[j]]);
        Ok(Linearised { residuals, jacobian })
    }

    /// Eq. 22.
    pub(super) fn error(&self, logs: &[f64]) -> Result<f64, IdentifyError> {
        let values = self.values(logs);
        let mut sum = 0.0;
        for set in &self.sets {
            let pairs = set.frequencies(&values)?.into_iter().zip(&set.measured);
            sum += pairs.map(|(calculated, measured)| (calculated / measured - 1.0).powi(2)).sum::<f64>();
        }
        Ok(sum / self.count() as f64)
    }
}

fn frequency_sets(test: &ImpactTest) -> Result<Vec<FrequencySet>, IdentifyError> {
    let mut sets = Vec::new();
    for measurement in &test.measurements {
        let MeasurementData::NaturalFrequencies(data) = &measurement.data else { continue };
        if data.shape.iter().any(|nodes| nodes[1] > 0) {
            let message = "shapes with nodal lines along y need the plate, which this version does not have";
            return Err(IdentifyError::Unsupported(message.to_owned()));
        }
        sets.push(FrequencySet {
            piece: measurement.piece,
            sizes: test.pieces[measurement.piece].piece,
            boundary: test.boundary,
            measured: data.values.clone(),
            // A value rounded to a bin is uniform over it.
            rounding: data.resolution.iter().map(|bin| bin / 12.0_f64.sqrt()).collect(),
        });
    }
    Ok(sets)
}
