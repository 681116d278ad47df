//! The modes of a plate alone, beside those with what stands on it.

/// Modes of a plate without what stands on it, but with its patches: a patch has lost the damping that goes with its stiffness, so that these do not couple.
/// The shapes beyond the modes, under what stands there and under the ports, have modes of their own among them, so that shares are complete.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OwnModes {
    /// $\Omega_m$ \[rad/s\]; none where nothing stands on the plate.
    pub angular_frequency: Vec<f64>,
    /// Of each mode with what stands there its shares of these.
    pub shares: Vec<Vec<f64>>,
}
