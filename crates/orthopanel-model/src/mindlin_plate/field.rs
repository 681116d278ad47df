//! The three fields of a plate.

/// What moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Field {
    /// $w$.
    Deflection,
    /// $\psi_x$.
    RotationX,
    /// $\psi_y$.
    RotationY,
}

impl Field {
    pub(super) const ALL: [Self; 3] = [Self::Deflection, Self::RotationX, Self::RotationY];
}
