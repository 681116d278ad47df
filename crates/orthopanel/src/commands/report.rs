//! `report`: one HTML page of a test.

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::contradicted::Contradicted;
use crate::error::CommandError;
use crate::evidence::Evidence;
use crate::identified::Identified;
use crate::outputs::{Inputs, Outputs};
use crate::record_options::IdentifyOptions;
use crate::reference_option::ReferenceOption;
use crate::traced::Traced;
use crate::{console, report};

/// Write what a test shows onto one HTML page, which needs no network and nothing beside it
///
/// Constants with their intervals, the effect that the model lacks with its rivals, every record and what became of its hits, coherence, the fit, and what the model
/// leaves against frequency, place and level of the hit. `run` writes the same page into its folder.
///
/// Records that no beam could give have their page too: what was measured, and what the trace tells of it. Where that explains
/// nothing, the exit status is 1. With --reference, the trace is against a sound panel of the same make (see `orthopanel trace --help`).
///
/// Example: orthopanel report examples/made-hits/test.toml -o report.html
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml), or the folder that holds it
    test: PathBuf,
    /// Page to write; its folder is made where it is not there
    #[arg(short, long, value_name = "X.html")]
    output: PathBuf,
    #[command(flatten)]
    options: IdentifyOptions,
    #[command(flatten)]
    reference: ReferenceOption,
    /// Print one JSON object (orthopanel.report/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer<'a> {
    schema: &'static str,
    page: &'a Path,
    /// What the trace says; `null` where the test cannot be traced.
    verdict: Option<&'static str>,
    /// Why it cannot.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_traced: Option<&'a str>,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let Arguments { test: path, output, options, reference, json } = arguments;
    let (inputs, test) = Inputs::reading_test(path)?;
    let (inputs, reference) = reference.read(inputs)?;
    let outputs = Outputs::of(inputs)?;
    let outputs = match output.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => outputs.making(folder),
        None => outputs,
    };
    let mut outputs = outputs.planned(output)?;
    let identified = match Identified::from_test(&test, path, options) {
        Err(refused) => {
            let contradicted = Contradicted::of(test, reference.as_ref(), path, refused)?;
            return trace_alone(arguments, outputs, contradicted);
        }
        Ok(identified) => identified,
    };
    let traced = Traced::where_possible(&test, reference.as_ref(), path);
    let evidence = Evidence::of(&identified, traced.as_ref().ok(), options.settings()?.estimation, path)?;
    outputs.add(output, report::page(path, &identified, &traced, &evidence)?);
    outputs.write()?;
    say(output, *json, traced.as_ref().map_err(String::as_str))
}

/// The page of a test whose base model was refused: it shows what was measured and what the trace tells.
fn trace_alone(arguments: &Arguments, mut outputs: Outputs, contradicted: Contradicted) -> Result<(), CommandError> {
    let Arguments { test, output, options, json, .. } = arguments;
    outputs.add(output, contradicted.page(test, options)?);
    outputs.write()?;
    say(output, *json, Ok(&contradicted.traced))?;
    contradicted.end()
}

/// Says what was written.
fn say(page: &Path, json: bool, traced: Result<&Traced, &str>) -> Result<(), CommandError> {
    console::say(format_args!("wrote {}", page.display()));
    if json {
        console::print_json(&Answer {
            schema: "orthopanel.report/1",
            page,
            verdict: traced.ok().map(|traced| traced.tracing.verdict.name()),
            not_traced: traced.err(),
        })?;
    }
    Ok(())
}
