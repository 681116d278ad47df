//! `modes`: natural frequencies of a model.

use std::path::PathBuf;

use orthopanel::outputs::Inputs;
use orthopanel::pictures::{self, ModeShape};
use orthopanel::{Model, tables};
use orthopanel_model::{ModeKind, ModeRange, PanelMode, Readable, StructureKind, VISCOELASTIC_CORE};
use serde::Serialize;

use crate::arguments::count;
use crate::error::CommandError;
use crate::terminal::{self, Terminal};
use crate::{console, progress};

/// List the natural frequencies of a model, flexible modes from 1
///
/// A plate's modes are told by their nodal lines across x and across y, and by their kind: bending (none across the
/// width), torsion (one), transverse (two and more), or mixed where two such shapes share a mode. With a viscoelastic core each
/// mode stands at the core's storage modulus at its own frequency, and zeta holds the core's loss.
///
/// How the edges are held stands in the model file: "boundary": {"left": "clamped", "right": "free"}, each "free" (where it is
/// left out), "pinned" or "clamped"; left and right are the ends x = -length/2 and +length/2, and a plate has "front" and
/// "back" too, the edges y = -width/2 and +width/2.
///
/// Examples: orthopanel modes out/model.json --count 6
///           orthopanel modes out/model.json --picture out/modes.svg
///           orthopanel modes examples/clamped-plate.json
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Model file (orthopanel.model/1, JSON)
    model: PathBuf,
    /// Number of flexible modes
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true, default_value_t = 10)]
    count: usize,
    /// Picture of the mode shapes to write: lines for a beam, contours for a plate
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
    /// How a viscoelastic core enters, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    core: Option<&'static str>,
}

#[derive(Serialize)]
struct ModeEntry {
    mode: usize,
    frequency_hz: f64,
    /// Nodal lines crossed along x and along y; a beam has none along y.
    nodes: [usize; 2],
    /// Of a plate's mode.
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<ModeKind>,
    zeta: f64,
}

const CORE: &str = "each mode at the storage modulus at its own frequency; zeta holds the core's loss there";

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let mut outputs = terminal::outputs(Inputs::of(&arguments.model), words)?.all_planned(arguments.picture.clone())?;
    let model = Model::load(&arguments.model)?;
    let modes = {
        let _shown = progress::spinner("finding the modes");
        model.modes(ModeRange::Count(arguments.count))?
    };
    let model = model.panel();
    let flexible: Vec<&PanelMode> = modes.iter().filter(|mode| !mode.is_rigid()).collect();
    let entry = |(mode, of): (usize, &&PanelMode)| ModeEntry {
        mode,
        frequency_hz: of.frequency(),
        nodes: of.nodes(),
        kind: of.name().map(|name| name.kind),
        zeta: of.own_damping_ratio().unwrap_or_else(|| model.damping.ratio(mode)),
    };
    let core = model.effects.iter().any(|effect| effect.id == VISCOELASTIC_CORE).then_some(CORE);
    let answer = Answer { schema: "orthopanel.modes/1", modes: (1..).zip(&flexible).map(entry).collect(), core };
    if let Some(path) = arguments.picture.as_ref().filter(|_| flexible.is_empty()) {
        console::say(format_args!("{} not written: no mode was asked for", path.display()));
    }
    if let Some(path) = arguments.picture.as_ref().filter(|_| !flexible.is_empty()) {
        let shape = |(mode, entry)| shape(mode, entry);
        let shapes: Vec<ModeShape> = flexible.iter().copied().zip(&answer.modes).map(shape).collect();
        let draw =
            if model.structure.has_modes_across() { pictures::plate_mode_shapes } else { pictures::beam_mode_shapes };
        let picture = draw(&model.piece, &shapes)?;
        outputs.add(path, picture);
        outputs.write(&Terminal)?;
        console::say(format_args!("wrote {}", path.display()));
    }
    if arguments.json {
        console::print_json(&answer)?;
    } else {
        console::print(&table(&answer.modes, model.structure))?;
    }
    if let Some(core) = core {
        console::say(format_args!("viscoelastic core: {core}"));
    }
    Ok(())
}

fn table(modes: &[ModeEntry], structure: StructureKind) -> String {
    let row = |entry: &ModeEntry| {
        let mut row =
            vec![entry.mode.to_string(), format!("{:.2}", Readable(entry.frequency_hz)), entry.nodes[0].to_string()];
        if structure.has_modes_across() {
            row.push(entry.nodes[1].to_string());
            row.push(entry.kind.map_or("", ModeKind::name).into());
        }
        row.push(format!("{:.3e}", entry.zeta));
        row
    };
    let heading: &[&str] = if structure.has_modes_across() {
        &["mode", "frequency [Hz]", "nodes along x", "along y", "kind", "zeta"]
    } else {
        &["mode", "frequency [Hz]", "nodes along x", "zeta"]
    };
    tables::aligned(heading, &modes.iter().map(row).collect::<Vec<_>>())
}

fn shape<'a>(mode: &'a PanelMode, entry: &ModeEntry) -> ModeShape<'a> {
    let ModeEntry { mode: number, frequency_hz, nodes: [along_x, along_y], kind, .. } = entry;
    let looks = match kind {
        None => format!("{along_x} node{}", if *along_x == 1 { "" } else { "s" }),
        Some(kind) => format!("{} ({along_x}, {along_y})", kind.name()),
    };
    ModeShape {
        name: format!("mode {number}: {frequency_hz:.1} Hz, {looks}"),
        deflection: Box::new(|place| mode.deflection(place)),
    }
}
