//! Damping of a panel's modes.

use serde::{Deserialize, Serialize};

use crate::ModelError;

/// Modal damping ratios $\zeta_m$ of the flexible modes in order, and one for all modes beyond the list.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// $\zeta_1, \zeta_2, \dots$ \[1\].
    #[serde(default)]
    pub ratios: Vec<f64>,
    /// Standard deviation of each of `ratios` \[1\], `None` of one that is not known; empty where none is.
    #[cfg(not(feature = "compact"))]
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub std: Vec<Option<f64>>,
    /// Ratio of every mode after the last of `ratios` \[1\].
    #[serde(default)]
    pub beyond: f64,
}

impl Damping {
    /// Damping ratio of flexible mode `mode`, counted from 1.
    pub fn ratio(&self, mode: usize) -> f64 {
        mode.checked_sub(1).and_then(|index| self.ratios.get(index)).copied().unwrap_or(self.beyond)
    }

    pub(crate) fn check(&self) -> Result<(), ModelError> {
        let listed = self.ratios.iter().enumerate().map(|(index, &value)| (index + 1, value));
        for (mode, value) in listed.chain([(0, self.beyond)]) {
            if !(0.0..std::f64::consts::FRAC_1_SQRT_2).contains(&value) {
                return Err(ModelError::Damping { mode, value });
            }
        }
        Ok(())
    }
}
