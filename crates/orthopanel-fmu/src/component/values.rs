//! Getting and setting variables; a call with one bad entry changes nothing.

use super::Component;
use super::phase::{Interface, Phase};
use super::settable_numbers::{fits, fitting};
use crate::{FmuError, Quantity, Variable};

impl Component {
    /// Reads real variables; accelerations answer at once to the force in effect (direct feedthrough).
    #[inline(always)]
    pub(crate) fn get_reals(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), FmuError> {
        self.require(Phase::READABLE)?;
        // One acceleration, which is what is read at every step, needs no second look.
        if let ([reference], [value]) = (references, &mut *values)
            && let Some(Quantity::Acceleration(port)) = self.variables.quantity(*reference)
            && !self.forces_changed
        {
            // The table has the ports of the stepper: none is ever missing.
            let found = self.stepper.acceleration(port).unwrap_or(f64::NAN);
            if found.is_finite() {
                *value = found;
                return Ok(());
            }
        }
        self.get_several(references, values)
    }

    #[inline(never)]
    fn get_several(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), FmuError> {
        same_count(values.len(), references.len())?;
        self.apply()?;
        for (&reference, value) in references.iter().zip(values) {
            *value = match self.variables.quantity(reference) {
                // What is read at every step is asked for nothing more.
                Some(Quantity::Acceleration(port)) => self.stepper.acceleration(port).unwrap_or(f64::NAN),
                quantity => self.other_real(reference, quantity)?,
            };
            if !value.is_finite() {
                return Err(self.overflow(reference, *value));
            }
        }
        Ok(())
    }

    /// Forces and states are finite, but what follows from them need not be.
    #[cold]
    pub(super) fn overflow(&self, reference: u32, value: f64) -> FmuError {
        let what = self.variable(reference).map(|variable| variable.name.clone()).unwrap_or_default();
        FmuError::Overflow { what, value }
    }

    #[inline(never)]
    fn other_real(&self, reference: u32, quantity: Option<Quantity>) -> Result<f64, FmuError> {
        match quantity {
            Some(Quantity::Time) => Ok(self.now.time),
            None | Some(Quantity::ForceLinear) => Err(self.no_real(reference)),
            // The table has the ports and modes of the stepper: none of these is ever missing.
            Some(Quantity::Input(port)) => Ok(self.now.forces.get(port).copied().unwrap_or(f64::NAN)),
            Some(quantity) => {
                let forces = self.now.forces_in_effect();
                Ok(self.panel_value(quantity, &self.in_use, &self.stepper, forces).unwrap_or(f64::NAN))
            }
        }
    }

    /// Sets forces \[N\], tunable parameters, and before the start all parameters and the initial state of the modes.
    pub(crate) fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Result<(), FmuError> {
        self.require(Phase::SETTABLE)?;
        same_count(values.len(), references.len())?;
        // One force, which is what is set at every step, needs no second look.
        if let ([reference], [value]) = (references, values)
            && let Some(Quantity::Input(port)) = self.variables.quantity(*reference)
            && fits(*value)
            && let Some(force) = self.now.forces.get_mut(port)
        {
            *force = *value;
            self.forces_changed = true;
            return Ok(());
        }
        self.set_several(references, values)
    }

    #[inline(never)]
    fn set_several(&mut self, references: &[u32], values: &[f64]) -> Result<(), FmuError> {
        for (&reference, &value) in references.iter().zip(values) {
            // A force is asked for nothing more.
            if !(matches!(self.variables.quantity(reference), Some(Quantity::Input(_))) && fits(value)) {
                self.check_settable(reference, value)?;
            }
        }
        for (&reference, &value) in references.iter().zip(values) {
            match self.variables.quantity(reference) {
                Some(Quantity::Input(port)) => {
                    if let Some(force) = self.now.forces.get_mut(port) {
                        *force = value;
                    }
                }
                other => self.set_initial(other, value)?,
            }
        }
        self.forces_changed = true;
        Ok(())
    }

    /// Sets a parameter or one number of the initial state; other quantities were refused before.
    #[cold]
    fn set_initial(&mut self, quantity: Option<Quantity>, value: f64) -> Result<(), FmuError> {
        if let Some(Quantity::Parameter(index)) = quantity {
            let attached = self.settable.as_ref().filter(|_| Phase::BEFORE_START.contain(self.now.phase));
            let attached = attached.and_then(|settable| settable.panel.attachment_of(index));
            for index in [Some(index), attached].into_iter().flatten() {
                if let Some(parameter) = self.now.parameters.get_mut(index) {
                    *parameter = value;
                    self.parameters_changed = true;
                }
            }
            return Ok(());
        }
        let (Some(Quantity::ModalPosition(mode)) | Some(Quantity::ModalVelocity(mode))) = quantity else {
            return Ok(());
        };
        let [position, velocity] = self.stepper.mode_state(mode).unwrap_or_default();
        let is_position = matches!(quantity, Some(Quantity::ModalPosition(_)));
        self.stepper.set_mode_state(mode, if is_position { [value, velocity] } else { [position, value] })?;
        Ok(())
    }

    /// Gives the first derivatives of forces \[N/s\], for the next step alone (FMI 2.0).
    pub(crate) fn set_force_rates(
        &mut self,
        references: &[u32],
        orders: &[i32],
        rates: &[f64],
    ) -> Result<(), FmuError> {
        self.require(Phase::SETTABLE)?;
        if self.now.interface == Interface::ModelExchange {
            return Err(FmuError::NotOffered(
                "input derivatives are of <CoSimulation>: in model exchange set the input",
            ));
        }
        same_count(rates.len(), references.len())?;
        same_count(orders.len(), references.len())?;
        if self.now.force_linear {
            return Err(FmuError::DerivativeBesideLinear);
        }
        for ((&reference, &order), &rate) in references.iter().zip(orders).zip(rates) {
            self.force_port(reference)?;
            if order != 1 {
                return Err(FmuError::DerivativeOrder { order });
            }
            fitting(&self.variable(reference)?.name, rate)?;
        }
        for (&reference, &rate) in references.iter().zip(rates) {
            let port = self.force_port(reference)?;
            if let Some(slot) = self.now.force_rates.get_mut(port) {
                *slot = rate;
                self.now.rates_given = true;
            }
        }
        Ok(())
    }

    /// Reads Boolean variables, in the type that the version of the standard has for them.
    pub(crate) fn get_booleans<B: From<bool> + Clone>(
        &self,
        references: &[u32],
        values: &mut [B],
    ) -> Result<(), FmuError> {
        self.require(Phase::READABLE)?;
        same_count(values.len(), references.len())?;
        for &reference in references {
            self.boolean(reference)?;
        }
        values.fill(B::from(self.now.force_linear));
        Ok(())
    }

    /// Sets Boolean variables: the fixed parameter `force_linear`, until initialization ends. All but false is true.
    pub(crate) fn set_booleans<B: From<bool> + PartialEq>(
        &mut self,
        references: &[u32],
        values: &[B],
    ) -> Result<(), FmuError> {
        self.require(Phase::SETTABLE)?;
        same_count(values.len(), references.len())?;
        for &reference in references {
            let variable = self.boolean(reference)?;
            if !Phase::BEFORE_START.contain(self.now.phase) {
                return Err(not_settable(variable, "a fixed parameter is set before or in initialization mode"));
            }
        }
        if let Some(last) = values.last() {
            self.now.force_linear = *last != B::from(false);
            if self.now.force_linear {
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

    pub(super) fn variable(&self, reference: u32) -> Result<&Variable, FmuError> {
        self.variables.get(reference).ok_or_else(|| self.unknown_reference(reference))
    }

    pub(super) fn unknown_reference(&self, reference: u32) -> FmuError {
        let last = u32::try_from(self.variables.variables().len()).unwrap_or(u32::MAX);
        let [reference, last] = [reference, last].map(|reference| self.variables.seen(reference));
        FmuError::UnknownReference { reference, last }
    }

    pub(super) fn quantity(&self, reference: u32) -> Result<Quantity, FmuError> {
        self.variable(reference).map(|variable| variable.quantity)
    }

    fn real(&self, reference: u32) -> Result<Quantity, FmuError> {
        match self.quantity(reference)? {
            Quantity::ForceLinear => Err(wrong_type(self.variable(reference)?, REAL)),
            quantity => Ok(quantity),
        }
    }

    /// Why a reference is that of no real variable.
    #[cold]
    fn no_real(&self, reference: u32) -> FmuError {
        match self.variable(reference) {
            Ok(variable) => wrong_type(variable, REAL),
            Err(error) => error,
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
            Quantity::Input(port) => Ok(port),
            _ => Err(not_settable(self.variable(reference)?, "input derivatives are of inputs only")),
        }
    }

    #[cold]
    fn check_settable(&self, reference: u32, value: f64) -> Result<(), FmuError> {
        let reason = match self.real(reference)? {
            Quantity::Input(_) => return fitting(&self.variable(reference)?.name, value),
            Quantity::ModalPosition(_) | Quantity::ModalVelocity(_) => {
                if Phase::BEFORE_START.contain(self.now.phase) {
                    return fitting(&self.variable(reference)?.name, value);
                }
                "the initial state is set before or in initialization mode (model exchange: set continuous states)"
            }
            Quantity::Parameter(index) => return self.check_parameter(index, self.variable(reference)?, value),
            Quantity::Time => "time follows the steps",
            Quantity::ModalPositionRate(_) | Quantity::ModalVelocityRate(_) => "it is the derivative of a state",
            _ => "it is an output",
        };
        Err(not_settable(self.variable(reference)?, reason))
    }
}

const REAL: &str = "Real (Float64)";
const BOOLEAN: &str = "Boolean";

fn wrong_type(variable: &Variable, asked: &'static str) -> FmuError {
    let expected = if variable.quantity == Quantity::ForceLinear { BOOLEAN } else { REAL };
    FmuError::VariableType { name: variable.name.clone(), reference: variable.reference, expected, asked }
}

pub(super) fn not_settable(variable: &Variable, reason: &'static str) -> FmuError {
    FmuError::NotSettable { name: variable.name.clone(), reference: variable.reference, reason }
}

pub(super) fn same_count(values: usize, references: usize) -> Result<(), FmuError> {
    if values == references { Ok(()) } else { Err(FmuError::Count { values, references }) }
}
