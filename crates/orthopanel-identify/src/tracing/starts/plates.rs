//! Constants at which the search for a plate begins: those of a beam fitted to a plate's records can be far off.

use orthopanel_model::{BEAM_CONSTANTS, EffectState, ModelError, ReceptanceSetup};

use super::stiffness_grid::StiffnessGrid;
use crate::accelerance_fit::pole_charge;

/// Ratios $E_x/G_{zx}$ tried: lowest, highest and steps between.
const RATIOS: (f64, f64, usize) = (4.0, 100.0, 7);
/// One of so many lowest poles is one of so many lowest modes.
const ANCHORS: usize = 3;
/// A pole further than this from every mode belongs to none.
const REACH: f64 = 0.05;
/// Starts that are handed on.
const STARTS: usize = 4;

/// Constants $E_x$, $G_{zx}$ at which the modes with these effects lie nearest to the poles' frequencies \[Hz\], the likeliest
/// first. Held ones stay.
///
/// # Errors
/// What the model refuses.
pub(super) fn plate_starts(
    setup: &ReceptanceSetup,
    effects: &[EffectState],
    (poles, held): (&[f64], &[Option<f64>; 2]),
    usual: f64,
) -> Result<Vec<[f64; 2]>, ModelError> {
    let grid = StiffnessGrid { ratios: RATIOS, anchors: ANCHORS, poles, held };
    let top = poles.last().copied().unwrap_or(0.0) * (1.0 + REACH);
    let mut found: Vec<(f64, [f64; 2])> = Vec::new();
    for unit in grid.units(usual) {
        let modes = setup.summed_frequencies(&unit, effects)?;
        let charge = |factor: f64| pole_charge(poles, modes.iter().map(|mode| mode * factor), top, REACH);
        let anchored = |factor: f64| (charge(factor), unit.map(|constant| constant * factor * factor));
        found.extend(grid.factors(&modes).into_iter().map(anchored));
    }
    found.retain(|(_, values)| {
        BEAM_CONSTANTS.iter().zip(values).all(|(constant, &value)| constant.check(value).is_ok())
    });
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let alike = |a: &[f64; 2], b: &[f64; 2]| a.iter().zip(b).all(|(a, b)| (a / b).ln().abs() < 0.1);
    Ok(found.into_iter().fold(vec![], |mut starts, (_, values)| {
        if starts.len() < STARTS && !starts.iter().any(|other| alike(other, &values)) {
            starts.push(values);
        }
        starts
    }))
}
