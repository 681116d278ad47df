//! `export`: an FMU of a model.

use std::path::PathBuf;

use orthopanel::outputs::Inputs;
use orthopanel::{Error, FmiVersion, FmuOptions, Model, is_fmu_name};
use orthopanel_data::limits;
use orthopanel_export::{Connections, FmuModes, Library, Mount, Platform, Residual, parameter_samples};
use orthopanel_model::{PanelModel, Ports, VISCOELASTIC_CORE, is_identifier};
use serde::Serialize;

use crate::arguments::{ModeArguments, NamedPortArguments, identifier, on_piece, place};
use crate::error::CommandError;
use crate::terminal::{self, Terminal};
use crate::{console, progress};

/// Write a model as an FMU for co-simulation and model exchange: force in; acceleration, velocity and displacement out
///
/// No compiler is needed. Inputs are force_1, force_2, ... in N, outputs acceleration_1, velocity_1,
/// displacement_1, ... in SI units, numbered in the order of the places given; a place with a name has force_NAME,
/// acceleration_NAME, ... Sizes, mass, constants, effects' numbers, damping ratios and places are parameters of the FMU,
/// which solves its modes anew where one is set; damping ratios and places may be set while it runs, too.
///
/// The edges are held as the model file's "boundary" says (see `orthopanel modes --help`): left and right, of a plate front and
/// back too.
///
/// Example: orthopanel export out/model.json -o panel.fmu --fmi 3 --modes 6 --name floor --force seat=-0.3 --response seat=0.3 --response 0,0.02
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Model file (orthopanel.model/1, JSON)
    model: PathBuf,
    /// FMU to write
    #[arg(short, long, value_name = "X.fmu")]
    output: PathBuf,
    /// Version of the FMI standard
    #[arg(long, value_name = "2|3", default_value = "2", value_parser = version)]
    fmi: FmiVersion,
    #[command(flatten)]
    modes: ModeArguments,
    #[command(flatten)]
    ports: NamedPortArguments,
    /// What the FMU is called: model name, model identifier and file of the library. Two panels in one vehicle have two names
    /// [default: the model file's "name", else panel]
    #[arg(long, value_parser = identifier)]
    name: Option<String>,
    /// What stands for the modes left out: residual modes of each force, or nothing, for an integrator of model exchange that is not to
    /// follow their frequencies
    #[arg(long, value_name = "attachment|none", default_value = "attachment", value_parser = residual)]
    residual: Residual,
    /// A spring [N/m] and a damper [N s/m] between the panel and a base, inside the FMU: inputs base_displacement_NAME and
    /// base_velocity_NAME, output base_force_NAME, parameters mount_NAME_stiffness and mount_NAME_damping; may be repeated
    #[arg(long = "mount", value_name = "NAME=X,Y,STIFFNESS,DAMPING", value_parser = mount, allow_hyphen_values = true)]
    mounts: Vec<Mount>,
    /// Couples in at each place of force (moment_x_.., moment_y_..), rotations and their rates out at each place of response
    #[arg(long)]
    rotations: bool,
    /// An input gravity [m/s2]: a uniform field of acceleration, -9.81 where +z points up
    #[arg(long)]
    gravity: bool,
    /// An input pressure \[Pa\]: uniform on the face
    #[arg(long)]
    pressure: bool,
    /// Inputs base_acceleration [m/s2] and base_angular_acceleration_x, _y [rad/s2] of the frame that holds the edges; motions are then absolute,
    /// and frame_force, frame_moment_x and _y come out
    #[arg(long)]
    base_acceleration: bool,
    /// One array for all forces and one for each kind of output (FMI 3 alone) in place of a variable each
    #[arg(long)]
    arrays: bool,
    /// The runtime of another platform, to lie beside this one's; may be repeated. Built there from the crate orthopanel-fmu
    #[arg(long = "library", value_name = "PLATFORM=FILE", value_parser = platform_and_file)]
    libraries: Vec<(Platform, PathBuf)>,
    /// Write an SSP (1.0) beside the FMU, too: the FMU with its connectors and a set of its parameters
    #[arg(long)]
    ssp: bool,
    /// Sets of parameters in the SSP beside those of the model, drawn by the standard deviations and the correlation of its
    /// constants and damping ratios
    #[arg(long, value_name = "N", requires = "ssp", default_value_t = 0, value_parser = samples, allow_negative_numbers = true)]
    samples: usize,
    /// Write an FMU of C99 sources beside the FMU, too, as X-sources.fmu: co-simulation with fixed parameters, no library but libm, for
    /// targets that no library is built for
    #[arg(long)]
    sources: bool,
    /// Print one JSON object (orthopanel.export/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer<'a> {
    schema: &'static str,
    file: &'a PathBuf,
    #[serde(skip_serializing_if = "Option::is_none")]
    ssp: Option<&'a PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sources: Option<&'a PathBuf>,
    name: String,
    fmi: &'static str,
    rigid_modes: usize,
    flexible_modes: usize,
    highest_hz: f64,
    residual_hz: Vec<f64>,
    ports: &'a Ports,
    /// Effects of rig and measuring chain.
    left_out: Vec<&'static str>,
}

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    is_fmu_name(&arguments.output)?;
    let path = &arguments.model;
    let inputs = arguments.libraries.iter().fold(Inputs::of(path), |inputs, (_, library)| inputs.and(library));
    let ssp = arguments.ssp.then(|| arguments.output.with_extension("ssp"));
    let sources = arguments.sources.then(|| {
        let stem = arguments.output.file_stem().unwrap_or_default().to_string_lossy();
        arguments.output.with_file_name(format!("{stem}-sources.fmu"))
    });
    let planned = [Some(&arguments.output), ssp.as_ref(), sources.as_ref()].into_iter().flatten().cloned();
    let mut outputs = terminal::outputs(inputs, words)?.all_planned(planned)?;
    let read = Model::load(path)?;
    let model = read.panel();
    let ports = arguments.ports.needed(model, path)?;
    let shown = progress::spinner("finding modes and making the FMU");
    let in_file = |source| Error::Model { path: path.clone(), source };
    let (alone, left_out) = model.panel_alone().map_err(in_file)?;
    on_piece(model, "mount", &arguments.mounts.iter().map(|mount| mount.at).collect::<Vec<_>>())?;
    let options = options(arguments, model)?;
    let name = options.name.clone();
    let fmu = read.fmu(arguments.modes.range(), &ports, &options)?;
    let FmuModes { rigid: rigid_modes, flexible: flexible_modes, highest_hz, residual_hz, core } = fmu.modes().clone();
    let bytes = fmu.to_bytes()?;
    drop(shown);
    outputs.add(&arguments.output, bytes);
    if let Some(path) = &ssp {
        let samples = parameter_samples(&alone, arguments.samples).map_err(in_file)?;
        if samples.first().is_some_and(Vec::is_empty) {
            return Err(CommandError::Option {
                option: "samples",
                value: arguments.samples.to_string(),
                remedy: "no constant of this model has a standard deviation, and no damping ratio: leave it out, or write {\"value\": .., \"std\": ..}".into(),
            });
        }
        outputs.add(path, fmu.to_ssp(&samples)?);
    }
    if let Some(path) = &sources {
        outputs.add(path, fmu.to_source_bytes()?);
    }
    outputs.write(&Terminal)?;
    let answer = Answer {
        schema: "orthopanel.export/1",
        file: &arguments.output,
        ssp: ssp.as_ref(),
        sources: sources.as_ref(),
        name,
        fmi: if arguments.fmi == FmiVersion::Fmi2 { "2.0" } else { "3.0" },
        rigid_modes,
        flexible_modes,
        highest_hz,
        residual_hz,
        ports: &ports,
        left_out,
    };
    console::say(format_args!(
        "wrote {} (FMI {}, {rigid_modes} rigid and {} flexible modes up to {:.1} Hz)",
        arguments.output.display(),
        answer.fmi,
        answer.flexible_modes,
        answer.highest_hz
    ));
    if let [first, .., last] = answer.residual_hz[..] {
        let count = answer.residual_hz.len();
        console::say(format_args!("{count} residual modes from {first:.0} to {last:.0} Hz stand for all others"));
    }
    if let Some(path) = &ssp {
        console::say(format_args!("wrote {} ({} samples)", path.display(), arguments.samples));
    }
    if let Some(path) = &sources {
        console::say(format_args!("wrote {} (C99)", path.display()));
    }
    if let Some(fit) = &core {
        let [from, to] = fit.band;
        let percent = 100.0 * fit.error;
        console::say(format_args!(
            "{VISCOELASTIC_CORE}: fitted within {percent:.2} % of its modulus from {from:.0} to {to:.0} Hz"
        ));
    }
    if answer.flexible_modes == 0 {
        let does = if rigid_modes > 0 {
            "moves as a whole, and yields by its residual modes alone"
        } else {
            "yields by its residual modes alone"
        };
        console::say(format_args!("no flexible mode is kept: this panel {does}; ask for more by --modes or --up-to"));
    }
    if !answer.left_out.is_empty() {
        console::say(format_args!("left out, as no part of the panel: {}", answer.left_out.join(", ")));
    }
    if arguments.json {
        console::print_json(&answer)?;
    }
    Ok(())
}

fn options(arguments: &Arguments, model: &PanelModel) -> Result<FmuOptions, CommandError> {
    let library = |(platform, path): &(Platform, PathBuf)| {
        let content =
            limits::LIBRARY_FILE.read(path).map_err(|source| Error::Unreadable { path: path.into(), source })?;
        Ok(Library::new(*platform, content)?)
    };
    let libraries = arguments.libraries.iter().map(library).collect::<Result<_, CommandError>>()?;
    let usual = FmuOptions::default();
    Ok(FmuOptions {
        name: arguments.name.as_ref().or(model.name.as_ref()).cloned().unwrap_or(usual.name),
        version: arguments.fmi,
        names: arguments.ports.names(),
        arrays: arguments.arrays,
        residual: arguments.residual,
        connections: Connections {
            mounts: arguments.mounts.clone(),
            rotations: arguments.rotations,
            gravity: arguments.gravity,
            pressure: arguments.pressure,
            base_acceleration: arguments.base_acceleration,
        },
        libraries,
        ..usual
    })
}

fn platform_and_file(text: &str) -> Result<(Platform, PathBuf), String> {
    let (platform, file) = text.split_once('=').ok_or("must be PLATFORM=FILE, as x86_64-windows=orthopanel_fmu.dll")?;
    Ok((platform.parse().map_err(|error: orthopanel_export::ExportError| error.to_string())?, file.into()))
}

fn residual(text: &str) -> Result<Residual, String> {
    match text {
        "attachment" => Ok(Residual::Attachment),
        "none" => Ok(Residual::None),
        _ => Err("must be attachment or none".into()),
    }
}

/// Reads `NAME=X,Y,STIFFNESS,DAMPING`.
fn mount(text: &str) -> Result<Mount, String> {
    let example = "give a mount as NAME=X,Y,STIFFNESS,DAMPING in m, N/m and N s/m, as seat=-0.3,0.1,2e5,40";
    let (name, rest) = text.split_once('=').ok_or_else(|| format!("{text:?} has no name: {example}"))?;
    if !is_identifier(name) {
        return Err(format!("{name:?} is no name of letters, digits and _ (no digit first): {example}"));
    }
    let numbers: Vec<&str> = rest.split(',').collect();
    let [x, y, stiffness, damping] = numbers[..] else {
        return Err(format!("{} numbers behind {name}=, not 4: {example}", numbers.len()));
    };
    let law = |what: &str, text: &str| match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err(format!("{what} {text:?} is no finite number that is not below zero: {example}")),
    };
    let (stiffness, damping) = (law("stiffness", stiffness)?, law("damping", damping)?);
    Ok(Mount { name: name.into(), at: place(&format!("{x},{y}"))?, stiffness, damping })
}

/// Reads how many sets of parameters there shall be.
fn samples(text: &str) -> Result<usize, String> {
    const MOST: usize = 10_000;
    match text.trim().parse() {
        Ok(count) if count <= MOST => Ok(count),
        _ => Err(format!("must be a whole number up to {MOST}")),
    }
}

fn version(text: &str) -> Result<FmiVersion, String> {
    match text {
        "2" | "2.0" => Ok(FmiVersion::Fmi2),
        "3" | "3.0" => Ok(FmiVersion::Fmi3),
        _ => Err("must be 2 or 3".into()),
    }
}
