//! Which pole is which mode: starting constants from poles alone.

use orthopanel_model::{ModelError, Place, StructureKind};

use super::structures::{RecordedStructure, SeenMode};
use crate::free_constants::FreeConstants;
use crate::starting_constants::guess;

/// Poles of one piece, rising.
pub(super) struct PiecePoles {
    pub structure: Box<dyn RecordedStructure>,
    /// Force and response of each record.
    pub pairs: Vec<(Place, Place)>,
    /// \[Hz\].
    pub frequencies: Vec<f64>,
    /// Amplitude of each pole in each record, which goes as $W(l_1)W(l_x)$.
    pub amplitudes: Vec<Vec<f64>>,
    /// Up to where the records reach \[Hz\].
    pub band: f64,
}

/// Constants of every piece, its modes up to a little above the band, and the mode (from 0) of each of its poles; `None`
/// for a pole that no mode meets.
pub(super) struct Matching {
    pub values: Vec<Vec<f64>>,
    pub seen: Vec<Vec<SeenMode>>,
    pub modes: Vec<Vec<Option<usize>>>,
}

impl Matching {
    /// Number of poles with a mode.
    pub(super) fn count(&self) -> usize {
        self.modes.iter().flatten().flatten().count()
    }
}

/// $E_x/(k'G_{zx})$ tried, four a decade.
const SOFTNESS_STEPS: usize = 15;
/// Poles that may be the first of the piece: those below may come from its suspension.
const ANCHORS: usize = 3;
/// Modes that the anchor may be: those below may be unseen.
const LOWEST_MODES: usize = 4;
/// A pole further than this from every mode belongs to none.
const REACH: f64 = 0.05;
/// The same while a plate's moduli still stand in their usual ratios.
const FIRST_PLATE_REACH: f64 = 0.15;
/// What a wholly different shape counts beside a distance of [`REACH`].
const SHAPE_CHARGE: f64 = 1.0;
/// A mode that moves the records less than this part of the liveliest one need not show.
const UNSEEN_PRODUCT: f64 = 0.05;

/// Finds the constants whose modes meet the poles best.
///
/// For each ratio of the constants and each mode that one of the lowest poles may be, the size of the moduli follows from it;
/// the score counts how far the poles lie from their modes in frequency and shape, with a charge for a pole that no mode
/// meets and for a mode that no pole shows, so that many modes are no way to meet few poles. Held constants stay.
pub(super) fn match_poles(
    pieces: &[PiecePoles],
    kind: StructureKind,
    constants: &FreeConstants,
) -> Result<Option<Matching>, ModelError> {
    let Some(guide) = pieces.iter().max_by_key(|piece| piece.frequencies.len()) else { return Ok(None) };
    let reach = if kind == StructureKind::MindlinPlate { FIRST_PLATE_REACH } else { REACH };
    let mut best: Option<(f64, Matching)> = None;
    for step in 0..SOFTNESS_STEPS {
        let guess = guess(kind, constants, 10.0_f64.powf(0.25 * step as f64));
        // Without a size to choose, the guess is what it is.
        let factors = if constants.moduli_are_free() { anchors(guide, &guess)? } else { vec![1.0] };
        for factor in factors {
            let values = constants.scaled(&guess, factor);
            if constants.constants.iter().zip(&values).any(|(constant, &value)| constant.check(value).is_err()) {
                continue;
            }
            let (score, matching) = match_all(pieces, vec![values; pieces.len()], reach)?;
            if best.as_ref().is_none_or(|(least, _)| score < *least) {
                best = Some((score, matching));
            }
        }
    }
    Ok(best.map(|(_, matching)| matching))
}

/// Factors on all moduli at which one of the lowest modes meets one of the lowest poles.
fn anchors(guide: &PiecePoles, guess: &[f64]) -> Result<Vec<f64>, ModelError> {
    // The least stiffness that a grid step may have still puts four modes below this.
    let mut limit = guide.band;
    let bases = loop {
        let bases = guide.structure.modes_below(guess, limit, &[])?;
        if bases.len() >= LOWEST_MODES || limit > 1e9 {
            break bases;
        }
        limit *= 4.0;
    };
    let poles = guide.frequencies.iter().take(ANCHORS);
    let of_pole = |pole: &f64| -> Vec<f64> {
        bases.iter().take(LOWEST_MODES).map(|base| (pole / base.frequency).powi(2)).collect()
    };
    Ok(poles.flat_map(of_pole).collect())
}

/// The modes of each piece's poles at given constants of each piece.
pub(super) fn match_at(pieces: &[PiecePoles], values: Vec<Vec<f64>>) -> Result<Matching, ModelError> {
    Ok(match_all(pieces, values, REACH)?.1)
}

fn match_all(pieces: &[PiecePoles], values: Vec<Vec<f64>>, reach: f64) -> Result<(f64, Matching), ModelError> {
    let (mut score, mut seen, mut modes) = (0.0, Vec::new(), Vec::new());
    for (piece, values) in pieces.iter().zip(&values) {
        let in_band = piece.structure.modes_below(values, piece.band * (1.0 + reach), &piece.pairs)?;
        let (charge, matched) = match_piece(piece, &in_band, reach);
        score += charge;
        seen.push(in_band);
        modes.push(matched);
    }
    Ok((score, Matching { values, seen, modes }))
}

/// The charge of a piece and the mode of each pole, one pole a mode, nearest first.
fn match_piece(piece: &PiecePoles, modes: &[SeenMode], reach: f64) -> (f64, Vec<Option<usize>>) {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (p, pole) in piece.frequencies.iter().enumerate() {
        for (m, mode) in modes.iter().enumerate() {
            let distance = (mode.frequency / pole - 1.0).abs();
            if distance < reach {
                let unlike = 1.0 - likeness(&mode.products, piece.amplitudes.get(p).map_or(&[][..], |list| list));
                pairs.push((distance + SHAPE_CHARGE * reach * unlike, p, m));
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
    let liveliness = |mode: &SeenMode| mode.products.iter().fold(0.0_f64, |most, product| most.max(product.abs()));
    let liveliest = modes.iter().map(liveliness).fold(0.0, f64::max);
    let shows = |mode: &SeenMode| mode.products.is_empty() || liveliness(mode) > UNSEEN_PRODUCT * liveliest;
    let lonely_poles = of_pole.iter().filter(|mode| mode.is_none()).count();
    let lonely_modes =
        taken.iter().zip(modes).filter(|(taken, mode)| !**taken && mode.frequency < piece.band && shows(mode)).count();
    (charge + reach * (lonely_poles + lonely_modes) as f64, of_pole)
}

/// Modal assurance criterion of a mode's products and a pole's amplitudes, $(p\cdot a)^2/(p\cdot p)(a\cdot a)$; one where
/// either is not told.
fn likeness(products: &[f64], amplitudes: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let sizes = dot(products, products) * dot(amplitudes, amplitudes);
    if sizes > 0.0 { dot(products, amplitudes).powi(2) / sizes } else { 1.0 }
}
