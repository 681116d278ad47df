//! The measured modes of a piece, as each structure predicts them.

use orthopanel_model::{ModelError, RitzMode};

/// One measured mode at given constants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Prediction {
    /// Natural frequency \[Hz\].
    pub frequency: f64,
    /// $\partial\ln f/\partial c_j$ for each constant.
    pub by_constant: Vec<f64>,
    /// Share of its motion, 0 to 1, that the nodal lines by which it is told have.
    pub share: f64,
}

/// The measured modes at given constants, and the shapes that they were found among, where these help to solve again.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Solved {
    pub predictions: Vec<Prediction>,
    pub shapes: Vec<RitzMode>,
}

/// One flexible mode of a structure, whether it was measured or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpectrumLine {
    /// Natural frequency \[Hz\].
    pub frequency: f64,
    /// Nodal lines across x and across y.
    pub nodes: [usize; 2],
}

/// Predicts the modes of one piece that a test measures, in the test's order.
pub(crate) trait MeasuredModes: std::fmt::Debug + Send + Sync {
    /// The same, sooner from shapes that are nearly those of the modes.
    fn solve(&self, values: &[f64], _known: &[RitzMode]) -> Result<Solved, ModelError> {
        Ok(Solved { predictions: self.predict(values)?, shapes: Vec::new() })
    }

    /// The shapes alone.
    fn shapes(&self, _values: &[f64]) -> Result<Vec<RitzMode>, ModelError> {
        Ok(Vec::new())
    }

    /// Natural frequencies \[Hz\] to some per cent, for a start.
    fn rough_frequencies(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        self.frequencies(values)
    }

    /// Natural frequencies \[Hz\] alone.
    fn frequencies(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        Ok(self.predict(values)?.into_iter().map(|prediction| prediction.frequency).collect())
    }

    /// Frequencies with derivatives by every constant.
    fn predict(&self, values: &[f64]) -> Result<Vec<Prediction>, ModelError>;

    /// Nodal lines across x and across y of each measured mode.
    fn nodes(&self) -> &[[usize; 2]];

    /// All flexible modes of the structure, rising, up to the last measured one and some beyond.
    fn spectrum(&self, values: &[f64]) -> Result<Vec<SpectrumLine>, ModelError>;

    /// The number, from 1, that each of these frequencies \[Hz\] of modes has among all flexible modes.
    fn numbers(&self, values: &[f64], frequencies: &[f64]) -> Result<Vec<usize>, ModelError> {
        let spectrum = self.spectrum(values)?;
        let below = |frequency: &f64| spectrum.partition_point(|line| line.frequency < just_below(*frequency));
        Ok(frequencies.iter().map(|frequency| below(frequency) + 1).collect())
    }

    /// What predicts the same quickly near these values, where the modes have these shapes, and less well further off;
    /// `None` where this one is quick.
    fn near(&self, _values: &[f64], _shapes: &[RitzMode]) -> Result<Option<Box<dyn MeasuredModes>>, ModelError> {
        Ok(None)
    }
}

/// Below a mode's frequency and above that of any other that differs from it: bases that are the same but for what they
/// leave out agree to rounding.
pub(crate) fn just_below(frequency: f64) -> f64 {
    frequency * (1.0 - 1e-6)
}
