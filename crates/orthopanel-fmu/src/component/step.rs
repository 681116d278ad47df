//! The communication step.

use super::{Component, Phase, finite};
use crate::FmuError;

/// Share of a step by which the importer's time may differ from ours: importers add up their steps with rounding.
const TIME_SLACK: f64 = 1e-3;

/// The same as a share of the time itself, for long runs of tiny steps.
const TIME_ROUNDING: f64 = 1e-12;

impl Component {
    /// Advances from `start` by `step` \[s\].
    ///
    /// The force over the step: with `force_linear` from its value at the end of the last step to the value set;
    /// with input derivatives from the value set at that rate; else held at the value set. Where the step is
    /// refused, everything stays as it was.
    pub(crate) fn do_step(&mut self, start: f64, step: f64) -> Result<(), FmuError> {
        self.require(&[Phase::Step])?;
        finite("communication point", start)?;
        if !(step.is_finite() && step > 0.0) {
            return Err(orthopanel_model::ModelError::Size { name: "step", value: step, unit: "s" }.into());
        }
        let slack = TIME_SLACK * step + TIME_ROUNDING * start.abs();
        if (start - self.now.time).abs() > slack {
            return Err(FmuError::CommunicationPoint { given: start, time: self.now.time });
        }
        let end = start + step;
        finite("end of the step", end)?;
        if let Some(stop) = self.now.stop_time.filter(|&stop| end > stop + slack) {
            return Err(FmuError::PastStop { end, stop });
        }
        if self.now.force_linear {
            self.step_between_values(step)?;
        } else if self.now.rates_given {
            self.step_at_rates(step)?;
        } else {
            self.apply()?;
            self.stepper.advance_held(step)?;
            self.now.slopes.fill(0.0);
        }
        self.now.forces_before.copy_from_slice(&self.now.forces);
        self.now.time = end;
        Ok(())
    }

    fn step_between_values(&mut self, step: f64) -> Result<(), FmuError> {
        // Until the step succeeds the stepper holds the old force: then the values set are still to be told.
        self.forces_changed = true;
        self.stepper.set_forces(&self.now.forces_before)?;
        self.stepper.advance_linear(step, &self.now.forces)?;
        self.forces_changed = false;
        let ends = self.now.forces_before.iter().zip(&self.now.forces);
        for (slope, (from, to)) in self.now.slopes.iter_mut().zip(ends) {
            *slope = ((to - from) / step).clamp(f64::MIN, f64::MAX);
        }
        Ok(())
    }

    fn step_at_rates(&mut self, step: f64) -> Result<(), FmuError> {
        self.apply()?;
        for ((end, force), rate) in self.forces_after.iter_mut().zip(&self.now.forces).zip(&self.now.force_rates) {
            *end = force + rate * step;
        }
        self.stepper.advance_linear(step, &self.forces_after)?;
        self.now.forces.copy_from_slice(&self.forces_after);
        self.now.slopes.copy_from_slice(&self.now.force_rates);
        self.forget_rates();
        Ok(())
    }
}
