//! Running an FMU through the crate `fmi-rs`: the FMU is judged, unpacked once, loaded and stepped as any simulator would do it.
//!
//! An FMU is a stranger's file: `archive` and `description` hold it against limits before anything is believed, and `library`
//! says whose code is run.

mod archive;
mod description;
mod fmi2;
mod fmi3;
mod instance;
mod library;
mod log;

use std::error::Error as _;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use fmi_rs::sim::SimulationError;

use self::archive::Archive;
use self::description::Description;
use self::instance::{Instance, References};
use self::log::Log;
use crate::driving_force::DrivingForce;
use crate::error::Error;
use crate::fmu_refusal::{FmuRefusal, shown};
use crate::motion::Motion;
use crate::notes::note;
use crate::observer::Observer;
use crate::time_response::steps;

/// Whether the file is an FMU: by its content a zip archive, as every FMU is.
///
/// A file of that name alone is refused, since nobody who writes `x.fmu` means a model file.
pub fn is_fmu(path: &Path) -> Result<bool, Error> {
    use std::io::Read as _;
    let unreadable = |source| Error::Unreadable { path: path.into(), source };
    let mut start = Vec::new();
    orthopanel_data::regular_file(path).map_err(unreadable)?;
    File::open(path).map_err(unreadable)?.take(4).read_to_end(&mut start).map_err(unreadable)?;
    let archive = start == b"PK\x03\x04";
    if !archive && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("fmu")) {
        return Err(Error::Fmu { path: path.into(), source: FmuRefusal::NoArchive });
    }
    Ok(archive)
}

/// Runs the FMU at `path`; `force` is read once the FMU has told how many force places it has. A library that this program does
/// not carry is loaded only where the user says `trust`.
pub fn simulate(
    path: &Path,
    trust: bool,
    observer: &dyn Observer,
    force: impl FnOnce(usize) -> Result<DrivingForce, Error>,
) -> Result<(DrivingForce, Vec<Motion>), Error> {
    let refused = |source| Error::Fmu { path: path.into(), source };
    let file = File::open(path).map_err(|source| Error::Unreadable { path: path.into(), source })?;
    let mut archive = Archive::new(file).map_err(refused)?;
    let description = archive.take("modelDescription.xml", description::MOST_BYTES).map_err(refused)?;
    let description = description.ok_or(FmuRefusal::NoDescription).and_then(|content| Description::parse(&content));
    let description = description.map_err(refused)?;
    let library = description.library().map_err(refused)?;
    let references = description.references().map_err(refused)?;
    // Dropped after the instance: Windows keeps a library's file while it is loaded.
    let folder = library::unpack(&mut archive, &library, trust).map_err(refused)?;
    let force = force(references.force_count)?;
    let log = Log::new();
    let loaded = instance(folder.path(), &library, &description, &references, &log);
    let instance = loaded.map_err(|error| refused(not_loaded(error, &library, &log)))?;
    let motions = run(&*instance, &references, &force);
    let motions = motions.map_err(|call| refused(FmuRefusal::Call { call, messages: log.taken() }))?;
    note(observer, &format!("{}: ", path.display()), &log.taken());
    Ok((force, motions))
}

fn instance<'a>(
    folder: &Path,
    library: &str,
    description: &Description,
    references: &'a References,
    log: &Arc<Log>,
) -> Result<Box<dyn Instance + 'a>, SimulationError> {
    let log = Arc::clone(log);
    Ok(match description {
        Description::Fmi2(description) => Box::new(fmi2::Fmi2::new(folder, description, references, log)?),
        Description::Fmi3(description) => Box::new(fmi3::Fmi3::new(folder, library, description, references, log)?),
    })
}

/// What `fmi-rs` says where an FMU is not there to be run: its library, or the FMU itself.
fn not_loaded(error: SimulationError, library: &str, log: &Log) -> FmuRefusal {
    let reason = match &error {
        SimulationError::FMICall => return FmuRefusal::NoInstance(log.taken()),
        SimulationError::Symbol { name, .. } => format!("it has no function {name}"),
        SimulationError::Library { source, .. } => {
            // Its own words are that loading failed; the system's, behind them, say which file and why.
            let cause = source.source().map_or_else(|| source.to_string(), ToString::to_string);
            format!("{cause} (it is unpacked where temporary files lie: TMPDIR can name another folder)")
        }
        _ => error.to_string(),
    };
    FmuRefusal::Load { path: library.into(), reason: shown(&reason) }
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
