//! What an identification found, as tables for people.

use std::collections::BTreeSet;

use orthopanel_identify::{Correlation, Identification, IdentifiedConstant, NotIdentified, PieceFit};
use orthopanel_model::{Piece, Readable};

use super::answer::called;
use super::{Digits, Identified, ModeRows};
use crate::tables;
use crate::traced::effect_rows;

impl Identified {
    /// For people: measured against model, mode by mode, then the constants.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for fit in self.found.pieces.iter().filter(|fit| !fit.modes.is_empty() || !fit.hidden.is_empty()) {
            let Piece { length, width, thickness, mass_per_area } = fit.piece;
            text += &format!("piece {}: {length} x {width} x {thickness} m, {mass_per_area:.4} kg/m2\n", fit.name);
            text += &(mode_table(fit) + "\n");
        }
        let row = |constant: &IdentifiedConstant| {
            let std = match constant.std {
                Some(std) => format!("{std:.1e}"),
                None if constant.held => "held".into(),
                None => "unknown".into(),
            };
            let name = match &constant.piece {
                Some(piece) => format!("{} of {piece}", constant.name),
                None => constant.name.into(),
            };
            vec![name, format!("{:.3e}", constant.value), std, tables::shown_unit(constant.unit).into()]
        };
        let rows: Vec<_> = self.found.constants.iter().map(row).collect();
        text += &tables::aligned(&["constant", "value", "std", "unit"], &rows);
        if !self.found.effects.is_empty() {
            let headings = ["declared effect", "owner", "parameter", "value", "std", "unit"];
            text += &tables::aligned(&headings, &effect_rows(&self.found.effects));
        }
        for unseen in &self.found.not_identified {
            let NotIdentified { name, unit, held_at, interval: [low, high], .. } = unseen;
            let held_at = tables::with_unit(&format!("{held_at:.3e}"), unit);
            text += &format!(
                "{name} is not identified, held at {held_at}: the data leave it open from {low:.2e} to {high:.2e}, along {}\n",
                unseen.direction_text()
            );
        }
        let (shown, others) = shown_correlations(&self.found);
        for pair in shown {
            let [first, second] = [(pair.first, pair.first_piece), (pair.second, pair.second_piece)]
                .map(|(name, piece)| called(&self.found, name, piece));
            text += &format!("correlation of {first} and {second}: {:+.3}\n", pair.value);
        }
        if let Some(others) = others {
            text += &(others + "\n");
        }
        text += &format!("error of the frequencies: {:.3} % rms", Readable(self.found.frequency_rms_percent));
        if let Some(error) = self.found.left_one_out_percent {
            text += &format!("; of each predicted from the others: {:.3} % rms", Readable(error));
        }
        text += "\n";
        if let Some(error) = self.found.accelerance_rms_percent {
            text += &format!("error of the accelerances: {:.2} % rms", Readable(error));
            if let Some(chi_square) = self.found.chi_square {
                text += &format!("; chi-square per datum {:.2} (1: all that is left is noise)", Readable(chi_square));
            }
            text += "\n";
        }
        for table in &self.answer.measured_modes {
            text += &format!("\n{}", table.text());
        }
        text
    }
}

/// The correlations to be shown, and a sentence on those that are not: of several pieces with constants of their own each piece's
/// that lead, since a pair of constants for each pair of pieces fills pages.
pub fn shown_correlations(found: &Identification) -> (Vec<&Correlation>, Option<String>) {
    let all = &found.correlations;
    let piece_of = |pair: &Correlation| pair.first_piece.or(pair.second_piece);
    if all.iter().filter_map(piece_of).collect::<BTreeSet<_>>().len() < 2 {
        return (all.iter().collect(), None);
    }
    let is_of_one = |pair: &&Correlation| pair.first_piece.is_none_or(|_| pair.second_piece == pair.first_piece);
    let shown: Vec<_> = all.iter().filter(is_of_one).filter(|pair| pair.value.abs() > NOTABLE).collect();
    let others = all.len() - shown.len();
    let told = format!("correlations between pieces, or of {NOTABLE} and less: {others} (all of them: --json)");
    (shown, (others > 0).then_some(told))
}

/// Above it two constants move as one.
const NOTABLE: f64 = 0.9;

/// A row a mode; with the damping where the test measures it.
fn mode_table(fit: &PieceFit) -> String {
    let rows = ModeRows::of(fit, &Digits { frequency: 1, error: 2 });
    let (headings, rows) =
        rows.shown(["mode", "", "measured [Hz]", "std [Hz]", "model [Hz]", "error [%]", "zeta", "std of zeta"]);
    tables::aligned(&headings, &rows)
}

#[cfg(test)]
mod tests {
    use crate::Test;

    #[test]
    fn of_pieces_with_constants_of_their_own_pairs_are_counted() {
        let example = "../../examples/pieces-1-2/test.toml";
        let shared = std::fs::read_to_string(example).unwrap();
        let lines = |text: &str| {
            let found = Test::from_toml(text, example).unwrap().identify().unwrap();
            let text = found.text();
            let lines: Vec<String> =
                text.lines().filter(|line| line.starts_with("correlation")).map(str::to_owned).collect();
            (found.found.correlations.len(), lines)
        };
        let (count, told) = lines(&shared);
        assert!(count == 1 && told.len() == 1 && told[0].starts_with("correlation of e_x and g_zx: "), "{told:?}");
        let own = shared.replace("[[piece]]", "[[piece]]\nown_constants = [\"e_x\", \"g_zx\"]");
        let (count, told) = lines(&own);
        assert_eq!(
            (count, told),
            (6, vec!["correlations between pieces, or of 0.9 and less: 6 (all of them: --json)".to_owned()])
        );
    }
}
