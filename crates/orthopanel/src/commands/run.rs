//! `run`: the whole way from a test to models, FMUs, a response and pictures.

use std::path::{Path, PathBuf};

use orthopanel_data::ImpactTest;
use orthopanel_export::{FmiVersion, Fmu, FmuOptions};
use orthopanel_identify::Tracing;
use orthopanel_model::{ModelError, PanelModel};
use serde::Serialize;

use crate::arguments::USUAL_MODES;
use crate::contradicted::Contradicted;
use crate::driving_force::DrivingForce;
use crate::error::{CommandError, InFile as _, SAYS_NO};
use crate::evidence::{Evidence, PieceEvidence};
use crate::force_file::ForceHistory;
use crate::identified::{Answer, Identified, suffixes};
use crate::measured_pairs::{HitMisfit, misfit_table};
use crate::origin::{Origin, Told};
use crate::outputs::{self, Inputs, Outputs};
use crate::record_options::IdentifyOptions;
use crate::reference_option::ReferenceOption;
use crate::time_response::Hold;
use crate::traced::Traced;
use crate::{console, json, pictures, progress, report, time_response};

/// Do all of it: identify the panel of a test, trace what its model lacks, export its FMUs, simulate a hit, draw the result
///
/// Into DIR go model.json, panel.fmu (FMI 2.0), panel-fmi3.fmu (FMI 3.0), identified.json, response.csv (a half-sine
/// hit of 100 N and 0.5 ms at the first force place), report.html (all of it on one page) and pictures as SVG. With several pieces in the test, each has
/// its own: model-NAME.json and so on.
///
/// Where the test can be traced, model and FMUs are those after tracing: effects of the panel stay in them, effects of
/// rig and measuring chain are taken out, and trace.json tells which (see `orthopanel trace --help`). Records that no beam
/// could give are traced all the same: trace.json and report.html tell what was found, and where it explains them, as by a
/// plate, its model and FMUs are written too.
///
/// Both identified.json and trace.json tell what they are of: the program, the test and its pieces, the date, and the SHA-256 of each file that
/// was read. SOURCE_DATE_EPOCH in the environment tells another date than today's: so the same inputs give the same bytes.
///
/// A manifest.json lists the results, each with its SHA-256, and what they were made from. What it lists is removed by the
/// next run into DIR that does not write it anew, unless it was changed since; no other file is, and none that is read. Where
/// a run replaces a file that was changed since, or that no run wrote, it keeps that as NAME.edited. A run that ends
/// with exit status 1 and no model leaves the results of an earlier one as they are.
///
/// Of records, each pair of places gets a picture of the accelerance, measured and calculated, and one of a hit with
/// the accelerations measured and calculated under it; time-histories.json tells how far the model is from every hit.
///
/// With --reference, the trace is against a sound panel of the same make (see `orthopanel trace --help`).
///
/// Examples: orthopanel run examples/piece-1/test.toml -o out
///           orthopanel run examples/made-hits/test.toml -o out
///           orthopanel run suspect/test.toml --reference good/test.toml -o out
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml), or the folder that holds it
    test: PathBuf,
    /// Folder for the results; made where it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    options: IdentifyOptions,
    #[command(flatten)]
    reference: ReferenceOption,
    /// Print one JSON object (orthopanel.run/1) on standard output
    #[arg(long)]
    json: bool,
}

/// Lists the results in the folder, with the command, the version and the inputs they are of.
const MANIFEST: &str = "manifest.json";

#[derive(Serialize)]
struct RunAnswer<'a> {
    schema: &'static str,
    /// `null` where the records contradict a beam, and only the trace tells what they are of.
    identified: Option<Told<'a, Answer>>,
    /// `null` where the test cannot be traced.
    trace: Option<Told<'a, Tracing>>,
    /// Why it cannot.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_traced: Option<&'a str>,
    /// One entry a measured hit.
    hits: &'a [&'a HitMisfit],
    files: &'a [PathBuf],
}

#[derive(Serialize)]
struct HitsAnswer<'a> {
    schema: &'static str,
    hits: &'a [&'a HitMisfit],
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let holds_earlier = outputs::lists_results(&arguments.output.join(MANIFEST));
    let done = make(arguments, holds_earlier);
    if holds_earlier && done.as_ref().is_err_and(|refused| refused.exit_code() == SAYS_NO) {
        let folder = arguments.output.display();
        console::say(format_args!("note: {folder}: the results in it are of an earlier run, and stay as they are"));
    }
    done
}

fn make(arguments: &Arguments, holds_earlier: bool) -> Result<(), CommandError> {
    let Arguments { test: path, output, options, reference, json } = arguments;
    let (inputs, test) = Inputs::reading_test(path)?;
    let (inputs, reference) = reference.read(inputs)?;
    let mut files = Outputs::of(inputs)?.filling(output, MANIFEST).planned_inside(names(&test))?;
    let identified = match Identified::from_test(&test, path, options) {
        Err(refused) => {
            let contradicted = Contradicted::of(test, reference.as_ref(), path, refused)?;
            let origin = Origin::of(path, &contradicted.test, files.inputs())?;
            let files = (contradicted.traced.explains() || !holds_earlier).then_some(files);
            return trace_alone(arguments, files, contradicted, &origin);
        }
        Ok(identified) => identified,
    };
    let traced = Traced::where_possible(&test, reference.as_ref(), path);
    let models =
        traced.as_ref().map_or_else(|_| identified.models.clone(), |traced| traced.applied_to(&identified.models));
    let evidence = Evidence::of(&identified, traced.as_ref().ok(), options.settings()?.estimation, path)?;
    let origin = Origin::of(path, &test, files.inputs())?;
    let provenance = &origin;
    files.add_inside("identified.json", json::line(&Told { answer: &identified.answer, provenance }));
    files.add_inside("report.html", report::page(path, &identified, &traced, &evidence)?);
    for ((fit, model), shown) in identified.found.pieces.iter().zip(&models).zip(&evidence.pieces) {
        let suffix = identified.suffix(fit);
        add_model(&mut files, path, &suffix, model)?;
        add_pictures(&mut files, &suffix, shown);
    }
    if let Ok(traced) = &traced {
        files.add_inside("trace.json", json::line(&Told { answer: &traced.tracing, provenance }));
    }
    let hits = &evidence.hits()[..];
    if !hits.is_empty() {
        let answer = HitsAnswer { schema: "orthopanel.simulated-hits/1", hits };
        files.add_inside("time-histories.json", json::line(&answer));
    }
    let files = written(files)?;
    if *json {
        let trace = traced.as_ref().ok().map(|traced| Told { answer: &traced.tracing, provenance });
        let not_traced = traced.as_ref().err().map(String::as_str);
        let identified = Some(Told { answer: &identified.answer, provenance });
        console::print_json(&RunAnswer {
            schema: "orthopanel.run/1",
            identified,
            trace,
            not_traced,
            hits,
            files: &files,
        })?;
    } else {
        let has_effects = traced.as_ref().is_ok_and(|traced| !traced.tracing.effects.is_empty());
        if has_effects {
            console::print("the base model, before effects\n")?;
        }
        console::print(&identified.tables())?;
        match &traced {
            Ok(traced) => console::print(&format!("\n{}", traced.text()))?,
            Err(why) => console::print(&format!("\n{why}\n"))?,
        }
        if !hits.is_empty() {
            let model = if has_effects { "the base model, before effects," } else { "the model" };
            console::print(&format!("\nmeasured hits, and {model} driven by their forces\n{}", misfit_table(hits)))?;
        }
    }
    Ok(())
}

/// Every name that a result of the test may have.
fn names(test: &ImpactTest) -> Vec<String> {
    let of_test = ["identified.json", "report.html", "trace.json", "time-histories.json"].map(String::from);
    let of_piece = |suffix: String| {
        let named = [
            format!("model{suffix}.json"),
            format!("panel{suffix}.fmu"),
            format!("panel{suffix}-fmi3.fmu"),
            format!("response{suffix}.csv"),
            format!("response{suffix}.svg"),
            format!("frequencies{suffix}.svg"),
            format!("coherence{suffix}.svg"),
        ];
        let pairs = test.measurements.len();
        let numbers = (0..pairs).map(|index| numbered(index, pairs)).chain([numbered(0, 1)]);
        let of_pairs = ["accelerance", "time-history", "cut"];
        let pictures: Vec<_> =
            numbers.flat_map(|number| of_pairs.map(|name| format!("{name}{suffix}{number}.svg"))).collect();
        named.into_iter().chain(pictures)
    };
    of_test.into_iter().chain(suffixes(test).flat_map(of_piece)).collect()
}

/// What there is of a test whose base model was refused; `files` is `None` where results of an earlier run are to stay.
fn trace_alone(
    arguments: &Arguments,
    files: Option<Outputs>,
    contradicted: Contradicted,
    provenance: &Origin,
) -> Result<(), CommandError> {
    let Arguments { test: path, options, json, .. } = arguments;
    let Contradicted { test, traced, .. } = &contradicted;
    let trace = Told { answer: &traced.tracing, provenance };
    let files = match files {
        Some(mut files) => {
            files.add_inside("trace.json", json::line(&trace));
            files.add_inside("report.html", contradicted.page(path, options)?);
            if traced.explains() {
                for (suffix, model) in suffixes(test).zip(&traced.applied_to(&traced.tracing.panels)) {
                    add_model(&mut files, path, &suffix, model)?;
                }
            }
            written(files)?
        }
        None => Vec::new(),
    };
    if *json {
        let trace = Some(trace);
        console::print_json(&RunAnswer {
            schema: "orthopanel.run/1",
            identified: None,
            trace,
            not_traced: None,
            hits: &[],
            files: &files,
        })?;
    } else {
        console::print(&traced.text())?;
    }
    contradicted.end()
}

fn written(files: Outputs) -> Result<Vec<PathBuf>, CommandError> {
    let files = files.write()?;
    files.iter().for_each(|path| console::say(format_args!("wrote {}", path.display())));
    Ok(files)
}

/// Model, FMUs and a simulated hit of one piece.
fn add_model(files: &mut Outputs, test: &Path, suffix: &str, model: &PanelModel) -> Result<(), CommandError> {
    files.add_inside(&format!("model{suffix}.json"), model.to_json());
    let ports = &model.ports;
    let seen = match time_response::seen(model, USUAL_MODES, ports) {
        // The trace may find what has no modes; the model file holds it all the same.
        Err(ModelError::Unsupported(what)) if !model.effects.is_empty() => {
            console::say(format_args!(
                "no FMU and no simulated hit: {what} is not supported by this version; model{suffix}.json holds it"
            ));
            return Ok(());
        }
        seen => seen.in_file(test)?,
    };
    let _shown = progress::spinner("making the FMUs");
    for (version, ending) in [(FmiVersion::Fmi2, ""), (FmiVersion::Fmi3, "-fmi3")] {
        let options = FmuOptions { name: fmu_name(model, suffix), version, ..FmuOptions::default() };
        let fmu = Fmu::of_panel(model, USUAL_MODES, ports.clone(), &options)?;
        files.add_inside(&format!("panel{suffix}{ending}.fmu"), fmu.to_bytes()?);
    }
    let hit = DrivingForce::new(ForceHistory::half_sine(ports.forces.len()), Hold::Linear, test)?;
    let motions = time_response::simulate(&seen.modes, &hit).in_file(test)?;
    let hit = hit.samples;
    files.add_inside(&format!("response{suffix}.csv"), time_response::csv(&hit, &motions));
    files.add_inside(&format!("response{suffix}.svg"), pictures::response(&hit, &motions)?);
    Ok(())
}

/// The model's own, or what the file is called, with `_` for what no name has: each piece's FMU has another.
fn fmu_name(model: &PanelModel, suffix: &str) -> String {
    let of_file = || format!("panel{suffix}").replace(|other: char| !other.is_ascii_alphanumeric(), "_");
    model.name.clone().unwrap_or_else(of_file)
}

fn add_pictures(files: &mut Outputs, suffix: &str, shown: &PieceEvidence) {
    for (name, picture) in [("frequencies", &shown.frequencies), ("coherence", &shown.coherence)] {
        if let Some(picture) = picture {
            files.add_inside(&format!("{name}{suffix}.svg"), picture.as_str());
        }
    }
    let of_pairs =
        [("accelerance", &shown.accelerances), ("time-history", &shown.time_histories), ("cut", &shown.cuts)];
    for (name, pictures) in of_pairs {
        for (index, picture) in pictures.iter().enumerate() {
            files.add_inside(&format!("{name}{suffix}{}.svg", numbered(index, pictures.len())), picture.as_str());
        }
    }
}

/// `-NUMBER` from 1 where there are several.
fn numbered(index: usize, of: usize) -> String {
    if of == 1 { String::new() } else { format!("-{}", index + 1) }
}
