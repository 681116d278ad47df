//! `accelerance`: acceleration per force against frequency.

use std::path::PathBuf;

use orthopanel_model::{ModeRange, Place};
use serde::Serialize;

use crate::arguments::{DENSE_MODES, frequency, on_piece, place};
use crate::error::{CommandError, InFile as _};
use crate::{model_file, output};

/// Calculate the accelerance between two places of a model
///
/// The convention is e^(+j omega t); lines are evenly spaced, both ends included. Without -o the CSV
/// (frequency_hz,real,imag; (m/s2)/N) goes to standard output. The sum runs over the rigid modes and
/// --modes flexible ones: those far above the band still move the valleys between the peaks.
///
/// Example: orthopanel accelerance out/model.json --force -0.3 --response 0.3 --from 0 --to 4500 --lines 1801 -o h.csv
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Model file (orthopanel.model/1, JSON)
    model: PathBuf,
    /// Where force goes in, in m from the centre
    #[arg(long, value_name = "X[,Y]", value_parser = place, allow_hyphen_values = true)]
    force: Place,
    /// Where acceleration comes out, in m from the centre
    #[arg(long, value_name = "X[,Y]", value_parser = place, allow_hyphen_values = true)]
    response: Place,
    /// First frequency
    #[arg(long, value_name = "HZ", value_parser = frequency, allow_hyphen_values = true)]
    from: f64,
    /// Last frequency
    #[arg(long, value_name = "HZ", value_parser = frequency, allow_hyphen_values = true)]
    to: f64,
    /// Number of lines
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    lines: u32,
    /// Number of flexible modes in the sum [default: 1000]
    #[arg(long, value_name = "N")]
    modes: Option<usize>,
    /// CSV file to write
    #[arg(short, long, value_name = "X.csv")]
    output: Option<PathBuf>,
    /// Print one JSON object (orthopanel.accelerance/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer {
    schema: &'static str,
    force: Place,
    response: Place,
    frequency_hz: Vec<f64>,
    real: Vec<f64>,
    imag: Vec<f64>,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let &Arguments { force, response, from, to, lines, .. } = arguments;
    if to < from || (to == from) != (lines == 1) {
        let remedy = format!("must lie above --from {from}, or be the same for a single line");
        return Err(CommandError::Option { option: "to", value: to.to_string(), remedy });
    }
    let model = model_file::read(&arguments.model)?;
    on_piece(&model, "force", &[force])?;
    on_piece(&model, "response", &[response])?;
    let range = arguments.modes.map_or(DENSE_MODES, ModeRange::Count);
    let seen = model.modal_model(range, &[force], &[response]).in_file(&arguments.model)?;
    let step = if lines > 1 { (to - from) / f64::from(lines - 1) } else { 0.0 };
    let frequency_hz: Vec<f64> = (0..lines).map(|line| from + f64::from(line) * step).collect();
    let (real, imag) = frequency_hz
        .iter()
        .map(|&frequency| seen.accelerance(0, 0, frequency))
        .map(|value| (value.re, value.im))
        .unzip();
    let answer = Answer { schema: "orthopanel.accelerance/1", force, response, frequency_hz, real, imag };
    let names = ["frequency_hz", "real", "imag"].map(String::from);
    let table = || output::csv(&names, &[&answer.frequency_hz, &answer.real, &answer.imag]);
    if let Some(path) = &arguments.output {
        output::write(path, table())?;
        eprintln!("wrote {} ({lines} lines)", path.display());
    }
    if arguments.json {
        output::print_json(&answer);
    } else if arguments.output.is_none() {
        output::print(&table());
    }
    Ok(())
}
