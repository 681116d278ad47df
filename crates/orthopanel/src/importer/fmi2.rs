//! FMI 2.0.

use std::sync::Arc;

use fmi_rs::fmi2::types::{fmi2False, fmi2Status, fmi2True};
use fmi_rs::fmi2::{CS, FMU2};
use fmi_rs::model_description::fmi2::ModelDescription;

use super::{Instance, References};

pub(super) fn references(description: &ModelDescription) -> Result<References, String> {
    References::find(|name| description.variable_by_name(name).ok().map(|variable| (variable.valueReference, 1)))
}

pub(super) struct Fmi2<'a> {
    pub(super) instance: Arc<FMU2<CS>>,
    pub(super) references: &'a References,
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
