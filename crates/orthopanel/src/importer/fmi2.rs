//! FMI 2.0.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use fmi_rs::fmi2::types::{fmi2False, fmi2Status, fmi2True};
use fmi_rs::fmi2::{CS, FMU2};
use fmi_rs::model_description::fmi2::{Causality, ModelDescription, ScalarVariable};
use fmi_rs::sim::SimulationError;

use super::instance::{Instance, References, Variable};
use super::log::Log;

/// What is known of each variable by its name; each is one number.
pub(super) fn variables(description: &ModelDescription) -> HashMap<&str, Variable> {
    let known = |variable: &ScalarVariable| Variable {
        reference: variable.valueReference,
        numbers: 1,
        is_signal: matches!(variable.causality, Causality::Input | Causality::Output),
    };
    description.modelVariables.iter().map(|variable| (variable.name.as_str(), known(variable))).collect()
}

pub(super) struct Fmi2<'a> {
    instance: Arc<FMU2<CS>>,
    references: &'a References,
}

impl<'a> Fmi2<'a> {
    /// Loads the FMU that is unpacked in `folder`.
    pub(super) fn new(
        folder: &Path,
        description: &ModelDescription,
        references: &'a References,
        log: Arc<Log>,
    ) -> Result<Self, SimulationError> {
        let kind = description.coSimulation.as_ref().ok_or(SimulationError::InterfaceType)?;
        let (identifier, own_memory) = (&kind.modelIdentifier, kind.canNotUseMemoryManagementFunctions);
        let (visible, logging, log_calls) = (false, false, false);
        let guid = &description.guid;
        let instance =
            FMU2::<CS>::new(folder, identifier, "panel", guid, visible, logging, log_calls, log, !own_memory)?;
        Ok(Self { instance, references })
    }
}

impl Instance for Fmi2<'_> {
    fn set_force_linear(&self, linear: bool) -> Result<(), &'static str> {
        let value = if linear { fmi2True } else { fmi2False };
        done(self.instance.setBoolean(&[self.references.force_linear], &[value]), "fmi2SetBoolean")
    }

    fn set_forces(&self, forces: &[f64]) -> Result<(), &'static str> {
        done(self.instance.setReal(&self.references.forces, forces), "fmi2SetReal")
    }

    fn initialise(&self, start: f64, forces: &[f64]) -> Result<(), &'static str> {
        done(self.instance.setupExperiment(None, start, None), "fmi2SetupExperiment")?;
        done(self.instance.enterInitializationMode(), "fmi2EnterInitializationMode")?;
        self.set_forces(forces)?;
        done(self.instance.exitInitializationMode(), "fmi2ExitInitializationMode")
    }

    fn step(&self, from: f64, step: f64) -> Result<(), &'static str> {
        done(self.instance.doStep(from, step, fmi2True), "fmi2DoStep")
    }

    fn outputs(&self) -> Result<Vec<f64>, &'static str> {
        let mut values = vec![0.0; self.references.output_count];
        done(self.instance.getReal(&self.references.outputs, &mut values), "fmi2GetReal")?;
        Ok(values)
    }

    fn terminate(&self) -> Result<(), &'static str> {
        done(self.instance.terminate(), "fmi2Terminate")
    }
}

fn done(status: fmi2Status, call: &'static str) -> Result<(), &'static str> {
    if matches!(status, fmi2Status::Ok | fmi2Status::Warning) { Ok(()) } else { Err(call) }
}
