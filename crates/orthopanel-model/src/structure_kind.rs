//! Which structure vibrates.

use serde::{Deserialize, Serialize};

use crate::{BEAM_CONSTANTS, Constant, PLATE_CONSTANTS};

/// What vibrates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StructureKind {
    /// The orthotropic Timoshenko beam of the paper: constants `e_x`, `g_zx`.
    TimoshenkoBeam,
    /// The orthotropic Mindlin plate: constants `e_x`, `e_y`, `nu_xy`, `g_xy`, `g_yz`, `g_zx`.
    MindlinPlate,
}

impl StructureKind {
    /// The constants that the structure has, in the order of all its lists of values.
    pub fn constants(self) -> &'static [Constant] {
        match self {
            Self::TimoshenkoBeam => &BEAM_CONSTANTS,
            Self::MindlinPlate => &PLATE_CONSTANTS,
        }
    }

    /// Every structure.
    pub const ALL: [Self; 2] = [Self::TimoshenkoBeam, Self::MindlinPlate];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TimoshenkoBeam => "timoshenko-beam",
            Self::MindlinPlate => "mindlin-plate",
        }
    }

    /// Its name in sentences.
    pub fn title(self) -> &'static str {
        match self {
            Self::TimoshenkoBeam => "orthotropic Timoshenko beam",
            Self::MindlinPlate => "orthotropic Mindlin plate",
        }
    }

    /// Whether its shapes have nodal lines along x too: then $y$ counts at a place.
    pub fn has_modes_across(self) -> bool {
        match self {
            Self::TimoshenkoBeam => false,
            Self::MindlinPlate => true,
        }
    }
}
