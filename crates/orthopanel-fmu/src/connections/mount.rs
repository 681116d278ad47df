//! A mount: a spring and a dashpot.

use orthopanel_model::Place;
use serde::{Deserialize, Serialize};

/// A spring and a dashpot at one place of the panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mount {
    /// Name, which stands in those of its variables.
    pub name: String,
    /// Where it holds the panel.
    pub at: Place,
    /// $k$ \[N/m\].
    pub stiffness: f64,
    /// $c$ \[N s/m\].
    pub damping: f64,
}
