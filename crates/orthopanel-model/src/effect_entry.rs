//! An effect as a model file has it.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::Estimate;

/// One effect of the catalogue with its parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectEntry {
    /// Its id in the catalogue.
    pub id: String,
    /// `panel`, `rig` or `channel`.
    pub owner: String,
    /// Parameters by name, in SI units.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, Estimate>,
}
