//! Getting and setting variables; a call with one bad entry changes nothing.

use super::{Component, Phase, finite};
use crate::{FmuError, Quantity, Variable};

const READABLE: &[Phase] = &[Phase::Initialization, Phase::Step, Phase::Terminated];
const WRITABLE: &[Phase] = &[Phase::Instantiated, Phase::Initialization, Phase::Step];

impl Component {
    /// Reads real variables; accelerations answer to the force now set (direct feedthrough).
    pub(crate) fn get_reals(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), FmuError> {
        self.require(READABLE)?;
        same_count(values.len(), references.len())?;
        for &reference in references {
            self.real(reference)?;
        }
        self.apply_forces()?;
        for (&reference, value) in references.iter().zip(values) {
            let quantity = self.real(reference)?;
            // The table has the ports of the stepper: none of these is ever missing.
            *value = match quantity {
                Quantity::Time | Quantity::ForceLinear => Some(self.time),
                Quantity::Force(port) => self.forces.get(port).copied(),
                Quantity::Acceleration(port) => self.stepper.acceleration(port),
                Quantity::Velocity(port) => self.stepper.velocity(port),
                Quantity::Displacement(port) => self.stepper.displacement(port),
            }
            .unwrap_or(f64::NAN);
        }
        Ok(())
    }

    /// Sets forces \[N\].
    pub(crate) fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Result<(), FmuError> {
        self.require(WRITABLE)?;
        same_count(values.len(), references.len())?;
        for (&reference, &value) in references.iter().zip(values) {
            self.force_port(reference)?;
            finite(&self.variable(reference)?.name, value)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            let port = self.force_port(reference)?;
            if let Some(force) = self.forces.get_mut(port) {
                *force = value;
            }
        }
        self.forces_changed = true;
        Ok(())
    }

    /// Gives the first derivatives of forces \[N/s\], for the next step alone (FMI 2.0).
    pub(crate) fn set_force_rates(
        &mut self,
        references: &[u32],
        orders: &[i32],
        rates: &[f64],
    ) -> Result<(), FmuError> {
        self.require(WRITABLE)?;
        same_count(rates.len(), references.len())?;
        same_count(orders.len(), references.len())?;
        if self.force_linear {
            return Err(FmuError::DerivativeBesideLinear);
        }
        for ((&reference, &order), &rate) in references.iter().zip(orders).zip(rates) {
            self.force_port(reference)?;
            if order != 1 {
                return Err(FmuError::DerivativeOrder { order });
            }
            finite(&self.variable(reference)?.name, rate)?;
        }
        for (&reference, &rate) in references.iter().zip(rates) {
            let port = self.force_port(reference)?;
            if let Some(slot) = self.force_rates.get_mut(port) {
                *slot = rate;
                self.rates_given = true;
            }
        }
        Ok(())
    }

    /// Reads Boolean variables.
    pub(crate) fn get_booleans(&self, references: &[u32], values: &mut [bool]) -> Result<(), FmuError> {
        self.require(READABLE)?;
        same_count(values.len(), references.len())?;
        for &reference in references {
            self.boolean(reference)?;
        }
        values.fill(self.force_linear);
        Ok(())
    }

    /// Sets Boolean variables: the fixed parameter `force_linear`, until initialization ends.
    pub(crate) fn set_booleans(&mut self, references: &[u32], values: &[bool]) -> Result<(), FmuError> {
        self.require(WRITABLE)?;
        same_count(values.len(), references.len())?;
        for &reference in references {
            let variable = self.boolean(reference)?;
            if self.phase == Phase::Step {
                let reason = "a fixed parameter is set before or in initialization mode";
                return Err(not_settable(variable, reason));
            }
        }
        if let Some(&last) = values.last() {
            self.force_linear = last;
            if last {
                self.forget_rates();
            }
        }
        Ok(())
    }

    /// Refuses references of variables of a type that the FMU has none of.
    pub(crate) fn refuse_type(&self, references: &[u32], asked: &'static str) -> Result<(), FmuError> {
        match references.first() {
            None => Ok(()),
            Some(&reference) => Err(wrong_type(self.variable(reference)?, asked)),
        }
    }

    fn variable(&self, reference: u32) -> Result<&Variable, FmuError> {
        let last = u32::try_from(self.variables.variables().len()).unwrap_or(u32::MAX).saturating_sub(1);
        self.variables.get(reference).ok_or(FmuError::UnknownReference { reference, last })
    }

    fn real(&self, reference: u32) -> Result<Quantity, FmuError> {
        let variable = self.variable(reference)?;
        match variable.quantity {
            Quantity::ForceLinear => Err(wrong_type(variable, REAL)),
            quantity => Ok(quantity),
        }
    }

    fn boolean(&self, reference: u32) -> Result<&Variable, FmuError> {
        let variable = self.variable(reference)?;
        match variable.quantity {
            Quantity::ForceLinear => Ok(variable),
            _ => Err(wrong_type(variable, BOOLEAN)),
        }
    }

    fn force_port(&self, reference: u32) -> Result<usize, FmuError> {
        match self.real(reference)? {
            Quantity::Force(port) => Ok(port),
            Quantity::Time => Err(not_settable(self.variable(reference)?, "time follows the steps")),
            _ => Err(not_settable(self.variable(reference)?, "it is an output")),
        }
    }
}

const REAL: &str = "Real (Float64)";
const BOOLEAN: &str = "Boolean";

fn wrong_type(variable: &Variable, asked: &'static str) -> FmuError {
    let expected = if variable.quantity == Quantity::ForceLinear { BOOLEAN } else { REAL };
    FmuError::VariableType { name: variable.name.clone(), reference: variable.reference, expected, asked }
}

fn not_settable(variable: &Variable, reason: &'static str) -> FmuError {
    FmuError::NotSettable { name: variable.name.clone(), reference: variable.reference, reason }
}

fn same_count(values: usize, references: usize) -> Result<(), FmuError> {
    if values == references { Ok(()) } else { Err(FmuError::Count { values, references }) }
}
