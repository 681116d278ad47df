//! Which pole is which mode: starting constants from poles alone.

use orthopanel_model::{BEAM_CONSTANTS, BeamConstants, Boundary, ExactBeam, ModelError, Piece, SHEAR_COEFFICIENT};

/// Poles of one piece \[Hz\], rising.
pub(super) struct PiecePoles {
    pub sizes: Piece,
    pub boundary: Boundary,
    pub frequencies: Vec<f64>,
    /// Up to where the records reach \[Hz\].
    pub band: f64,
}

/// Constants and, for every piece, the mode (from 0) of each of its poles; `None` for a pole that no mode meets.
pub(super) struct Matching {
    pub constants: [f64; 2],
    pub modes: Vec<Vec<Option<usize>>>,
}

/// $E_x/(k'G_{zx})$ tried, four a decade.
const SOFTNESS_STEPS: usize = 15;
/// Poles that may be the first of the piece: those below may come from its suspension.
const ANCHORS: usize = 3;
/// Modes that the anchor may be: those below may be unseen.
const LOWEST_MODES: usize = 4;
/// A pole further than this from every mode belongs to none.
const REACH: f64 = 0.05;

/// Finds the constants whose modes meet the poles best.
///
/// For each ratio of the constants and each mode that one of the lowest poles may be, $E_x$ follows from it; the score counts
/// how far the poles lie from their nearest modes, with a charge for a pole that no mode meets and for a mode that no
/// pole shows, so that many modes are no way to meet few poles. `held` constants stay.
pub(super) fn match_poles(pieces: &[PiecePoles], held: [Option<f64>; 2]) -> Result<Option<Matching>, ModelError> {
    let Some(guide) = pieces.iter().max_by_key(|piece| piece.frequencies.len()) else { return Ok(None) };
    let mut best: Option<(f64, Matching)> = None;
    for step in 0..SOFTNESS_STEPS {
        let shear_ratio = SHEAR_COEFFICIENT * 10.0_f64.powf(0.25 * step as f64);
        let unit = [1e9, 1e9 / shear_ratio];
        let beam = exact(guide, unit)?;
        let bases = beam.natural_frequencies(LOWEST_MODES);
        let anchors = guide.frequencies.iter().take(ANCHORS);
        for (anchor, base) in anchors.flat_map(|anchor| bases.iter().map(move |base| (anchor, base))) {
            let factor = (anchor / base).powi(2);
            let free = unit.map(|value| value * factor);
            let constants = [held[0].unwrap_or(free[0]), held[1].unwrap_or(free[1])];
            if BEAM_CONSTANTS.iter().zip(constants).any(|(constant, value)| constant.check(value).is_err()) {
                continue;
            }
            let mut score = 0.0;
            let mut modes = Vec::new();
            for piece in pieces {
                let (charge, matched) = match_piece(piece, &modes_in_band(piece, constants)?);
                score += charge;
                modes.push(matched);
            }
            if best.as_ref().is_none_or(|(least, _)| score < *least) {
                best = Some((score, Matching { constants, modes }));
            }
        }
    }
    Ok(best.map(|(_, matching)| matching))
}

/// The modes of each piece's poles at given constants.
pub(super) fn match_at(pieces: &[PiecePoles], constants: [f64; 2]) -> Result<Matching, ModelError> {
    let matched = |piece: &PiecePoles| Ok(match_piece(piece, &modes_in_band(piece, constants)?).1);
    Ok(Matching { constants, modes: pieces.iter().map(matched).collect::<Result<_, ModelError>>()? })
}

fn exact(piece: &PiecePoles, [e_x, g_zx]: [f64; 2]) -> Result<ExactBeam, ModelError> {
    ExactBeam::new(&piece.sizes, piece.boundary, BeamConstants { e_x, g_zx })
}

/// Natural frequencies up to a little above the band; at most 200.
fn modes_in_band(piece: &PiecePoles, constants: [f64; 2]) -> Result<Vec<f64>, ModelError> {
    let beam = exact(piece, constants)?;
    let limit = piece.band * (1.0 + REACH);
    Ok(beam.flexible_modes().take(200).map(|mode| mode.frequency()).take_while(|&f| f < limit).collect())
}

/// The charge of a piece and the mode of each pole, one pole a mode, nearest first.
fn match_piece(piece: &PiecePoles, modes: &[f64]) -> (f64, Vec<Option<usize>>) {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (p, pole) in piece.frequencies.iter().enumerate() {
        for (m, mode) in modes.iter().enumerate() {
            let distance = (mode / pole - 1.0).abs();
            if distance < REACH {
                pairs.push((distance, p, m));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut of_pole = vec![None; piece.frequencies.len()];
    let mut taken = vec![false; modes.len()];
    let mut charge = 0.0;
    for (distance, p, m) in pairs {
        if of_pole[p].is_none() && !taken[m] {
            of_pole[p] = Some(m);
            taken[m] = true;
            charge += distance;
        }
    }
    let lonely_poles = of_pole.iter().filter(|mode| mode.is_none()).count();
    let lonely_modes = taken.iter().zip(modes).filter(|(taken, mode)| !**taken && **mode < piece.band).count();
    (charge + REACH * (lonely_poles + lonely_modes) as f64, of_pole)
}
