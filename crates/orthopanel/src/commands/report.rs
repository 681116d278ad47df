//! `report`: one HTML page of a test.

use std::path::PathBuf;

use crate::error::CommandError;
use crate::evidence::Evidence;
use crate::identified::Identified;
use crate::record_options::IdentifyOptions;
use crate::traced::Traced;
use crate::{output, report};

/// Write what a test shows onto one HTML page, which needs no network and nothing beside it
///
/// Constants with their intervals, the effect that the model lacks with its rivals, every record and what became of its hits, coherence, the fit, and what the model
/// leaves against frequency, place and level of the hit. `run` writes the same page into its folder.
///
/// Example: orthopanel report examples/made-hits/test.toml -o report.html
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml)
    test: PathBuf,
    /// Page to write
    #[arg(short, long, value_name = "X.html")]
    output: PathBuf,
    #[command(flatten)]
    options: IdentifyOptions,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let Arguments { test, output, options } = arguments;
    let identified = Identified::from_test(test, options)?;
    let evidence = Evidence::of(&identified, options.settings()?.estimation, test)?;
    let traced = Traced::where_possible(&identified.test, test);
    output::write(output, report::page(test, &identified, &traced, &evidence)?)?;
    eprintln!("wrote {}", output.display());
    Ok(())
}
