//! Pieces that differ, which lists of several pieces hardly part from a plate.

use orthopanel_data::ImpactTest;

use crate::usual_ratios::NU;
use crate::{Identification, Settings, identify};

/// Poisson's ratio of a face that is alike in all directions is no more.
const MOST: f64 = 0.5;
/// What pieces of one panel may differ by: the core's shear modulus goes with how far it was drawn out.
const OWN: &str = "g_zx";

/// Where the plate wants a Poisson's ratio that no material has: says so, with what the plate misses at a usual one where one piece
/// has a shear modulus of its own.
pub(super) fn in_place_of_the_plate(as_plate: &ImpactTest, plate: &Identification) -> Option<String> {
    let nu = plate.constants.iter().find(|constant| constant.name == "nu_xy")?;
    let std = nu.std?;
    if nu.value <= MOST {
        return None;
    }
    let doubt = format!(
        "nu_xy = {:.2} +- {std:.2} is no material's ({MOST} at most in faces that are alike in all directions): it stands for all that couples \
         bending along and across, and for what the pieces differ by",
        nu.value
    );
    let differing = may_differ(as_plate).filter_map(|piece| with_its_own(as_plate, piece));
    let Some(best) = differing.min_by(|a, b| a.missed.total_cmp(&b.missed)) else { return Some(doubt) };
    let side = if best.above > 0.0 { "above" } else { "below" };
    Some(format!(
        "{doubt}. With nu_xy = {NU} and {OWN} of piece {} {:.1} % {side} that of the others the plate misses {:.2} % rms, in place of {:.2} %",
        as_plate.pieces[best.piece].name,
        best.above.abs(),
        best.missed,
        plate.frequency_rms_percent
    ))
}

struct Differing {
    piece: usize,
    /// By how much its own constant is above the others' \[%\].
    above: f64,
    /// Rms \[%\].
    missed: f64,
}

/// Pieces that may have a shear modulus of their own: none where the test file has told it, and of two the second, for either one is the
/// other's rival.
fn may_differ(as_plate: &ImpactTest) -> std::ops::Range<usize> {
    let pieces = &as_plate.pieces;
    let is_told = as_plate.constants.contains_key(OWN) || pieces.iter().any(|piece| !piece.own_constants.is_empty());
    match pieces.len() {
        0 | 1 => 0..0,
        _ if is_told => 0..0,
        2 => 1..2,
        all => 0..all,
    }
}

/// The plate at the usual Poisson's ratio, with a shear modulus of its own for `piece`.
fn with_its_own(as_plate: &ImpactTest, piece: usize) -> Option<Differing> {
    let mut test = as_plate.clone();
    test.constants.insert("nu_xy".to_owned(), NU);
    test.pieces[piece].own_constants.push(OWN.to_owned());
    let found = identify(&test, Settings::default()).ok()?;
    let of = |own: bool| found.constants.iter().find(|one| one.name == OWN && one.piece.is_some() == own);
    let above = 100.0 * (of(true)?.value / of(false)?.value - 1.0);
    Some(Differing { piece, above, missed: found.frequency_rms_percent })
}
