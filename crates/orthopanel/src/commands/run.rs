//! `run`: the whole way from a test to models, FMUs, a response and pictures.

use std::path::PathBuf;

use orthopanel_export::{FmiVersion, Fmu, FmuOptions};
use orthopanel_identify::ForceBetweenSamples;
use orthopanel_model::PanelModel;
use serde::Serialize;

use crate::arguments::USUAL_MODES;
use crate::driving_force::DrivingForce;
use crate::error::{CommandError, InFile as _};
use crate::force_file::ForceHistory;
use crate::identified::{Answer, Identified};
use crate::measured_pairs::{ComparedPair, HitMisfit, misfit_table};
use crate::record_options::IdentifyOptions;
use crate::time_response::Hold;
use crate::whole_accelerance::WholeAccelerance;
use crate::{output, pictures, progress, time_response};

/// Do all of it: identify the panel of a test, export its FMUs, simulate a hit, draw the result
///
/// Into DIR go model.json, panel.fmu (FMI 2.0), panel-fmi3.fmu (FMI 3.0), identified.json, response.csv (a half-sine
/// hit of 100 N and 0.5 ms at the first force place) and pictures as SVG. With several pieces in the test, each has
/// its own: model-NAME.json and so on.
///
/// Of records, each pair of places gets a picture of the accelerance, measured and calculated, and one of a hit with
/// the accelerations measured and calculated under it; time-histories.json tells how far the model is from every hit.
///
/// Examples: orthopanel run examples/piece-1/test.toml -o out
///           orthopanel run examples/made-hits/test.toml -o out
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
    /// One entry a measured hit.
    hits: &'a [HitMisfit],
    files: &'a [PathBuf],
}

#[derive(Serialize)]
struct HitsAnswer<'a> {
    schema: &'static str,
    hits: &'a [HitMisfit],
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let identified = Identified::from_test(&arguments.test, &arguments.options)?;
    let mut files = output::Files::default();
    files.add("identified.json", output::json(&identified.answer));
    for (index, model) in identified.models.iter().enumerate() {
        add_piece(&mut files, arguments, &identified, index, model)?;
    }
    let hits = add_records(&mut files, arguments, &identified)?;
    let files = files.write_into(&arguments.output)?;
    for path in &files {
        eprintln!("wrote {}", path.display());
    }
    if arguments.json {
        let answer =
            RunAnswer { schema: "orthopanel.run/1", identified: &identified.answer, hits: &hits, files: &files };
        output::print_json(&answer);
    } else {
        output::print(&identified.tables());
        if !hits.is_empty() {
            output::print(&format!("\nmeasured hits, and the model driven by their forces\n{}", misfit_table(&hits)));
        }
    }
    Ok(())
}

/// Model, FMUs, response and pictures of one piece.
fn add_piece(
    files: &mut output::Files,
    arguments: &Arguments,
    identified: &Identified,
    index: usize,
    model: &PanelModel,
) -> Result<(), CommandError> {
    let Some(fit) = identified.found.pieces.get(index) else { return Ok(()) };
    let suffix = identified.suffix(fit);
    files.add(format!("model{suffix}.json"), model.to_json());
    let ports = &model.ports;
    let seen = model.modal_model(USUAL_MODES, &ports.forces, &ports.responses).in_file(&arguments.test)?;
    for (version, ending) in [(FmiVersion::Fmi2, ""), (FmiVersion::Fmi3, "-fmi3")] {
        let options = FmuOptions { version, ..FmuOptions::default() };
        let fmu = Fmu::of_panel(model, USUAL_MODES, ports.clone(), &options)?;
        files.add(format!("panel{suffix}{ending}.fmu"), fmu.to_bytes()?);
    }
    let hit = DrivingForce::new(ForceHistory::half_sine(ports.forces.len()), Hold::Linear, &arguments.test)?;
    let motions = time_response::simulate(&seen, &hit).in_file(&arguments.test)?;
    let hit = hit.samples;
    files.add(format!("response{suffix}.csv"), time_response::csv(&hit, &motions));
    files.add(format!("response{suffix}.svg"), pictures::response(&hit, &motions)?);
    if !fit.modes.is_empty() {
        files.add(format!("frequencies{suffix}.svg"), pictures::frequencies(fit)?);
    }
    // Measured ones are drawn with the records.
    if identified.found.accelerances.iter().any(|pair| pair.piece == index) {
        return Ok(());
    }
    if let (Some(&force), Some(&response)) = (ports.forces.first(), ports.responses.first()) {
        let highest = fit.modes.iter().map(|mode| mode.measured).fold(0.0, f64::max);
        let seen = WholeAccelerance::up_to(model, highest, force, response).in_file(&arguments.test)?;
        files.add(format!("accelerance{suffix}.svg"), pictures::accelerance(fit, [force, response], &seen)?);
    }
    Ok(())
}

/// Pictures of the records, measured against calculated, and the misfit of every hit.
fn add_records(
    files: &mut output::Files,
    arguments: &Arguments,
    identified: &Identified,
) -> Result<Vec<HitMisfit>, CommandError> {
    let Identified { test, found, models, .. } = identified;
    let decay_rate = arguments.options.settings()?.estimation.window.decay_rate();
    for (index, fit) in found.pieces.iter().enumerate() {
        let own: Vec<_> = found.accelerances.iter().filter(|pair| pair.piece == index).collect();
        for (number, pair) in own.iter().enumerate() {
            let name = format!("accelerance{}{}.svg", identified.suffix(fit), numbered(number, own.len()));
            files.add(name, pictures::measured_accelerance(&fit.name, pair, decay_rate)?);
        }
    }
    let histories = test.time_histories()?;
    let counts = |piece: usize| histories.iter().filter(|(of, _)| *of == piece).count();
    let counts: Vec<usize> = (0..found.pieces.len()).map(counts).collect();
    let mut done = vec![0; counts.len()];
    let mut misfits = Vec::new();
    let shown = progress::bar("driving the model", histories.len());
    for (piece, history) in histories {
        let (Some(fit), Some(model)) = (found.pieces.get(piece), models.get(piece)) else { continue };
        let places = (history.force_at, history.response_at);
        let mut own = found.accelerances.iter().filter(|pair| pair.piece == piece);
        let pair = own.find(|pair| (pair.force_at, pair.response_at) == places);
        let band = pair.and_then(|pair| Some(*pair.frequency.first()?..=*pair.frequency.last()?));
        let compared = ComparedPair::of(model, history, ForceBetweenSamples::BandLimited, band)
            .map_err(|source| CommandError::Identify { path: arguments.test.clone(), source })?;
        let name = format!("time-history{}{}.svg", identified.suffix(fit), numbered(done[piece], counts[piece]));
        files.add(name, pictures::time_history(&fit.name, &compared)?);
        misfits.extend(compared.misfits());
        done[piece] += 1;
        shown.step();
    }
    if !misfits.is_empty() {
        files.add(
            "time-histories.json",
            output::json(&HitsAnswer { schema: "orthopanel.simulated-hits/1", hits: &misfits }),
        );
    }
    Ok(misfits)
}

/// `-NUMBER` from 1 where there are several.
fn numbered(index: usize, of: usize) -> String {
    if of == 1 { String::new() } else { format!("-{}", index + 1) }
}
