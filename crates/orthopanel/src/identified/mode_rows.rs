//! Measured against model, mode by mode: the cells of a row, for terminal and report alike.

use orthopanel_identify::{HiddenMode, ModeFit, PieceFit};
use orthopanel_model::{Estimate, Readable};

/// Digits behind the point.
pub struct Digits {
    pub frequency: usize,
    pub error: usize,
}

/// What stands where a resonance would tell a number.
const NO_RESONANCE: &str = "-";

/// Rows of the modes that a test shows or hides, rising, and which of the columns there are: mode, nodal lines, measured,
/// its deviation, model, error, damping, its deviation.
pub struct ModeRows {
    pub rows: Vec<Vec<String>>,
    pub with_frequency_std: bool,
    pub with_damping: bool,
}

impl ModeRows {
    pub fn of(fit: &PieceFit, digits: &Digits) -> Self {
        let mut numbered: Vec<(usize, Vec<String>)> =
            fit.modes.iter().map(|mode| (mode.mode, seen(mode, digits))).collect();
        numbered.extend(fit.hidden.iter().map(|mode| (mode.mode, hidden(mode, digits))));
        numbered.sort_by_key(|(mode, _)| *mode);
        Self {
            rows: numbered.into_iter().map(|(_, row)| row).collect(),
            with_frequency_std: fit.modes.iter().any(|mode| mode.measured_std.is_some()),
            with_damping: fit.measured_damping().next().is_some(),
        }
    }

    /// The rows and headings without the columns that hold nothing; `headings` are of all columns.
    pub fn shown(self, headings: [&str; 8]) -> (Vec<&str>, Vec<Vec<String>>) {
        let is_shown = |column: usize| match column {
            1 => !headings[1].is_empty(),
            3 => self.with_frequency_std,
            6 | 7 => self.with_damping,
            _ => true,
        };
        let columns: Vec<usize> = (0..headings.len()).filter(|&column| is_shown(column)).collect();
        let row = |row: &Vec<String>| columns.iter().filter_map(|&column| row.get(column).cloned()).collect();
        (columns.iter().map(|&column| headings[column]).collect(), self.rows.iter().map(row).collect())
    }
}

fn seen(mode: &ModeFit, digits: &Digits) -> Vec<String> {
    let [zeta, std] = damping(mode.damping, "not seen");
    vec![
        mode.mode.to_string(),
        nodes(mode.nodes),
        format!("{:.*}", digits.frequency, Readable(mode.measured)),
        mode.measured_std.map_or("unknown".into(), |std| format!("{std:.1e}")),
        format!("{:.*}", digits.frequency, Readable(mode.model)),
        format!("{:+.*}", digits.error, Readable(mode.error_percent())),
        zeta,
        std,
    ]
}

fn hidden(mode: &HiddenMode, digits: &Digits) -> Vec<String> {
    let [zeta, std] = damping(mode.damping, "not told");
    let none = || NO_RESONANCE.to_owned();
    let model = format!("{:.*}", digits.frequency, Readable(mode.model));
    vec![mode.mode.to_string(), nodes(mode.nodes), none(), none(), model, none(), zeta, std]
}

fn nodes([along_x, along_y]: [usize; 2]) -> String {
    format!("{along_x}, {along_y}")
}

fn damping(ratio: Option<Estimate>, untold: &str) -> [String; 2] {
    let std = ratio.and_then(|ratio| ratio.std);
    [
        ratio.map_or(untold.into(), |ratio| format!("{:.3e}", ratio.value)),
        std.map_or("unknown".into(), |std| format!("{std:.1e}")),
    ]
}
