//! Whether the records reach far enough: as many modes as constants must lie within their band.

use orthopanel_model::Piece;

use super::recorded::{Recorded, StartPiece};
use super::records::PlaceRecord;
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::structures::Shown;
use crate::usual_ratios::usual_value;

/// Constants of a usual panel, $E_x$ and $G_{zx}$ \[Pa\], where nothing else is known.
const USUAL: (f64, f64) = (1e10, 5e8);
/// Bands are doubled so often in looking for the next mode.
const DOUBLINGS: usize = 12;

/// Young's modulus beyond all materials \[Pa\].
const STIFFEST: f64 = 1e12;
/// Band end over the first natural frequency of the stiffest beyond which hundreds of modes would lie in the band.
const TOO_MANY: f64 = 3000.0;

/// Refuses a piece whose modes would crowd the band by thousands: its sizes are in another unit.
///
/// A free beam's first frequency is $\frac{22.37}{2\pi l^2}\sqrt{Et^3/12\rho t}$; another boundary's is not ten times higher.
pub(super) fn refuse_large_pieces(pieces: &[StartPiece]) -> Result<(), IdentifyError> {
    for piece in pieces {
        let Piece { length, thickness, mass_per_area, .. } = piece.sizes;
        let (_, to) = band(piece);
        let bending = STIFFEST * thickness.powi(3) / 12.0;
        let first = 22.37 / (std::f64::consts::TAU * length * length) * (bending / mass_per_area).sqrt();
        if first * TOO_MANY < to {
            return Err(IdentifyError::PieceTooLarge { length, thickness, mass_per_area, first, to });
        }
    }
    Ok(())
}

/// Refuses a band that holds fewer modes of these constants than `free` ones are wanted.
///
/// The flanks of modes beyond the band do bend with every constant, but with one mode for two constants what they tell is
/// bent by the least fault of the records: 95 % intervals held the truth in three of four made tests.
pub(super) fn refuse_low_band(
    recorded: &Recorded,
    constants: &FreeConstants,
    parameters: &[f64],
) -> Result<(), IdentifyError> {
    let values = |piece: usize| constants.values(parameters, piece);
    let of = "the panel that meets them best";
    too_low(recorded, constants.count(), values, of)?.map_or(Ok(()), Err)
}

/// The same for a panel with usual constants, as the reason why few resonances stand out.
pub(super) fn low_band_of_usual_panel(recorded: &Recorded) -> Result<Option<IdentifyError>, IdentifyError> {
    let FreeConstants { constants, held, .. } = &recorded.constants;
    let (e_x, g_zx) = USUAL;
    let value = |(constant, held): (_, &Option<f64>)| held.unwrap_or(usual_value(constant, [e_x; 2], g_zx));
    let values = |_| constants.iter().zip(held).map(value).collect();
    too_low(recorded, recorded.constants.count(), values, "a panel of this size with usual constants")
}

fn too_low(
    recorded: &Recorded,
    needed: usize,
    values: impl Fn(usize) -> Vec<f64>,
    of: &'static str,
) -> Result<Option<IdentifyError>, IdentifyError> {
    if recorded.structure.shown() == Shown::InPart {
        return Ok(None);
    }
    let mut found = 0;
    // Band end and frequencies of the piece that holds the most modes.
    let mut best: Option<(f64, Vec<f64>)> = None;
    for (piece, poles) in recorded.pieces.iter().zip(&recorded.poles) {
        let (from, to) = band(piece);
        let values = values(piece.index);
        let mut limit = to;
        let mut modes = Vec::new();
        for _ in 0..DOUBLINGS {
            let seen = poles.structure.modes_below(&values, limit, &[])?;
            modes = seen.iter().map(|mode| mode.frequency).filter(|&frequency| frequency >= from).collect();
            if modes.len() >= needed {
                break;
            }
            limit *= 2.0;
        }
        let inside = modes.iter().filter(|&&frequency| frequency <= to).count();
        found += inside;
        if best.as_ref().is_none_or(|(end, known)| known.iter().filter(|&known| known <= end).count() < inside) {
            best = Some((to, modes));
        }
    }
    if found >= needed {
        return Ok(None);
    }
    let next = best.and_then(|(to, modes)| {
        let inside = modes.iter().filter(|&&frequency| frequency <= to).count();
        Some((to, *modes.get(inside + needed - found - 1)?))
    });
    Ok(next.map(|(to, next)| IdentifyError::BandTooLow { to, found, needed, of, next }))
}

/// Lowest and highest line of a piece's records \[Hz\].
fn band(piece: &StartPiece) -> (f64, f64) {
    let first = |record: &PlaceRecord| record.frequency.first().copied().unwrap_or(0.0);
    let from = piece.records.iter().map(first).fold(f64::INFINITY, f64::min);
    (from, piece.records.iter().map(PlaceRecord::band_end).fold(0.0, f64::max))
}
