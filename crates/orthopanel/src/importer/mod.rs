//! Running an FMU through the crate `fmi-rs`: the FMU is unpacked, loaded and stepped as any simulator would do it.

mod fmi2;
mod fmi3;

use std::path::Path;

use fmi_rs::model_description::{FMIMajorVersion, peek_fmi_major_version};

use crate::driving_force::DrivingForce;
use crate::error::CommandError;
use crate::time_response::{Motion, steps};

/// One FMU instance, whatever its version. `Err` carries the name of the call that failed.
trait Instance {
    /// Sets whether forces run linearly over a step; before [`Instance::initialise`].
    fn set_force_linear(&self, linear: bool) -> Result<(), &'static str>;
    fn set_forces(&self, forces: &[f64]) -> Result<(), &'static str>;
    /// Starts the clock at `start` \[s\] with these forces \[N\], from which a linear force runs on.
    fn initialise(&self, start: f64, forces: &[f64]) -> Result<(), &'static str>;
    fn step(&self, from: f64, step: f64) -> Result<(), &'static str>;
    /// Accelerations of all responses, then velocities, then displacements.
    fn outputs(&self) -> Result<Vec<f64>, &'static str>;
    fn terminate(&self) -> Result<(), &'static str>;
}

/// Value references of the variables that orthopanel's FMUs have.
struct References {
    force_linear: u32,
    forces: Vec<u32>,
    force_count: usize,
    outputs: Vec<u32>,
    /// Numbers in all outputs together.
    output_count: usize,
}

impl References {
    /// Finds the variables by name, each with how many numbers it holds: one a port, or one array for all ports of a kind. `Err`
    /// tells which is missing.
    fn find(variable: impl Fn(&str) -> Option<(u32, usize)>) -> Result<Self, String> {
        let needed = |kind: &str| -> Result<(Vec<u32>, usize), String> {
            let numbered: Vec<_> = (1..).map_while(|port| variable(&format!("{kind}_{port}"))).collect();
            let array = || variable(kind).map(|whole| vec![whole]);
            let found = if numbered.is_empty() { array() } else { Some(numbered) };
            let found = found.ok_or_else(|| format!("it has neither a variable {kind}_1 nor an array {kind}"))?;
            Ok((found.iter().map(|(reference, _)| *reference).collect(), found.iter().map(|(_, size)| size).sum()))
        };
        let (mut outputs, mut output_count) = (Vec::new(), 0);
        for kind in ["acceleration", "velocity", "displacement"] {
            let (mut references, count) = needed(kind)?;
            outputs.append(&mut references);
            output_count += count;
        }
        let (force_linear, _) = variable("force_linear").ok_or("it has no variable force_linear")?;
        let (forces, force_count) = needed("force")?;
        Ok(Self { force_linear, forces, force_count, outputs, output_count })
    }
}

/// Whether the file is an FMU: by its content a zip archive, as every FMU is.
///
/// A file of that name alone is refused, since nobody who writes `x.fmu` means a model file.
pub fn is_fmu(path: &Path) -> Result<bool, CommandError> {
    use std::io::Read as _;
    let unreadable = |source| CommandError::Unreadable { path: path.into(), source };
    let mut start = Vec::new();
    std::fs::File::open(path).map_err(unreadable)?.take(4).read_to_end(&mut start).map_err(unreadable)?;
    let archive = start == b"PK\x03\x04";
    if !archive && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("fmu")) {
        return Err(foreign(path, "it is no zip archive".into()));
    }
    Ok(archive)
}

/// Runs the FMU at `path`; `force` is read once the FMU has told how many force places it has.
pub fn simulate(
    path: &Path,
    force: impl FnOnce(usize) -> Result<DrivingForce, CommandError>,
) -> Result<(DrivingForce, Vec<Motion>), CommandError> {
    let import = |source| CommandError::Import { path: path.into(), source };
    match version(path)? {
        FMIMajorVersion::V2 => {
            let fmu = fmi_rs::fmi2::builder::FMU2Builder::new(&path).map_err(import)?;
            let references = fmi2::references(&fmu.model_description);
            let references = references.map_err(|problem| foreign(path, problem))?;
            let force = force(references.force_count)?;
            let instance =
                fmi2::Fmi2 { instance: fmu.instantiate_cs("panel").map_err(import)?, references: &references };
            let motions = run(&instance, &references, &force).map_err(|call| failed(path, call))?;
            Ok((force, motions))
        }
        FMIMajorVersion::V3 => {
            let mut fmu = fmi_rs::fmi3::builder::FMU3Builder::new(&path).map_err(import)?;
            (fmu.eventModeUsed, fmu.earlyReturnAllowed) = (false, false);
            let references = fmi3::references(&fmu.model_description);
            let references = references.map_err(|problem| foreign(path, problem))?;
            let force = force(references.force_count)?;
            let instance =
                fmi3::Fmi3 { instance: fmu.instantiate_cs("panel").map_err(import)?, references: &references };
            let motions = run(&instance, &references, &force).map_err(|call| failed(path, call))?;
            Ok((force, motions))
        }
    }
}

fn version(path: &Path) -> Result<FMIMajorVersion, CommandError> {
    let folder = tempfile::tempdir().map_err(|source| CommandError::Unreadable { path: path.into(), source })?;
    fmi_rs::zip::extract_zip_archive(path, &folder)
        .map_err(|error| foreign(path, format!("its zip archive cannot be unpacked ({error})")))?;
    let description = folder.path().join("modelDescription.xml");
    if !description.is_file() {
        return Err(foreign(path, "its zip archive has no modelDescription.xml".into()));
    }
    peek_fmi_major_version(&description).map_err(|error| foreign(path, format!("its modelDescription.xml: {error}")))
}

fn foreign(path: &Path, problem: String) -> CommandError {
    CommandError::ForeignFmu { path: path.into(), problem }
}

fn failed(path: &Path, call: &str) -> CommandError {
    CommandError::FmuCall { path: path.into(), call: call.into() }
}

/// The co-simulation itself, at the samples of the force.
fn run(instance: &dyn Instance, references: &References, driving: &DrivingForce) -> Result<Vec<Motion>, &'static str> {
    let (force, held) = (driving.stepped(), driving.is_held());
    let responses = references.output_count / 3;
    let mut motions = vec![Motion::default(); responses];
    instance.set_force_linear(!held)?;
    instance.initialise(force.time.first().copied().unwrap_or(0.0), &force.at(0))?;
    record(instance, &mut motions)?;
    for (index, (step, from)) in steps(&force.time).into_iter().zip(&force.time).enumerate() {
        let forces = force.at(index + 1);
        // A linear force is set to its value at the step's end before the step, a held one after it.
        if !held {
            instance.set_forces(&forces)?;
        }
        instance.step(*from, step)?;
        if held {
            instance.set_forces(&forces)?;
        }
        record(instance, &mut motions)?;
    }
    instance.terminate()?;
    Ok(driving.at_samples(motions))
}

fn record(instance: &dyn Instance, motions: &mut [Motion]) -> Result<(), &'static str> {
    let values = instance.outputs()?;
    let count = motions.len();
    for (port, motion) in motions.iter_mut().enumerate() {
        motion.acceleration.extend(values.get(port));
        motion.velocity.extend(values.get(count + port));
        motion.displacement.extend(values.get(2 * count + port));
    }
    Ok(())
}
