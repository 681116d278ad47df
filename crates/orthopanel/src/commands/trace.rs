//! `trace`: the effect that the model lacks.

use std::path::PathBuf;

use orthopanel_data::ImpactTest;

use crate::error::CommandError;
use crate::identified::suffix;
use crate::traced::Traced;
use crate::{model_file, output};

/// Name the physical effect that the model of a test lacks
///
/// The base model, with every effect that the test file declares, is fitted to the data; then every
/// effect of the catalogue with it, alone and together, and each is judged by what was held out. The verdict is one of
/// nothing-missing, explained, ambiguous (with the effects that fit alike, and the measurement that would part them) and
/// unexplained.
///
/// -o writes the panel's model: effects of the panel stay in it, those of the rig and of the measuring chain are taken out.
/// Where the verdict is unexplained, it is the base model; where no base model meets the data either, none is written.
/// With several pieces in the test there is one model a piece: MODEL-NAME.json.
///
/// Example: orthopanel trace examples/misplaced-hit/test.toml -o traced.json
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml), or the folder that holds it
    test: PathBuf,
    /// Model file to write (orthopanel.model/1, JSON)
    #[arg(short, long, value_name = "MODEL.json")]
    output: Option<PathBuf>,
    /// Print one JSON object (orthopanel.trace/1) on standard output
    #[arg(long)]
    json: bool,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let path = &arguments.test;
    let test = ImpactTest::read(path)?;
    let traced = Traced::from_test(&test).map_err(|source| CommandError::Identify { path: path.clone(), source })?;
    // What was found is told even where no model can be written.
    if arguments.json {
        output::print_json(&traced.tracing);
    } else {
        output::print(&traced.text());
    }
    let Some(output) = &arguments.output else { return Ok(()) };
    let models = traced.models(&test).map_err(|source| CommandError::NoModel {
        path: output.clone(),
        test: path.clone(),
        source: Box::new(source),
    })?;
    let panels = test.pieces.iter().zip(&models);
    model_file::write_each(output, panels.map(|(named, panel)| (suffix(&named.name, test.pieces.len()), panel)))
}
