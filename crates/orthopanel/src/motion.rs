//! What a response place does.

/// What one response place does, sample by sample.
#[derive(Debug, Clone, Default)]
pub struct Motion {
    /// \[m/s²\]
    pub acceleration: Vec<f64>,
    /// \[m/s\]
    pub velocity: Vec<f64>,
    /// \[m\]
    pub displacement: Vec<f64>,
}

impl Motion {
    /// Greatest size of the acceleration \[m/s²\]; zero where there is none.
    pub fn peak_acceleration(&self) -> f64 {
        self.acceleration.iter().fold(0.0, |peak, value| peak.max(value.abs()))
    }
}
