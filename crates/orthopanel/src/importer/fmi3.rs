//! FMI 3.0.

use std::sync::Arc;

use fmi_rs::fmi3::FMU3;
use fmi_rs::fmi3::types::fmi3Status;
use fmi_rs::model_description::fmi3::ModelDescription;

use super::{Instance, References};

pub(super) fn references(description: &ModelDescription) -> Result<References, String> {
    References::find(|name| {
        let variable = description.variable_by_name(name).ok()?;
        let sizes = description.initial_size(variable).ok()?;
        Some((variable.valueReference, sizes.iter().product()))
    })
}

pub(super) struct Fmi3<'a> {
    pub(super) instance: Arc<FMU3>,
    pub(super) references: &'a References,
}

impl Instance for Fmi3<'_> {
    fn set_force_linear(&self, linear: bool) -> Result<(), &'static str> {
        done(self.instance.setBoolean(&[self.references.force_linear], &[linear]), "fmi3SetBoolean")
    }

    fn set_forces(&self, forces: &[f64]) -> Result<(), &'static str> {
        done(self.instance.setFloat64(&self.references.forces, forces), "fmi3SetFloat64")
    }

    fn initialise(&self, start: f64, forces: &[f64]) -> Result<(), &'static str> {
        done(self.instance.enterInitializationMode(None, start, None), "fmi3EnterInitializationMode")?;
        self.set_forces(forces)?;
        done(self.instance.exitInitializationMode(), "fmi3ExitInitializationMode")
    }

    fn step(&self, from: f64, step: f64) -> Result<(), &'static str> {
        let (mut event, mut terminate, mut early, mut last) = (false, false, false, from);
        let status = self.instance.doStep(from, step, true, &mut event, &mut terminate, &mut early, &mut last);
        done(status, "fmi3DoStep")?;
        // None of these was allowed, so an FMU that does one has left the agreed path.
        if event || terminate || early { Err("fmi3DoStep, which ended before the step's end") } else { Ok(()) }
    }

    fn outputs(&self) -> Result<Vec<f64>, &'static str> {
        let mut values = vec![0.0; self.references.output_count];
        done(self.instance.getFloat64(&self.references.outputs, &mut values), "fmi3GetFloat64")?;
        Ok(values)
    }

    fn terminate(&self) -> Result<(), &'static str> {
        done(self.instance.terminate(), "fmi3Terminate")
    }
}

fn done(status: fmi3Status, call: &'static str) -> Result<(), &'static str> {
    if matches!(status, fmi3Status::Ok | fmi3Status::Warning) { Ok(()) } else { Err(call) }
}
