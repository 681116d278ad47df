//! The communication step.

use super::settable_numbers::{TOO_LONG, timely};
use super::{Component, Phase};
use crate::FmuError;

/// Share of a step by which the importer's time may differ from ours: importers add up their steps with rounding.
const TIME_SLACK: f64 = 1e-3;

/// The same as a share of the time itself, for long runs of tiny steps.
const TIME_ROUNDING: f64 = 1e-12;

/// By how much a step of this size from here may miss where the instance stands.
#[inline(always)]
fn slack(start: f64, step: f64) -> f64 {
    TIME_SLACK * step + TIME_ROUNDING * start.abs()
}

impl Component {
    /// Advances from `start` by `step` \[s\].
    ///
    /// The force over the step: with `force_linear` from its value at the end of the last step to the value set;
    /// with input derivatives from the value set at that rate; else held at the value set, but for a base under a mount,
    /// which goes on from its displacement at its velocity. Where the step is refused, everything stays as it was.
    #[inline(always)]
    pub(crate) fn do_step(&mut self, start: f64, step: f64) -> Result<(), FmuError> {
        self.require(Phase::STEP)?;
        // Each comparison fails for what is not a number; what is too large is no part of a sum.
        if !(step > 0.0 && step < TOO_LONG && start.abs() < TOO_LONG) {
            return Err(self.refused_step(start, step));
        }
        let end = start + step;
        let slack = slack(start, step);
        let sound = (start - self.now.time).abs() <= slack && end < TOO_LONG;
        if !sound || self.now.stop_time.is_some_and(|stop| end > stop + slack) {
            return Err(self.refused_step(start, step));
        }
        if self.now.force_linear {
            self.step_between_values(step)?;
        } else if self.now.rates_given || !self.bases.is_empty() {
            self.step_at_rates(step)?;
        } else {
            if self.parameters_changed {
                self.apply()?;
            }
            match self.now.forces[..] {
                // One force is told with the step, in one pass over the modes.
                [force] if std::mem::take(&mut self.forces_changed) => {
                    self.stepper.advance_under_one(force, step).inspect_err(|_| self.forces_changed = true)?;
                }
                _ => {
                    self.apply()?;
                    self.stepper.advance_held(step)?;
                }
            }
            self.now.slopes_given = false;
        }
        self.now.time = end;
        Ok(())
    }

    /// Why a step is refused.
    #[cold]
    fn refused_step(&self, start: f64, step: f64) -> FmuError {
        if let Err(refused) = timely("communication point", start) {
            return refused;
        }
        if !(step.is_finite() && step > 0.0) {
            return orthopanel_model::ModelError::Size { name: "step", value: step, unit: "s" }.into();
        }
        if let Err(refused) = timely("step", step) {
            return refused;
        }
        if (start - self.now.time).abs() > slack(start, step) {
            return FmuError::CommunicationPoint { given: start, time: self.now.time };
        }
        let end = start + step;
        match (timely("end of the step", end), self.now.stop_time) {
            (Ok(()), Some(stop)) => FmuError::PastStop { end, stop },
            (late, _) => late.err().unwrap_or(FmuError::NotFinite { what: "end of the step".into(), value: end }),
        }
    }

    fn step_between_values(&mut self, step: f64) -> Result<(), FmuError> {
        if self.parameters_changed {
            self.apply()?;
        }
        // Until the step succeeds the stepper holds the old force: then the values set are still to be told.
        self.forces_changed = true;
        self.stepper.set_forces(&self.now.forces_before)?;
        self.stepper.advance_linear(step, &self.now.forces)?;
        self.forces_changed = false;
        let ends = self.now.forces_before.iter().zip(&self.now.forces);
        for (slope, (from, to)) in self.now.slopes.iter_mut().zip(ends) {
            *slope = ((to - from) / step).clamp(f64::MIN, f64::MAX);
        }
        self.now.slopes_given = true;
        self.now.forces_before.copy_from_slice(&self.now.forces);
        Ok(())
    }

    fn step_at_rates(&mut self, step: f64) -> Result<(), FmuError> {
        self.apply()?;
        for ((end, force), rate) in self.forces_after.iter_mut().zip(&self.now.forces).zip(&self.now.force_rates) {
            *end = force + rate * step;
        }
        // A rate that the importer gives counts; else the velocity is that of the displacement.
        for &[displacement, velocity] in &self.bases {
            let (given, speed) = (self.now.force_rates.get(displacement), self.now.forces.get(velocity));
            if let (Some(0.0), Some(speed), Some(end)) = (given, speed, self.forces_after.get_mut(displacement)) {
                *end += speed * step;
            }
        }
        self.stepper.advance_linear(step, &self.forces_after)?;
        let ends = self.now.forces.iter().zip(&self.forces_after);
        for ((slope, rate), (from, to)) in self.now.slopes.iter_mut().zip(&self.now.force_rates).zip(ends) {
            *slope = if *rate == 0.0 { ((to - from) / step).clamp(f64::MIN, f64::MAX) } else { *rate };
        }
        self.now.forces.copy_from_slice(&self.forces_after);
        self.now.slopes_given = true;
        self.forget_rates();
        Ok(())
    }
}
