//! `report`: one HTML page of a test.

use std::path::{Path, PathBuf};

use orthopanel::Analysis;
use orthopanel::outputs::Inputs;
use serde::Serialize;

use crate::console;
use crate::error::CommandError;
use crate::record_options::IdentifyOptions;
use crate::reference_option::ReferenceOption;
use crate::terminal::{self, Terminal};

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

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { test: path, output, options, reference, json } = arguments;
    let (inputs, test) = Inputs::reading_test(path)?;
    let (inputs, reference) = reference.read(inputs)?;
    let outputs = terminal::outputs(inputs, words)?;
    let outputs = match output.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => outputs.making(folder),
        None => outputs,
    };
    let mut outputs = outputs.planned(output)?;
    let settings = options.settings()?;
    options.say_if_idle(&test);
    let analysis = Analysis::of(&test, reference.as_ref(), settings, &Terminal)?;
    outputs.add(output, analysis.page(&Terminal)?);
    outputs.write(&Terminal)?;
    console::say(format_args!("wrote {}", output.display()));
    if *json {
        let traced = analysis.traced();
        console::print_json(&Answer {
            schema: "orthopanel.report/1",
            page: output,
            verdict: traced.ok().map(|traced| traced.tracing().verdict.name()),
            not_traced: traced.err(),
        })?;
    }
    Ok(analysis.end()?)
}
