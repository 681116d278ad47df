//! A resonance of the records: natural frequency and damping.

/// One resonance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pole {
    /// Natural frequency \[Hz\].
    pub frequency: f64,
    /// Standard deviation of the frequency's logarithm.
    pub log_frequency_std: f64,
    /// Damping ratio and the standard deviation of its logarithm.
    pub zeta: f64,
    pub log_zeta_std: f64,
}

impl Pole {
    /// Standard deviation of the frequency \[Hz\].
    pub(super) fn frequency_std(&self) -> f64 {
        self.frequency * self.log_frequency_std
    }

    /// $\zeta\omega$ \[1/s\].
    pub(super) fn decay_rate(&self) -> f64 {
        self.zeta * std::f64::consts::TAU * self.frequency
    }
}
