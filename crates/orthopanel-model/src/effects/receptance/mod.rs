//! Accelerances of a piece with effects, line by line.
//!
//! The structure's modes near the band are summed at every line; what is above stands as a series in $s^2$ whose first
//! term is the exact static flexibility. Point elements are then joined without any further error ([`elements`]), for each
//! record its own.

mod elements;
mod far_modes;
mod modal_base;
mod model;
mod modulus_path;
mod record;
mod setup;
mod view;

pub use model::ReceptanceModel;
pub use setup::ReceptanceSetup;
