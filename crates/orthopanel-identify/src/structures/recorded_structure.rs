//! What a fit of accelerances asks of a piece's structure.

use faer::Mat;
use orthopanel_model::{ModelError, Place, SensitiveModes};

/// A flexible mode as the records of a piece see it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SeenMode {
    /// Natural frequency \[Hz\].
    pub frequency: f64,
    /// Nodal lines across x and across y.
    pub nodes: [usize; 2],
    /// $W(l_1)W(l_x)$ of each record.
    pub products: Vec<f64>,
    /// $\partial\ln f/\partial c_j$ for each constant.
    pub by_constant: Vec<f64>,
}

/// A piece with a structure whose constants are to be found.
pub(crate) trait RecordedStructure: Send + Sync {
    /// The lowest flexible modes, at least as many as lie below `limit` \[Hz\], as far as the structure resolves them;
    /// `pairs` are force and response of each record.
    fn modes_below(&self, values: &[f64], limit: f64, pairs: &[(Place, Place)]) -> Result<Vec<SeenMode>, ModelError>;

    /// Up to where modes are summed one by one, in bands of the records.
    fn reach(&self) -> f64;

    /// What sums `count` modes line by line.
    fn synthesis(&self, values: &[f64], count: usize) -> Result<Box<dyn ModeSynthesis>, ModelError>;
}

/// The modes behind the sum over a record's lines.
pub(crate) trait ModeSynthesis: Send + Sync {
    /// Modes at these places: `count` with derivatives by the structure's coefficients, the higher ones without.
    fn modes(&self, values: &[f64], count: usize, places: &[Place]) -> Result<SensitiveModes, ModelError>;

    /// Static flexibility \[m/N\] between places number `pair` of `places`, and its derivatives by the coefficients.
    fn flexibility(
        &self,
        modes: &SensitiveModes,
        places: &[Place],
        pair: (usize, usize),
        values: &[f64],
    ) -> (f64, Vec<f64>);

    /// $\partial c_i/\partial p_j$ of the coefficients by the constants.
    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError>;

    /// What sums `count` modes at these places quickly near these values, with the same modes and derivatives there, and less
    /// well further off; `None` where this one is quick.
    fn near(
        &self,
        _values: &[f64],
        _count: usize,
        _places: &[Place],
    ) -> Result<Option<Box<dyn ModeSynthesis>>, ModelError> {
        Ok(None)
    }
}
