//! `trace`: the effect that the model lacks.

use std::path::PathBuf;

use orthopanel::Error;
use orthopanel::Provenance;
use orthopanel::outputs::Inputs;

use crate::error::CommandError;
use crate::reference_option::ReferenceOption;
use crate::terminal::{self, Terminal};
use crate::{console, model_files};

/// Name the physical effect that the model of a test lacks
///
/// The base model, with every effect that the test file declares, is held against the data; then every
/// effect of the catalogue with it, alone and together. Each is judged by what was held out. The verdict is one of
/// nothing-missing, explained, ambiguous (with the effects that fit alike, and the measurement that would part them) and
/// unexplained.
///
/// Records in another unit or quantity than they are read in, or of a sensor turned round, are refused first, with the line of the test
/// file that mends them; an exponential window over frequency responses that is not declared is asked about.
///
/// -o writes the panel's model: effects of the panel stay in it, those of the rig and of the measuring chain are taken out.
/// Where the verdict is unexplained, it is the base model; where no base model meets the data either, none is written.
/// With several pieces in the test there is one model a piece, MODEL-NAME.json, and MODEL-manifest.json lists them (see
/// `orthopanel identify --help`).
///
/// No real panel is the ideal model: of records the modes that they show are compared, and by how much a sound model of this panel misses
/// them is estimated with the rest.
///
/// With --reference, a sound panel of the same make is measured alike, and what both miss of the model is no news of the suspect: smaller
/// faults show. The line that begins with "Against the reference" tells how much of the model's error the two share.
///
/// Examples: orthopanel trace examples/misplaced-hit/test.toml -o traced.json
///           orthopanel trace suspect/test.toml --reference good/test.toml
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml), or the folder that holds it
    test: PathBuf,
    #[command(flatten)]
    reference: ReferenceOption,
    /// Model file to write (orthopanel.model/1, JSON)
    #[arg(short, long, value_name = "MODEL.json")]
    output: Option<PathBuf>,
    /// Print one JSON object (orthopanel.trace/2) on standard output
    #[arg(long)]
    json: bool,
}

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { test: path, reference, output, json } = arguments;
    let (inputs, test) = Inputs::reading_test(path)?;
    let (inputs, reference) = reference.read(inputs)?;
    let outputs = model_files::planned(terminal::outputs(inputs, words)?, output.as_deref(), &test)?;
    let outputs = if *json { outputs.hashing() } else { outputs };
    let traced = test.trace_with(reference.as_ref(), &Terminal)?;
    let provenance = json.then(|| Provenance::of(&test, outputs.inputs())).transpose()?;
    let written = match output {
        Some(output) => match traced.named_models(&test, &Terminal) {
            Ok(models) => model_files::write(outputs, output, &models),
            Err(Error::Identify { path: test, source }) => {
                Err(Error::NoModel { path: output.clone(), test, source: Box::new(source) }.into())
            }
            Err(refused) => Err(refused.into()),
        },
        None => Ok(()),
    };
    // What was found is told even where no model can be written.
    console::print(&match &provenance {
        Some(provenance) => traced.to_json_with(provenance),
        None => traced.text(),
    })?;
    written
}
