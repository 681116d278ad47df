//! Time response: modes advanced exactly under forces that are held or run linearly over a step.

mod propagator;
mod stepper;

pub use stepper::ModalStepper;

#[cfg(test)]
mod tests;
