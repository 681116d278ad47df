//! The accelerance that a model has between two places.

use std::path::Path;

use orthopanel::outputs::Inputs;
use orthopanel::{Model, csv_text};
use orthopanel_model::{ModeRange, Place, Readable};
use serde::Serialize;

use crate::arguments::{count, frequency, on_piece, place};
use crate::error::CommandError;
use crate::terminal::{self, Terminal};
use crate::{console, progress};

/// The pair of places and the lines of a calculated accelerance.
#[derive(clap::Args)]
#[command(next_help_heading = "Of a model")]
pub struct Grid {
    /// Where force goes in, in m from the centre
    #[arg(long, value_name = "X[,Y]", value_parser = place, allow_hyphen_values = true)]
    force: Option<Place>,
    /// Where acceleration comes out, in m from the centre
    #[arg(long, value_name = "X[,Y]", value_parser = place, allow_hyphen_values = true)]
    response: Option<Place>,
    /// First frequency
    #[arg(long, value_name = "HZ", value_parser = frequency, allow_hyphen_values = true)]
    from: Option<f64>,
    /// Last frequency
    #[arg(long, value_name = "HZ", value_parser = frequency, allow_hyphen_values = true)]
    to: Option<f64>,
    /// Number of lines
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000), allow_negative_numbers = true)]
    lines: Option<u32>,
    /// Number of flexible modes in the sum [default: 300, or all up to 20 times --to where that is more; of a
    /// plate 300, or as many as its basis resolves]
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    modes: Option<usize>,
}

impl Grid {
    /// The first option that was given, for a refusal.
    pub fn given(&self) -> Option<&'static str> {
        let Self { force, response, from, to, lines, modes } = self;
        let given = [
            (force.is_some(), "force"),
            (response.is_some(), "response"),
            (from.is_some(), "from"),
            (to.is_some(), "to"),
            (lines.is_some(), "lines"),
            (modes.is_some(), "modes"),
        ];
        given.into_iter().find_map(|(given, name)| given.then_some(name))
    }
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

pub fn execute(
    path: &Path,
    grid: &Grid,
    output: Option<&Path>,
    json: bool,
    words: &[String],
) -> Result<(), CommandError> {
    let &Grid {
        force: Some(force),
        response: Some(response),
        from: Some(from),
        to: Some(to),
        lines: Some(lines),
        modes,
    } = grid
    else {
        return Err(CommandError::NoGrid { path: path.into() });
    };
    if to < from || (to == from) != (lines == 1) {
        let remedy = format!("must lie above --from {}, or be the same for a single line", Readable(from));
        return Err(CommandError::Option { option: "to", value: Readable(to).to_string(), remedy });
    }
    let mut outputs = terminal::outputs(Inputs::of(path), words)?.all_planned(output.map(Path::to_path_buf))?;
    let model = Model::load(path)?;
    on_piece(model.panel(), "force", &[force])?;
    on_piece(model.panel(), "response", &[response])?;
    let shown = progress::spinner("calculating the accelerance");
    let step = if lines > 1 { (to - from) / f64::from(lines - 1) } else { 0.0 };
    let frequency_hz: Vec<f64> = (0..lines).map(|line| from + f64::from(line) * step).collect();
    let modes = modes.map(ModeRange::Count);
    let lines_found = model.accelerance_of_modes(&frequency_hz, [force, response], modes)?;
    let (real, imag) = lines_found.iter().map(|value| (value.re, value.im)).unzip();
    drop(shown);
    let answer = Answer { schema: "orthopanel.accelerance/1", force, response, frequency_hz, real, imag };
    let names = ["frequency_hz", "real", "imag"].map(String::from);
    let table = || csv_text::csv(&names, &[&answer.frequency_hz, &answer.real, &answer.imag]);
    if let Some(path) = output {
        outputs.add(path, table());
        outputs.write(&Terminal)?;
        console::say(format_args!("wrote {} ({lines} lines)", path.display()));
    }
    if json {
        console::print_json(&answer)?;
    } else if output.is_none() {
        console::print(&table())?;
    }
    Ok(())
}
