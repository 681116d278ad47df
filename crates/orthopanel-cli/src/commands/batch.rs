//! `batch`: a lot of panels as a table.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use orthopanel::lot::{self, Batch, LotRow};
use orthopanel::outputs::Inputs;
use orthopanel::{Observer as _, Steps};
use serde::Serialize;

use crate::console;
use crate::error::CommandError;
use crate::terminal::{self, Terminal};

/// Identify and trace a lot of panels: a table with one row a panel
///
/// PATH is a test file, or a folder: every test.toml in it and below is taken. A row has the panel's constants (of the model after tracing; shear moduli with
/// a shear coefficient of 2/3), their standard deviations and correlations, the error of each frequency foretold from the others, verdict and
/// effects of the trace, notes, and the SHA-256 of what it was made from. A panel that is refused is a row with the reason.
///
/// The table is written as it grows. Where LOT is there already, rows of tests whose files are as they were are kept, so that a batch that was
/// ended goes on where it was.
///
/// Examples: orthopanel batch measurements/2026-11 -o lot.parquet
///           orthopanel batch examples/piece-1 examples/made-hits -o lot.csv
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test files, or folders that hold some
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Table to write, .csv or .parquet
    #[arg(short, long, value_name = "LOT")]
    output: PathBuf,
    /// Print one JSON object (orthopanel.batch/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer<'a> {
    schema: &'static str,
    lot: &'a Path,
    panels: usize,
    failed: usize,
}

/// Between two tables while a batch goes on.
const EVERY: Duration = Duration::from_secs(5);

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { paths, output, json } = arguments;
    let tests = lot::tests_in(paths)?;
    let inputs = tests.iter().fold(Inputs::default(), |inputs, test| inputs.and(test));
    let mut outputs = terminal::outputs(inputs, words)?.planned(output)?;
    let batch = Batch::new(tests, lot::known(output)?);
    let written = Mutex::new(Instant::now());
    let rows = {
        let shown = Terminal.begin("identifying and tracing", Steps::Of(batch.len()));
        batch.run(|done, rows| {
            shown.at(done, batch.len(), "");
            let mut written = written.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            if written.elapsed() > EVERY && lot::save(output, &rows()).is_ok() {
                *written = Instant::now();
            }
        })
    };
    outputs.add(output, lot::content(output, &rows)?);
    outputs.write(&Terminal)?;
    let failed: Vec<&LotRow> = rows.iter().filter(|row| row.failed.is_some()).collect();
    for row in &failed {
        console::say(format_args!("{}: {}", row.panel, row.failed.as_deref().unwrap_or_default()));
    }
    console::say(format_args!("wrote {}: {} panels, {} without numbers", output.display(), rows.len(), failed.len()));
    if *json {
        console::print_json(&Answer {
            schema: "orthopanel.batch/1",
            lot: output,
            panels: rows.len(),
            failed: failed.len(),
        })?;
    }
    Ok(())
}
