//! Time response: modes advanced exactly under forces that are held or run linearly over a step, and the paper's
//! Runge-Kutta beside it.

mod coupled;
mod cubic_supports;
mod force_record;
mod lane;
mod mode_group;
mod propagator;
mod runge_kutta;
mod stepper;

pub use cubic_supports::{CubicForces, cubic_support_forces};
pub use force_record::ForceRecord;
pub use stepper::ModalStepper;

#[cfg(test)]
mod tests;
