//! `run`: the whole way from a test to models, FMUs, a response and pictures.

use std::path::PathBuf;

use orthopanel_export::{FmiVersion, Fmu, FmuOptions};
use orthopanel_identify::PieceFit;
use orthopanel_model::PanelModel;
use serde::Serialize;

use crate::arguments::{DENSE_MODES, USUAL_MODES};
use crate::error::{CommandError, InFile as _};
use crate::force_file::ForceHistory;
use crate::identified::{Answer, Identified};
use crate::record_options::IdentifyOptions;
use crate::time_response::Hold;
use crate::{output, pictures, time_response};

/// Do all of it: identify the panel of a test, export its FMUs, simulate a hit, draw the result
///
/// Into DIR go model.json, panel.fmu (FMI 2.0), panel-fmi3.fmu (FMI 3.0), identified.json, response.csv (a half-sine
/// hit of 100 N and 0.5 ms at the first force place) and pictures as SVG. With several pieces in the test, each has
/// its own: model-NAME.json and so on.
///
/// Example: orthopanel run examples/piece-1/test.toml -o out
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml)
    test: PathBuf,
    /// Folder for the results; made where it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    options: IdentifyOptions,
    /// Print one JSON object (orthopanel.run/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct RunAnswer<'a> {
    schema: &'static str,
    identified: &'a Answer,
    files: &'a [PathBuf],
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let identified = Identified::from_test(&arguments.test, arguments.options.settings())?;
    let mut files = output::Files::default();
    files.add("identified.json", output::json(&identified.answer));
    for (fit, model) in identified.found.pieces.iter().zip(&identified.models) {
        add_piece(&mut files, arguments, &identified.suffix(fit), fit, model)?;
    }
    let files = files.write_into(&arguments.output)?;
    for path in &files {
        eprintln!("wrote {}", path.display());
    }
    if arguments.json {
        let answer = RunAnswer { schema: "orthopanel.run/1", identified: &identified.answer, files: &files };
        output::print_json(&answer);
    } else {
        output::print(&identified.tables());
    }
    Ok(())
}

/// Model, FMUs, response and pictures of one piece.
fn add_piece(
    files: &mut output::Files,
    arguments: &Arguments,
    suffix: &str,
    fit: &PieceFit,
    model: &PanelModel,
) -> Result<(), CommandError> {
    files.add(format!("model{suffix}.json"), model.to_json());
    let ports = &model.ports;
    let seen = model.modal_model(USUAL_MODES, &ports.forces, &ports.responses).in_file(&arguments.test)?;
    for (version, ending) in [(FmiVersion::Fmi2, ""), (FmiVersion::Fmi3, "-fmi3")] {
        let options = FmuOptions { version, ..FmuOptions::default() };
        let fmu = Fmu::new(seen.clone(), ports.clone(), &options)?;
        files.add(format!("panel{suffix}{ending}.fmu"), fmu.to_bytes()?);
    }
    let hit = ForceHistory::half_sine(ports.forces.len());
    let motions = time_response::simulate(&seen, &hit, Hold::Linear).in_file(&arguments.test)?;
    files.add(format!("response{suffix}.csv"), time_response::csv(&hit, &motions));
    files.add(format!("response{suffix}.svg"), pictures::response(&hit, &motions)?);
    if !fit.modes.is_empty() {
        files.add(format!("frequencies{suffix}.svg"), pictures::frequencies(fit)?);
    }
    let dense = model.modal_model(DENSE_MODES, &ports.forces, &ports.responses).in_file(&arguments.test)?;
    files.add(format!("accelerance{suffix}.svg"), pictures::accelerance(fit, ports, &dense)?);
    Ok(())
}
