//! `run`: the whole way from a test to models, FMUs, a response and pictures.

use std::path::PathBuf;

use orthopanel::outputs::Inputs;
use orthopanel::{PlannedRun, holds_results};

use crate::console;
use crate::error::{CommandError, SAYS_NO};
use crate::record_options::IdentifyOptions;
use crate::reference_option::ReferenceOption;
use crate::terminal::{self, Terminal};

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

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let holds_earlier = holds_results(&arguments.output);
    let done = make(arguments, words);
    if holds_earlier && done.as_ref().is_err_and(|refused| refused.exit_code() == SAYS_NO) {
        let folder = arguments.output.display();
        console::say(format_args!("note: {folder}: the results in it are of an earlier run, and stay as they are"));
    }
    done
}

fn make(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { test: path, output, options, reference, json } = arguments;
    let (inputs, test) = Inputs::reading_test(path)?;
    let (inputs, reference) = reference.read(inputs)?;
    let planned = PlannedRun::new(&test, terminal::outputs(inputs, words)?, output)?;
    let settings = options.settings()?;
    options.say_if_idle(&test);
    let run = planned.run(reference.as_ref(), settings, &Terminal)?;
    run.files().iter().for_each(|path| console::say(format_args!("wrote {}", path.display())));
    console::print(&if *json { run.to_json() } else { run.text() })?;
    Ok(run.end()?)
}
