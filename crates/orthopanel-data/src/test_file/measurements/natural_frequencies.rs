//! A list of natural frequencies.

use orthopanel_model::Place;

/// Natural frequencies of the flexible modes.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalFrequencies {
    /// Frequencies \[Hz\], rising (with `shape` the file may list them in any order); the beam's flexible modes 1, 2, ... where
    /// `shape` is empty.
    pub values: Vec<f64>,
    /// Bin width of the analyser \[Hz\], one a mode; empty where the file says nothing.
    pub resolution: Vec<f64>,
    /// Standard deviation \[Hz\] by which each is known to miss a model that lacks nothing, as repeated tests tell it, one a
    /// mode; empty where the file says nothing.
    pub scatter: Vec<f64>,
    /// Nodal lines crossed along x and along y, one pair a mode; empty for a beam.
    pub shape: Vec<[u32; 2]>,
    /// Place of the sensor, where known: its mass lowers the frequencies.
    pub response_at: Option<Place>,
}

impl NaturalFrequencies {
    /// The same lines in rising order.
    pub(super) fn rising(self) -> Self {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        let sorted = |of: &[f64]| order.iter().filter_map(|&line| of.get(line).copied()).collect();
        Self {
            values: sorted(&self.values),
            resolution: sorted(&self.resolution),
            scatter: sorted(&self.scatter),
            shape: order.iter().filter_map(|&line| self.shape.get(line).copied()).collect(),
            response_at: self.response_at,
        }
    }
}
