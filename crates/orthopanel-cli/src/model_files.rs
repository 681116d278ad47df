//! Model files of a test: one a piece.

use std::path::Path;

use orthopanel::outputs::{Outputs, with_suffix};
use orthopanel::{Error, Model, Test};

use crate::console;
use crate::error::CommandError;
use crate::terminal::Terminal;

/// Plans one model a piece of the test, as [`write()`] names them.
pub fn planned(outputs: Outputs, path: Option<&Path>, test: &Test) -> Result<Outputs, Error> {
    let Some(path) = path else { return Ok(outputs) };
    let named = test.suffixes().map(|suffix| with_suffix(path, &suffix));
    outputs.beside(path, test.content().pieces.len() > 1)?.all_planned(named)
}

/// Writes one model a piece, each as its suffix names it, and says so on standard error.
pub fn write(mut outputs: Outputs, path: &Path, models: &[(String, Model)]) -> Result<(), CommandError> {
    for (suffix, model) in models {
        outputs.add(with_suffix(path, suffix), model.to_json());
    }
    for path in outputs.write(&Terminal)? {
        console::say(format_args!("wrote {}", path.display()));
    }
    Ok(())
}
