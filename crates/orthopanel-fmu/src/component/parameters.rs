//! Parameters of the panel: set before the start, and the modes solved again when they are next needed.

use super::{Component, Probe, finite};
use crate::panel::{Panel, Solution};
use crate::wide_stepper::WideStepper;
use crate::{FmuError, nominals};

/// The panel of an instance, with the values for which its modes stand solved.
#[derive(Debug)]
pub(super) struct Solved {
    pub(super) panel: Panel,
    pub(super) values: Vec<f64>,
}

impl Solved {
    pub(super) fn new(panel: &Panel) -> Self {
        let values = panel.parameters().into_iter().map(|parameter| parameter.start).collect();
        Self { panel: panel.clone(), values }
    }
}

impl Component {
    /// Refuses a value that no panel could have.
    pub(super) fn check_parameter(&self, index: usize, name: &str, value: f64) -> Result<(), FmuError> {
        finite(name, value)?;
        match &self.solved {
            Some(solved) => Ok(solved.panel.check(index, value)?),
            None => Ok(()),
        }
    }

    /// Solves the modes for these values of the parameters, unless they are solved for them; on an error the old
    /// modes stay.
    #[cold]
    pub(super) fn solve_for(&mut self, values: &[f64]) -> Result<(), FmuError> {
        let Some(solved) = self.solved.as_mut().filter(|solved| solved.values != values) else {
            return Ok(());
        };
        let Solution { modes, static_remainder, .. } = solved.panel.solve(values)?;
        if modes.modes().len() != self.nominals.len() {
            return Err(FmuError::ModeCount { found: modes.modes().len(), expected: self.nominals.len() });
        }
        let mut stepper = WideStepper::new(&modes);
        stepper.set_state(&self.stepper.state())?;
        solved.values = values.to_vec();
        self.probe = Probe { stepper: stepper.clone(), forces: vec![0.0; self.now.forces.len()] };
        self.stepper = stepper;
        self.nominals = nominals::of(&modes);
        self.static_remainder = static_remainder;
        self.forces_changed = true;
        Ok(())
    }
}
