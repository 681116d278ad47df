//! Receptances and accelerances of a piece with effects, line by line, with exact derivatives.
//!
//! The structure's modes near the band are summed at every line; what is above stands as a series in $s^2$ whose first
//! term is the exact static flexibility. Point elements are then joined without any further error
//! ([`coupling`]), for each record its own.

mod coupling;
mod far_modes;
pub(super) mod modal_base;
mod model;
mod modulus_path;
mod moved_structure;
mod record;
mod setup;
pub(super) mod view;
mod wide;
pub(super) mod wide_plate;

pub use model::{LineBlock, LineDerivatives, LineEvaluator, ReceptanceModel};
pub use setup::ReceptanceSetup;
