//! Derivatives: of outputs and state derivatives by inputs and states, and of outputs by time.
//!
//! Every output is linear in forces and modal states and zero where these are. So its derivative along a direction
//! is the output itself, asked of a panel whose forces and states *are* that direction. By parameters, which move the modes
//! or their damping, it is differenced (`parameter_sensitivities`).

use super::settable_numbers::fitting;
use super::{Component, Phase};
use crate::{FmuError, Quantity};

impl Component {
    /// $\delta y = \sum_k (\partial y/\partial x_k)\,\delta x_k$ for each unknown $y$.
    pub(crate) fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), FmuError> {
        self.require(Phase::READABLE)?;
        super::values::same_count(seed.len(), knowns.len())?;
        super::values::same_count(sensitivity.len(), unknowns.len())?;
        self.check_unknowns(unknowns)?;
        self.apply()?;
        for (&known, &value) in knowns.iter().zip(seed) {
            self.check_known(known)?;
            fitting("seed", value)?;
        }
        self.rest_probe()?;
        for (&known, &value) in knowns.iter().zip(seed) {
            self.add_to_probe(known, value)?;
        }
        self.probe.stepper.set_forces(&self.probe.forces)?;
        let by_parameters = self.parameter_derivative(unknowns, knowns, seed)?;
        for ((index, &unknown), value) in unknowns.iter().enumerate().zip(sensitivity) {
            *value = self.probe_output(unknown)? + by_parameters.get(index).copied().unwrap_or(0.0);
            if !value.is_finite() {
                return Err(self.overflow(unknown, *value));
            }
        }
        Ok(())
    }

    /// $\bar x_k = \sum_y \bar y\,\partial y/\partial x_k$ for each known $x_k$: the transpose, known by known.
    pub(crate) fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), FmuError> {
        self.require(Phase::READABLE)?;
        super::values::same_count(seed.len(), unknowns.len())?;
        super::values::same_count(sensitivity.len(), knowns.len())?;
        self.check_unknowns(unknowns)?;
        self.apply()?;
        for &value in seed {
            fitting("seed", value)?;
        }
        for &known in knowns {
            self.check_known(known)?;
        }
        for (&known, value) in knowns.iter().zip(sensitivity) {
            self.rest_probe()?;
            self.add_to_probe(known, 1.0)?;
            self.probe.stepper.set_forces(&self.probe.forces)?;
            let by_parameter = self.parameter_derivative(unknowns, &[known], &[1.0])?;
            let mut sum = 0.0;
            for (index, (&unknown, weight)) in unknowns.iter().zip(seed).enumerate() {
                sum += weight * (self.probe_output(unknown)? + by_parameter.get(index).copied().unwrap_or(0.0));
            }
            if !sum.is_finite() {
                return Err(self.overflow(known, sum));
            }
            *value = sum;
        }
        Ok(())
    }

    /// First derivatives of outputs by time: at the end of a step, along the force of that step.
    pub(crate) fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [f64],
    ) -> Result<(), FmuError> {
        self.require(Phase::STEPPED)?;
        super::values::same_count(orders.len(), references.len())?;
        super::values::same_count(values.len(), references.len())?;
        for (&reference, &order) in references.iter().zip(orders) {
            match self.quantity(reference)? {
                Quantity::Acceleration(_)
                | Quantity::Velocity(_)
                | Quantity::Displacement(_)
                | Quantity::Connected(_) => {}
                _ => return Err(self.not_differentiable(reference, "give outputs only")),
            }
            if order != 1 {
                return Err(FmuError::OutputDerivativeOrder { order });
            }
        }
        self.apply()?;
        if self.now.slopes_given {
            self.probe.forces.copy_from_slice(&self.now.slopes);
        } else {
            self.probe.forces.fill(0.0);
        }
        for mode in 0..self.mode_count() {
            self.probe.stepper.set_mode_state(mode, self.stepper.mode_rate(mode).unwrap_or_default())?;
        }
        self.probe.stepper.set_forces(&self.probe.forces)?;
        for (&reference, value) in references.iter().zip(values) {
            *value = self.probe_output(reference)?;
        }
        Ok(())
    }

    fn check_unknowns(&self, unknowns: &[u32]) -> Result<(), FmuError> {
        for &unknown in unknowns {
            match self.quantity(unknown)? {
                Quantity::Acceleration(_)
                | Quantity::Velocity(_)
                | Quantity::Displacement(_)
                | Quantity::Connected(_)
                | Quantity::ModalPositionRate(_)
                | Quantity::ModalVelocityRate(_) => {}
                _ => return Err(self.not_differentiable(unknown, "unknowns are outputs and derivatives of states")),
            }
        }
        Ok(())
    }

    fn check_known(&self, known: u32) -> Result<(), FmuError> {
        match self.quantity(known)? {
            Quantity::Input(_) | Quantity::ModalPosition(_) | Quantity::ModalVelocity(_) | Quantity::Time => Ok(()),
            Quantity::Parameter(_) if Phase::INITIALIZATION.contain(self.now.phase) => Ok(()),
            Quantity::Parameter(_) if self.variable(known)?.tunable => Ok(()),
            _ => Err(self.not_differentiable(
                known,
                "knowns are inputs, continuous states and tunable parameters, until initialization ends all parameters",
            )),
        }
    }

    fn rest_probe(&mut self) -> Result<(), FmuError> {
        for mode in 0..self.mode_count() {
            self.probe.stepper.set_mode_state(mode, [0.0; 2])?;
        }
        self.probe.forces.fill(0.0);
        Ok(())
    }

    fn add_to_probe(&mut self, known: u32, value: f64) -> Result<(), FmuError> {
        let quantity = self.quantity(known)?;
        let probe = &mut self.probe;
        match quantity {
            // What the outputs do when it is set: nothing, until its step is done.
            Quantity::Input(_) if self.now.forces_wait() => {}
            Quantity::Input(port) => {
                if let Some(force) = probe.forces.get_mut(port) {
                    *force += value;
                }
            }
            Quantity::ModalPosition(mode) | Quantity::ModalVelocity(mode) => {
                let mut state = probe.stepper.mode_state(mode).unwrap_or_default();
                state[usize::from(matches!(quantity, Quantity::ModalVelocity(_)))] += value;
                probe.stepper.set_mode_state(mode, state)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn probe_output(&self, reference: u32) -> Result<f64, FmuError> {
        let (quantity, probe) = (self.quantity(reference)?, &self.probe);
        let value = self.panel_value(quantity, &self.in_use, &probe.stepper, &probe.forces);
        let value = value.unwrap_or(f64::NAN);
        if value.is_finite() { Ok(value) } else { Err(self.overflow(reference, value)) }
    }

    fn not_differentiable(&self, reference: u32, reason: &'static str) -> FmuError {
        let name = self.variables.get(reference).map(|variable| variable.name.clone()).unwrap_or_default();
        FmuError::NotDifferentiable { name, reference, reason }
    }
}
