//! A measured force, and the exact response to it.

use crate::{ModalModel, ModalStepper, ModelError};

/// Forces sampled at even times, sample $n$ at $t = n h$; between samples they run linearly.
///
/// The straight line is part of the definition. A force that was sampled from something smoother loses the part
/// $1 - \mathrm{sinc}^2(fh)$ at the frequency $f$ by it: 19 % at a quarter of the sampling rate, 1 % at an
/// eighteenth.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceRecord {
    interval: f64,
    forces: Vec<Vec<f64>>,
}

impl ForceRecord {
    /// A record of sampling interval $h$ \[s\] and one list of samples \[N\] a force port, all equally long.
    ///
    /// # Errors
    /// [`ModelError::Size`] for an interval that is not above zero, [`ModelError::RecordLength`] for lists of unequal
    /// length, [`ModelError::NotFinite`] for a sample that is no number.
    pub fn new(interval: f64, forces: Vec<Vec<f64>>) -> Result<Self, ModelError> {
        if !(interval.is_finite() && interval > 0.0) {
            return Err(ModelError::Size { name: "sampling interval", value: interval, unit: "s" });
        }
        let expected = forces.first().map_or(0, Vec::len);
        for (index, samples) in forces.iter().enumerate() {
            if samples.len() != expected {
                return Err(ModelError::RecordLength { port: index + 1, found: samples.len(), expected });
            }
            if let Some(&value) = samples.iter().find(|value| !value.is_finite()) {
                return Err(ModelError::NotFinite { what: "force", value });
            }
        }
        Ok(Self { interval, forces })
    }

    /// Sampling interval $h$ \[s\].
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Samples \[N\], one list a force port.
    pub fn forces(&self) -> &[Vec<f64>] {
        &self.forces
    }

    /// Number of samples.
    pub(super) fn count(&self) -> usize {
        self.forces.first().map_or(0, Vec::len)
    }

    /// # Errors
    /// [`ModelError::ForceCount`] where the model has another number of force ports.
    pub(super) fn check_ports(&self, model: &ModalModel) -> Result<(), ModelError> {
        let (found, expected) = (self.forces.len(), model.force_count());
        if found == expected { Ok(()) } else { Err(ModelError::ForceCount { found, expected }) }
    }
}

impl ModalModel {
    /// Acceleration \[m/s²\] at each response port at the instants of the record, by [`ModalStepper`]: exact for the
    /// force that runs linearly between the samples. The model is at rest before the first sample.
    ///
    /// # Errors
    /// [`ModelError::ForceCount`] where the record has another number of forces than the model has force ports,
    /// [`ModelError::NotFinite`] where the motion overflows.
    pub fn acceleration_under(&self, record: &ForceRecord) -> Result<Vec<Vec<f64>>, ModelError> {
        record.check_ports(self)?;
        let mut stepper = ModalStepper::new(self);
        let mut accelerations = vec![Vec::with_capacity(record.count()); self.response_count()];
        let mut forces = vec![0.0; record.forces.len()];
        for sample in 0..record.count() {
            for (force, samples) in forces.iter_mut().zip(&record.forces) {
                *force = samples.get(sample).copied().unwrap_or_default();
            }
            if sample == 0 {
                stepper.set_forces(&forces)?;
            } else {
                stepper.advance_linear(record.interval, &forces)?;
            }
            for (port, acceleration) in accelerations.iter_mut().enumerate() {
                acceleration.extend(stepper.acceleration(port));
            }
        }
        Ok(accelerations)
    }
}
