//! `simulate`: response in time of a model, or of an FMU, to a measured or made-up force.

mod arguments;
mod on_records;

use orthopanel::driving_force::DrivingForce;
use orthopanel::force_file::ForceHistory;
use orthopanel::measured_pairs::is_test_file;
use orthopanel::outputs::Inputs;
use orthopanel::time_response::{Hold, Motion};
use orthopanel::{Error, Model, importer, time_response};

use crate::console;
use crate::error::CommandError;
use crate::terminal::{self, Terminal};
pub use arguments::Arguments;
use arguments::Method;

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let (inputs, force_file) = (Inputs::of(&arguments.model), &arguments.force_file);
    let (inputs, test) = if is_test_file(force_file) {
        let (of_test, test) = Inputs::reading_test(force_file)?;
        (inputs.and_all(of_test), Some(test))
    } else {
        (inputs.and(force_file), None)
    };
    let mut outputs = terminal::outputs(inputs, words)?.all_planned(arguments.output.clone())?;
    if test.is_some() || on_records::is_measured(force_file)? {
        return on_records::execute(arguments, test.as_ref(), outputs);
    }
    if arguments.method == Method::RungeKutta || arguments.steps.is_some() {
        let option = if arguments.steps.is_some() { "steps" } else { "method" };
        let problem = format!("--{option} belongs to measured hits, and this is a made-up force: leave it out");
        return Err(Error::Records { path: arguments.force_file.clone(), problem }.into());
    }
    let (force, motions) =
        if importer::is_fmu(&arguments.model)? { run_fmu(arguments)? } else { run_model(arguments)? };
    for (port, motion) in motions.iter().enumerate() {
        console::say(format_args!("response {}: peak acceleration {:.4e} m/s2", port + 1, motion.peak_acceleration()));
    }
    if let Some(path) = &arguments.output {
        outputs.add(path, time_response::csv(&force, &motions));
        outputs.write(&Terminal)?;
        console::say(format_args!("wrote {} ({} samples)", path.display(), force.time.len()));
    }
    if arguments.json {
        console::print(&time_response::to_json(&force, &motions))?;
    } else if arguments.output.is_none() {
        console::print(&time_response::csv(&force, &motions))?;
    }
    Ok(())
}

fn run_model(arguments: &Arguments) -> Result<(ForceHistory, Vec<Motion>), CommandError> {
    let path = &arguments.model;
    let model = Model::load(path)?;
    let ports = arguments.ports.needed(model.panel(), path)?;
    let force = driving_force(arguments, ports.forces.len())?;
    let motions = model.simulate(&force, &ports, arguments.modes.range(), &Terminal)?;
    Ok((force.samples, motions))
}

fn run_fmu(arguments: &Arguments) -> Result<(ForceHistory, Vec<Motion>), CommandError> {
    if arguments.ports.is_given() || arguments.modes.is_given() {
        return Err(CommandError::FixedInFmu { path: arguments.model.clone() });
    }
    let (force, motions) =
        importer::simulate(&arguments.model, arguments.trust, &Terminal, |places| driving_force(arguments, places))?;
    Ok((force.samples, motions))
}

fn driving_force(arguments: &Arguments, places: usize) -> Result<DrivingForce, Error> {
    let path = &arguments.force_file;
    let force = ForceHistory::read(path, places)?;
    DrivingForce::new(force, arguments.hold.map_or(Hold::Linear, Hold::from), path, &Terminal)
}
