//! Parameters of the panel: set before the start, or the tunable ones between steps or at an event. The modes are found for them
//! when they are next needed.

use std::sync::Arc;

use super::phase::Phase;
use super::seen::{Seen, Settable};
use super::settable_numbers::finite;
use super::{Component, Probe, values};
use crate::floating_point::StandardEnvironment;
use crate::panel::Solution;
use crate::wide_stepper::WideStepper;
use crate::{FmuError, Variable, nominals};

impl Component {
    /// Refuses a value that no panel could have, and what is not set now.
    pub(super) fn check_parameter(&self, index: usize, variable: &Variable, value: f64) -> Result<(), FmuError> {
        let started = !Phase::BEFORE_START.contain(self.now.phase);
        if started && !variable.tunable {
            let reason = "a fixed parameter is set before or in initialization mode";
            return Err(values::not_settable(variable, reason));
        }
        if !Phase::TUNABLE.contain(self.now.phase) {
            let reason = "a tunable parameter is set in event mode (model exchange) or between steps (co-simulation), or before \
                          the start";
            return Err(values::not_settable(variable, reason));
        }
        finite(&variable.name, value)?;
        if let Some(Settable { panel, .. }) = &self.settable {
            panel.check(index, value)?;
            // Before the start sizes may be set later: then all are judged together.
            if started {
                panel.check_place(index, value, &self.now.parameters)?;
            }
        }
        Ok(())
    }

    /// Finds the modes for these values of the parameters, unless they are those in use; on an error these stay. The states go on
    /// as they are.
    #[cold]
    pub(super) fn solve_for(&mut self, values: &[f64]) -> Result<(), FmuError> {
        if self.in_use.values == values {
            return Ok(());
        }
        let _environment = StandardEnvironment::enter();
        let seen = self.seen_with(values)?;
        let mut stepper = WideStepper::new(&seen.modes);
        stepper.set_state(&self.stepper.state())?;
        self.probe = Probe { stepper: stepper.clone(), forces: vec![0.0; self.now.forces.len()] };
        self.stepper = stepper;
        self.nominals_changed |= seen.nominals != self.in_use.nominals;
        self.in_use = seen;
        self.forces_changed = true;
        Ok(())
    }

    /// The panel with these values. What comes out depends on them alone, not on those before.
    pub(super) fn seen_with(&self, values: &[f64]) -> Result<Arc<Seen>, FmuError> {
        let Some(Settable { panel, exported }) = &self.settable else { return Ok(Arc::clone(&self.in_use)) };
        if exported.values == values {
            return Ok(Arc::clone(exported));
        }
        for known in [exported, &self.in_use] {
            if let Some(Solution { free, modes, outputs, .. }) = panel.quickly(&known.free, &known.values, values) {
                let nominals = known.nominals.clone();
                return Ok(Arc::new(Seen { values: values.to_vec(), free, modes, outputs, nominals }));
            }
        }
        let Solution { free, modes, outputs, .. } = panel.solve(values)?;
        if modes.modes().len() != self.mode_count() {
            return Err(FmuError::ModeCount { found: modes.modes().len(), expected: self.mode_count() });
        }
        let nominals = nominals::of(&modes, panel.force_ports());
        Ok(Arc::new(Seen { values: values.to_vec(), free, modes, outputs, nominals }))
    }
}
