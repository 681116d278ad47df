//! FMI 3.0.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use fmi_rs::fmi3::FMU3;
use fmi_rs::fmi3::native::NativeLibrary;
use fmi_rs::fmi3::types::fmi3Status;
use fmi_rs::model_description::fmi3::{Causality, Dimension, ModelDescription, VariableType};
use fmi_rs::sim::SimulationError;

use super::instance::{Instance, References, Variable};
use super::log::Log;

/// What is known of each variable by its name, with how many numbers it holds at the start: the most there can be where a
/// size is not told.
pub(super) fn variables(description: &ModelDescription) -> HashMap<&str, Variable> {
    let told = description.modelVariables.iter().filter_map(|variable| match &variable.variableType {
        VariableType::UInt64 { start: Some(start), .. } => Some((variable.valueReference, start.parse().ok()?)),
        _ => None,
    });
    let told: HashMap<u32, usize> = told.collect();
    let size = |dimension: &Dimension| match dimension {
        Dimension::Fixed { start } => *start,
        Dimension::Variable { valueReference } => told.get(valueReference).copied().unwrap_or(usize::MAX),
    };
    let variables = description.modelVariables.iter().map(|variable| {
        let numbers = variable.dimensions.iter().map(size).fold(1, usize::saturating_mul);
        let is_signal = matches!(variable.causality, Causality::Input | Causality::Output);
        (variable.name.as_str(), Variable { reference: variable.valueReference, numbers, is_signal })
    });
    variables.collect()
}

pub(super) struct Fmi3<'a> {
    instance: Arc<FMU3>,
    references: &'a References,
}

impl<'a> Fmi3<'a> {
    /// Loads the library at `path` of the FMU that is unpacked in `folder`.
    pub(super) fn new(
        folder: &Path,
        path: &str,
        description: &ModelDescription,
        references: &'a References,
        log: Arc<Log>,
    ) -> Result<Self, SimulationError> {
        let library = Box::new(NativeLibrary::load(folder.join(path))?);
        let resources = Some(folder.join("resources")).filter(|resources| resources.is_dir());
        let (visible, logging, log_calls) = (false, false, false);
        let (event_mode, early_return) = (false, false);
        let instance = FMU3::instantiateCoSimulation(
            library,
            resources.as_deref(),
            "panel",
            &description.instantiationToken,
            visible,
            logging,
            event_mode,
            early_return,
            log,
            log_calls,
            None,
        )?;
        Ok(Self { instance, references })
    }
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
