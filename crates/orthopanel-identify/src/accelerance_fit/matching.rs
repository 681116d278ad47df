//! Which pole is which mode: starting constants from poles alone.

use orthopanel_model::{ModelError, Place};
use rayon::prelude::*;

use super::poles::NoisePower;
use crate::free_constants::FreeConstants;
use crate::starting_constants::guess;
use crate::structures::{RecordedStructure, SeenMode, Shown};

/// Poles of one piece, rising.
pub(super) struct PiecePoles {
    /// Index of the piece in the test.
    pub piece: usize,
    pub structure: Box<dyn RecordedStructure>,
    /// Force and response of each record.
    pub pairs: Vec<(Place, Place)>,
    /// \[Hz\].
    pub frequencies: Vec<f64>,
    /// Amplitude of each pole in each record, which goes as $W(l_1)W(l_x)$.
    pub amplitudes: Vec<Vec<f64>>,
    /// Geometric mean of the poles' damping ratios.
    pub usual_zeta: f64,
    /// What a resonance must rise over.
    pub noise: NoisePower,
    /// Up to where the records reach \[Hz\].
    pub band: f64,
}

/// Constants of every piece, its modes up to a little above the band, and the mode (from 0) of each of its poles; `None`
/// for a pole that no mode meets.
pub(super) struct Matching {
    pub values: Vec<Vec<f64>>,
    pub seen: Vec<Vec<SeenMode>>,
    pub modes: Vec<Vec<Option<usize>>>,
    /// How far the poles lie from their modes, with the charges for those left alone.
    pub charge: f64,
}

impl Matching {
    /// Number of poles with a mode.
    pub(super) fn count(&self) -> usize {
        self.modes.iter().flatten().flatten().count()
    }
}

/// $E_x/(k'G_{zx})$ tried: decades above one, and steps a decade.
const SOFTNESS: (f64, f64) = (3.5, 12.0);
/// Poles that may be the first of the piece: those below may come from its suspension.
const ANCHORS: usize = 3;
/// Modes that the anchor may be: those below may be unseen.
const LOWEST_MODES: usize = 6;
/// A pole further than this from every mode belongs to none.
pub(super) const REACH: f64 = 0.05;
/// The same while moduli that are shown in part still stand in their usual ratios.
const FIRST_REACH: f64 = 0.15;
/// What a wholly different shape counts beside a distance of [`REACH`].
const SHAPE_CHARGE: f64 = 1.0;
/// A mode that moves the records less than this part of the liveliest one need not show.
const UNSEEN_PRODUCT: f64 = 0.05;

/// Constants whose modes lie near the poles, the nearest first and no two with the same modes; at most `count`.
///
/// For each ratio of the constants and each mode that one of the lowest poles may be, the size of the moduli follows from it;
/// the charge counts how far the poles lie from their modes in frequency and shape, more for a pole that no mode meets and
/// for a mode that no pole shows though it would stand out, so that many modes are no way to meet few poles. Held
/// constants stay.
///
/// The ratios stand apart, so modes are some per cent off even at the right one: which candidate is right shows when
/// each has been fitted to its poles.
pub(super) fn candidates(
    pieces: &[PiecePoles],
    shown: Shown,
    constants: &FreeConstants,
    count: usize,
) -> Result<Vec<Matching>, ModelError> {
    let Some(guide) = pieces.iter().max_by_key(|piece| piece.frequencies.len()) else { return Ok(Vec::new()) };
    let reach = match shown {
        Shown::Wholly => REACH,
        Shown::InPart => FIRST_REACH,
    };
    let (decades, steps) = SOFTNESS;
    let at_softness = |step: usize| -> Result<Vec<Matching>, ModelError> {
        let guess = guess(constants, 10.0_f64.powf(step as f64 / steps));
        // Without a size to choose, the guess is what it is.
        let factors = if constants.moduli_are_free() { anchors(guide, &guess)? } else { vec![1.0] };
        let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
        let at_guess = |piece: &PiecePoles| {
            piece.structure.modes_below(&guess, piece.band * (1.0 + reach) / least.sqrt(), &piece.pairs)
        };
        let modes = pieces.iter().map(at_guess).collect::<Result<Vec<_>, _>>()?;
        let found = factors.into_iter().filter_map(|factor| {
            let values = constants.scaled(&guess, factor);
            let holds = constants.constants.iter().zip(&values).all(|(constant, &value)| constant.check(value).is_ok());
            // Frequencies go with the root of a factor on all moduli; shapes stay.
            let scaled = |(piece, modes): (&PiecePoles, &Vec<SeenMode>)| {
                let scaled = modes.iter().map(|mode| SeenMode {
                    frequency: mode.frequency * factor.sqrt(),
                    by_constant: Vec::new(),
                    ..mode.clone()
                });
                scaled.take_while(|mode| mode.frequency < piece.band * (1.0 + reach)).collect()
            };
            holds.then(|| {
                match_all(pieces, vec![values; pieces.len()], pieces.iter().zip(&modes).map(scaled).collect(), reach)
            })
        });
        Ok(found.collect())
    };
    let all: Vec<_> = (0..=(decades * steps) as usize).into_par_iter().map(at_softness).collect();
    let mut all: Vec<Matching> = all.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect();
    all.sort_by(|a, b| a.charge.total_cmp(&b.charge));
    let mut found: Vec<Matching> = Vec::new();
    for matching in all {
        if found.len() < count && found.iter().all(|other| other.modes != matching.modes) {
            found.push(matching);
        }
    }
    Ok(found)
}

/// Factors on all moduli at which one of the lowest modes meets one of the lowest poles.
fn anchors(guide: &PiecePoles, guess: &[f64]) -> Result<Vec<f64>, ModelError> {
    // The least stiffness that a grid step may have still puts the lowest modes below this.
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
    match_within(pieces, values, REACH)
}

/// The same where a pole may lie as far from its mode as `reach`.
pub(super) fn match_within(pieces: &[PiecePoles], values: Vec<Vec<f64>>, reach: f64) -> Result<Matching, ModelError> {
    let seen = pieces
        .iter()
        .zip(&values)
        .map(|(piece, values)| piece.structure.modes_below(values, piece.band * (1.0 + reach), &piece.pairs));
    let seen = seen.collect::<Result<Vec<_>, _>>()?;
    Ok(match_all(pieces, values, seen, reach))
}

fn match_all(pieces: &[PiecePoles], values: Vec<Vec<f64>>, seen: Vec<Vec<SeenMode>>, reach: f64) -> Matching {
    let (charges, modes): (Vec<f64>, Vec<_>) =
        pieces.iter().zip(&seen).map(|(piece, seen)| match_piece(piece, seen, reach)).unzip();
    Matching { values, seen, modes, charge: charges.iter().sum() }
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
    let shows =
        |mode: &SeenMode| liveliness(mode) > UNSEEN_PRODUCT * liveliest && piece.noise.is_heard(mode, piece.usual_zeta);
    let lonely_poles = of_pole.iter().filter(|mode| mode.is_none()).count();
    let lonely_modes =
        taken.iter().zip(modes).filter(|(taken, mode)| !**taken && mode.frequency < piece.band && shows(mode)).count();
    (charge + reach * (lonely_poles + lonely_modes) as f64, of_pole)
}

/// Modal assurance criterion of a mode's products and a pole's amplitudes, $(p\cdot a)^2/(p\cdot p)(a\cdot a)$; one where
/// either is not told.
pub(super) fn likeness(products: &[f64], amplitudes: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let sizes = dot(products, products) * dot(amplitudes, amplitudes);
    if sizes > 0.0 { dot(products, amplitudes).powi(2) / sizes } else { 1.0 }
}
