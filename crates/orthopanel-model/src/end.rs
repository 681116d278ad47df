//! What holds one edge of a piece.

use serde::{Deserialize, Serialize};

/// What holds one edge: the end of a beam, or an edge of a plate.
///
/// On a plate $\psi$ is the rotation across the edge, counted as in the beam, and $\psi_s$ the one along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// No moment and no shear force (eq. 6): $\psi' = 0$, $w' + \psi = 0$; on a plate no twisting moment either.
    #[default]
    Free,
    /// No deflection and no moment: $w = 0$, $\psi' = 0$; on a plate $\psi_s = 0$ too (hard simple support, Navier's).
    Pinned,
    /// No deflection and no rotation: $w = 0$, $\psi = 0$; on a plate $\psi_s = 0$ too.
    Clamped,
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Free => "free",
            Self::Pinned => "pinned",
            Self::Clamped => "clamped",
        })
    }
}
