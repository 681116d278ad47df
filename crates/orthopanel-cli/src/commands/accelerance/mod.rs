//! `accelerance`: acceleration per force against frequency, calculated from a model or measured in a test.

mod of_model;
mod of_test;

use std::path::PathBuf;

use orthopanel::measured_pairs::is_test_file;

use crate::error::CommandError;
use crate::record_options::EstimationOptions;

/// Calculate the accelerance of a model, or estimate those of a test from its records
///
/// The convention is e^(+j omega t), the unit (m/s2)/N.
///
/// Of a model: between two places, on evenly spaced lines, both ends included. Without -o the CSV
/// (frequency_hz,real,imag) goes to standard output. The sum runs over the rigid modes and --modes flexible ones; all
/// that lie beyond, which still move the valleys between the peaks, enter by their static flexibility.
///
/// Of a test (a file that ends in .toml): one CSV a pair of places, with the coherence and the variance of each line
/// where the hits tell them. With several pairs -o X.csv writes X-1.csv, X-2.csv, ... in the order of the table; -o of
/// any other name is a folder for accelerance-1.csv, accelerance-2.csv, ... X-manifest.json, in the folder accelerance-manifest.json, lists them: a file that it
/// lists is removed by the next run that does not write it anew, unless it was changed since.
/// The table says which hits were kept and which left out, and why.
///
/// Examples: orthopanel accelerance out/model.json --force -0.3 --response 0.3 --from 0 --to 4500 --lines 1801 -o h.csv
///           orthopanel accelerance examples/made-hits/test.toml -o measured.csv
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Model file (orthopanel.model/1, JSON) or test file with records
    #[arg(value_name = "MODEL|TEST.toml")]
    source: PathBuf,
    #[command(flatten)]
    grid: of_model::Grid,
    #[command(flatten)]
    estimation: EstimationOptions,
    /// CSV file to write; with several pairs of places X-1.csv, X-2.csv, ..., or a folder for them
    #[arg(short, long, value_name = "X.csv|DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object (orthopanel.accelerance/1; of a test orthopanel.accelerances/1) on standard output
    #[arg(long)]
    json: bool,
}

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { source, grid, estimation, output, json } = arguments;
    let path = || source.clone();
    match (is_test_file(source), grid.given(), estimation.given()) {
        (true, Some(option), _) => Err(CommandError::GridOfRecords { path: path(), option }),
        (true, None, _) => of_test::execute(source, estimation, output.as_deref(), *json, words),
        (false, _, Some(option)) => Err(CommandError::EstimationOfModel { path: path(), option }),
        (false, _, None) => of_model::execute(source, grid, output.as_deref(), *json, words),
    }
}
