//! Derivatives by parameters: the modes are found for parameters beside those set, and the outputs differenced.
//!
//! Rules of five points, of fourth order in the step \[B. Fornberg, Math. Comp. 51 (1988) 699-706\]: good to about 1e-7 for a
//! beam, and to about 1e-5 for a plate, whose solver's rounding is divided by the step. Where two modes lie so close that they
//! change their order within the step, the derivatives by the one and by the other are mixed.

use super::seen::Settable;
use super::{Component, Phase};
use crate::wide_stepper::WideStepper;
use crate::{FmuError, Quantity};

/// Steps as a share of each parameter's own size.
const STEP: f64 = 1e-3;

/// Places in steps, with their weights.
type Rule = [(f64, f64)];
const CENTRAL: &Rule = &[(-2.0, 1.0 / 12.0), (-1.0, -2.0 / 3.0), (1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0)];
const FORWARD: &Rule = &[(0.0, -25.0 / 12.0), (1.0, 4.0), (2.0, -3.0), (3.0, 4.0 / 3.0), (4.0, -0.25)];

impl Component {
    /// $\sum_k(\partial y/\partial p_k)\,\delta p_k$ of each unknown over the parameters among the knowns; empty where there
    /// are none.
    #[cold]
    pub(super) fn parameter_derivative(
        &self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, FmuError> {
        let Some(Settable { panel, .. }) = &self.settable else { return Ok(Vec::new()) };
        let is_parameter = |known: &u32| matches!(self.quantity(*known), Ok(Quantity::Parameter(_)));
        // Importers ask for derivatives by inputs and states at every step.
        if !knowns.iter().any(is_parameter) {
            return Ok(Vec::new());
        }
        let mut direction = vec![0.0; self.in_use.values.len()];
        for (&known, &value) in knowns.iter().zip(seed) {
            let Quantity::Parameter(index) = self.quantity(known)? else { continue };
            let attached = Phase::BEFORE_START.contain(self.now.phase).then(|| panel.attachment_of(index)).flatten();
            for index in [Some(index), attached].into_iter().flatten() {
                if let Some(place) = direction.get_mut(index) {
                    *place += value;
                }
            }
        }
        let sizes = panel.sizes(&self.in_use.values);
        let longest = direction.iter().zip(sizes).fold(0.0, |most: f64, (value, size)| most.max((value / size).abs()));
        if longest == 0.0 {
            return Ok(Vec::new());
        }
        let step = STEP / longest;
        // At a bound, such as a damping ratio of zero or the edge of the piece, one side is no panel.
        self.difference(unknowns, &direction, step, CENTRAL)
            .or_else(|_| self.difference(unknowns, &direction, step, FORWARD))
            .or_else(|_| self.difference(unknowns, &direction, -step, FORWARD))
    }

    fn difference(&self, unknowns: &[u32], direction: &[f64], step: f64, rule: &Rule) -> Result<Vec<f64>, FmuError> {
        let mut sums = vec![0.0; unknowns.len()];
        for &(place, weight) in rule {
            let values = self.outputs_at(unknowns, direction, place * step)?;
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight / step * value);
        }
        Ok(sums)
    }

    /// The unknowns, with the forces and states of now, of a panel `along` the direction from the parameters set.
    fn outputs_at(&self, unknowns: &[u32], direction: &[f64], along: f64) -> Result<Vec<f64>, FmuError> {
        let Some(Settable { panel, .. }) = &self.settable else { return Ok(Vec::new()) };
        let set = &self.in_use.values;
        let beside: Vec<f64> = set.iter().zip(direction).map(|(value, way)| value + along * way).collect();
        for (index, &value) in beside.iter().enumerate() {
            panel.check(index, value)?;
        }
        let seen = self.seen_with(&beside)?;
        let mut stepper = WideStepper::new(&seen.modes);
        stepper.set_state(&self.stepper.state())?;
        let forces = self.now.forces_in_effect();
        stepper.set_forces(forces)?;
        let value = |&unknown: &u32| {
            let found = self.panel_value(self.quantity(unknown)?, &seen, &stepper, forces);
            Ok(found.unwrap_or(f64::NAN))
        };
        unknowns.iter().map(value).collect()
    }
}
