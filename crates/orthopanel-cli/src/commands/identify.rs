//! `identify`: elastic constants from a test.

use std::path::PathBuf;

use orthopanel::Provenance;
use orthopanel::outputs::Inputs;

use crate::error::CommandError;
use crate::record_options::IdentifyOptions;
use crate::terminal::{self, Terminal};
use crate::{console, model_files};

/// Identify the elastic constants, and the damping where there are records, from a test
///
/// From natural frequencies: e_x and g_zx such that the model's meet the measured ones in the least squares of their
/// relative errors, with standard deviations, correlation, and the error of each frequency predicted from all others.
///
/// From hammer records or accelerances: e_x, g_zx and the damping ratio of every mode in the band, such that the model
/// meets every line of every place, weighted by the records' own scatter. No peak is picked by hand. What was found
/// wanting in the records (a double hit, an overload, a response that has not decayed) is said on standard error.
/// Modes beyond the band get the median of the measured ratios. Where a response still rings at the record's end, both
/// channels get an exponential window, whose damping is known and taken out.
///
/// Below stand the modes that the records show by themselves, by a joint fit of all of them before any model, each beside the
/// mode of the model that it is, with the modal assurance criterion of the two over the records.
///
/// With several pieces in the test, -o writes one model a piece, MODEL-NAME.json, and MODEL-manifest.json, which lists them: a
/// model that it lists is removed by the next run that does not write it anew, unless it was changed since.
///
/// Examples: orthopanel identify examples/piece-1/test.toml -o model.json
///           orthopanel identify examples/made-hits/test.toml -o model.json
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml), or the folder that holds it
    test: PathBuf,
    /// Model file to write (orthopanel.model/1, JSON)
    #[arg(short, long, value_name = "MODEL.json")]
    output: Option<PathBuf>,
    #[command(flatten)]
    options: IdentifyOptions,
    /// Print one JSON object (orthopanel.identified/1) on standard output
    #[arg(long)]
    json: bool,
}

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { test: path, output, options, json } = arguments;
    let (inputs, test) = Inputs::reading_test(path)?;
    let outputs = model_files::planned(terminal::outputs(inputs, words)?, output.as_deref(), &test)?;
    let outputs = if *json { outputs.hashing() } else { outputs };
    let settings = options.settings()?;
    options.say_if_idle(&test);
    let identified = test.identify_with(settings, &Terminal)?;
    let provenance = json.then(|| Provenance::of(&test, outputs.inputs())).transpose()?;
    if let Some(output) = output {
        model_files::write(outputs, output, &identified.named_models())?;
    }
    console::print(&match &provenance {
        Some(provenance) => identified.to_json_with(provenance),
        None => identified.text(),
    })
}
