//! How the ends of a piece are held.

use serde::{Deserialize, Serialize};

/// What holds one end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum End {
    /// No moment and no shear force (eq. 6): $\psi' = 0$, $w' + \psi = 0$.
    #[default]
    Free,
    /// No deflection and no moment: $w = 0$, $\psi' = 0$.
    Pinned,
    /// No deflection and no rotation: $w = 0$, $\psi = 0$.
    Clamped,
}

/// The two ends of a beam: `left` at $x = -a/2$, `right` at $x = +a/2$. Free-free unless said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Boundary {
    /// The end at $x = -a/2$.
    pub left: End,
    /// The end at $x = +a/2$.
    pub right: End,
}

impl Boundary {
    /// Both ends free, as hung in the paper's tests.
    pub const FREE: Self = Self { left: End::Free, right: End::Free };

    /// Number of rigid modes: 2 free-free, 1 where one end is pinned and the other free, else 0.
    pub fn rigid_modes(self) -> usize {
        match (self.left, self.right) {
            (End::Free, End::Free) => 2,
            (End::Free, End::Pinned) | (End::Pinned, End::Free) => 1,
            _ => 0,
        }
    }
}
