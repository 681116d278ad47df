//! `modes`: natural frequencies of a model.

use std::path::PathBuf;

use orthopanel_model::{BeamMode, ModeRange};
use serde::Serialize;

use crate::arguments::count;
use crate::error::{CommandError, InFile as _};
use crate::pictures::{self, ModeShape};
use crate::{model_file, output, tables};

/// List the natural frequencies of a model, flexible modes from 1
///
/// Examples: orthopanel modes out/model.json --count 6
///           orthopanel modes out/model.json --picture out/modes.svg
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Model file (orthopanel.model/1, JSON)
    model: PathBuf,
    /// Number of flexible modes
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true, default_value_t = 10)]
    count: usize,
    /// Picture of the mode shapes to write
    #[arg(long, value_name = "X.svg")]
    picture: Option<PathBuf>,
    /// Print one JSON object (orthopanel.modes/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer {
    schema: &'static str,
    modes: Vec<ModeEntry>,
}

#[derive(Serialize)]
struct ModeEntry {
    mode: usize,
    frequency_hz: f64,
    /// Nodal lines crossed along x and along y; a beam has none along y.
    nodes: [usize; 2],
    zeta: f64,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let model = model_file::read(&arguments.model)?;
    let modes = model.beam_modes(ModeRange::Count(arguments.count)).in_file(&arguments.model)?;
    let entry = |(index, mode): (usize, &BeamMode)| ModeEntry {
        mode: index + 1,
        frequency_hz: mode.frequency(),
        nodes: [nodes_along_x(mode, model.piece.length, index + 1), 0],
        zeta: model.damping.ratio(index + 1),
    };
    let flexible = || modes.iter().skip(model.boundary.rigid_modes());
    let answer = Answer { schema: "orthopanel.modes/1", modes: flexible().enumerate().map(entry).collect() };
    if let Some(path) = &arguments.picture {
        let shape = |(mode, entry): (_, &ModeEntry)| shape(mode, entry);
        let shapes: Vec<ModeShape> = flexible().zip(&answer.modes).map(shape).collect();
        output::write(path, pictures::mode_shapes(&model.piece, &shapes)?)?;
        eprintln!("wrote {}", path.display());
    }
    if arguments.json {
        output::print_json(&answer);
    } else {
        let row = |entry: &ModeEntry| {
            vec![
                entry.mode.to_string(),
                format!("{:.2}", entry.frequency_hz),
                entry.nodes[0].to_string(),
                format!("{:.3e}", entry.zeta),
            ]
        };
        let rows: Vec<_> = answer.modes.iter().map(row).collect();
        output::print(&tables::aligned(&["mode", "frequency [Hz]", "nodes along x", "zeta"], &rows));
    }
    Ok(())
}

fn shape<'a>(mode: &'a BeamMode, entry: &ModeEntry) -> ModeShape<'a> {
    let ModeEntry { mode: number, frequency_hz, nodes: [nodes, _], .. } = entry;
    let name = format!("mode {number}: {frequency_hz:.1} Hz, {nodes} node{}", if *nodes == 1 { "" } else { "s" });
    ModeShape { name, deflection: Box::new(|x| mode.deflection(x)) }
}

/// Sign changes of the deflection between the ends.
fn nodes_along_x(mode: &BeamMode, length: f64, number: usize) -> usize {
    // Flexible mode m has at most m + 1 nodes; eight points between two of them part every pair.
    let points = 8 * (number + 2);
    let place = |index: usize| length * ((index as f64 + 0.5) / points as f64 - 0.5);
    let deflections: Vec<f64> = (0..points).map(|index| mode.deflection(place(index))).collect();
    deflections.windows(2).filter(|pair| matches!(pair, [left, right] if (*left < 0.0) != (*right < 0.0))).count()
}
