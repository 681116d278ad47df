//! `lot`: what the table of a lot says, on one page.

use std::path::PathBuf;

use orthopanel::lot;
use orthopanel::outputs::Inputs;

use crate::console;
use crate::error::CommandError;
use crate::terminal::{self, Terminal};

/// Write what a lot of panels shows onto one HTML page
///
/// Mean of each constant and spread between panels, apart from how well each panel is known (random effects); control charts of individuals and
/// moving ranges; panels that stand out against both spreads; panels with a named effect; panels that failed. LOT is a table that `orthopanel batch` wrote, or the folder of a campaign of the Python package.
///
/// Example: orthopanel lot lot.parquet -o lot.html
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Table of the lot (.csv or .parquet), or a folder of such
    lot: PathBuf,
    /// Page to write
    #[arg(short, long, value_name = "PAGE.html")]
    output: PathBuf,
}

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { lot: path, output } = arguments;
    let mut outputs = terminal::outputs(Inputs::of(path), words)?.planned(output)?;
    let rows = lot::load(path)?;
    let title = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    outputs.add(output, lot::page(&title, &rows)?);
    outputs.write(&Terminal)?;
    console::say(format_args!("wrote {}", output.display()));
    Ok(())
}
