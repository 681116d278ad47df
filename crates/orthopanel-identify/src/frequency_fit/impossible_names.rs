//! Names that no panel's mode has beside the other lines of a list: refused before a basis is built for them.

use orthopanel_data::ImpactTest;
use orthopanel_model::Constant;

use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::starting_constants::{SOFTNESS, guess};
use crate::structures::SearchedStructure;

/// A mode above all lines by this factor, where one product of beam functions tells it within a quarter, was not measured: it is a
/// factor of sixteen in the moduli. One that lies among the lines may be another line's, and names changed are told later.
const FAR_ABOVE: f64 = 4.0;
/// $E_y/E_x$ tried, each way: from fabric to wood.
const RATIOS: [f64; 3] = [1.0, 1.0 / 30.0, 30.0];
/// A panel counts whose frequencies lie about the other lines by so much more than the best one's, in logarithms.
const LIKELY: f64 = 0.15;

/// One measured mode of a test.
pub(super) struct NamedLine {
    /// Index of its piece.
    pub piece: usize,
    /// Natural frequency \[Hz\].
    pub measured: f64,
    /// Nodal lines across x and across y.
    pub nodes: [usize; 2],
}

/// Refuses a line whose mode lies far above all that were measured, on every panel that is likely by the other lines.
pub(super) fn refuse_impossible_names(
    test: &ImpactTest,
    structure: &dyn SearchedStructure,
    constants: &FreeConstants,
    lines: &[NamedLine],
) -> Result<(), IdentifyError> {
    if lines.len() < 2 {
        return Ok(());
    }
    let panels: Vec<Vec<f64>> =
        panels(constants).iter().filter_map(|panel| ratios(test, structure, panel, lines)).collect();
    let highest = lines.iter().map(|line| line.measured).fold(0.0, f64::max);
    for (index, line) in lines.iter().enumerate() {
        // Of each panel of the size that the other lines want: how far they scatter, and how far this line lies below.
        let judged: Vec<(f64, f64)> = panels.iter().map(|ratios| others_and_line(ratios, index)).collect();
        let best = judged.iter().map(|(scatter, _)| *scatter).fold(f64::INFINITY, f64::min);
        let likely = judged.iter().filter(|(scatter, _)| *scatter <= best + LIKELY);
        let least = likely.map(|(_, below)| *below).fold(f64::INFINITY, f64::min);
        if least.is_finite() && least > (FAR_ABOVE * highest / line.measured).ln() {
            return Err(IdentifyError::ImpossibleShape {
                piece: test.pieces[line.piece].name.clone(),
                nodes: line.nodes,
                frequency: line.measured,
                least: line.measured * least.exp(),
            });
        }
    }
    Ok(())
}

/// Constants of usual panels from solid metal to the softest core, alike both ways and not.
fn panels(constants: &FreeConstants) -> Vec<Vec<f64>> {
    let mut panels = Vec::new();
    for (softness, ratio) in SOFTNESS.iter().flat_map(|softness| RATIOS.map(|ratio| (*softness, ratio))) {
        let usual = guess(constants, softness);
        let named = |(value, constant): (f64, &Constant)| match constant.name {
            name if constants.held_at(name).is_some() => value,
            "e_y" => value * ratio,
            "g_xy" => value * ratio.sqrt(),
            // So that the law stays definite.
            "nu_xy" => value / ratio.max(1.0),
            _ => value,
        };
        panels.push(usual.into_iter().zip(&constants.constants).map(named).collect());
    }
    panels
}

/// Logarithms of each line's mode on a panel over the line; `None` where a panel has no such modes.
fn ratios(
    test: &ImpactTest,
    structure: &dyn SearchedStructure,
    panel: &[f64],
    lines: &[NamedLine],
) -> Option<Vec<f64>> {
    let ratio = |line: &NamedLine| {
        let piece = &test.pieces[line.piece].piece;
        let frequency = structure.estimated_frequency(piece, test.boundary, panel, line.nodes)?;
        (frequency > 0.0).then(|| (frequency / line.measured).ln())
    };
    lines.iter().map(ratio).collect()
}

/// Median distance of the other lines from their own median, and of one line from that.
fn others_and_line(ratios: &[f64], line: usize) -> (f64, f64) {
    let mut others = ratios.to_vec();
    let own = others.swap_remove(line);
    let size = median(others.clone());
    (median(others.iter().map(|ratio| (ratio - size).abs()).collect()), own - size)
}

/// The upper one of two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
