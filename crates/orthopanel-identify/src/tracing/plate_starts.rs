//! Constants at which the search for a plate begins: those of a beam fitted to a plate's records can be far off.

use orthopanel_model::{BEAM_CONSTANTS, EffectState, ModelError, ReceptanceSetup};

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
    usual: [f64; 2],
) -> Result<Vec<[f64; 2]>, ModelError> {
    let (lowest, highest, steps) = RATIOS;
    let mut found: Vec<(f64, [f64; 2])> = Vec::new();
    for step in 0..=steps {
        let ratio = lowest * (highest / lowest).powf(step as f64 / steps as f64);
        let unit = match *held {
            [Some(e_x), g_zx] => [e_x, g_zx.unwrap_or(e_x / ratio)],
            [None, Some(g_zx)] => [ratio * g_zx, g_zx],
            [None, None] => [usual[0], usual[0] / ratio],
        };
        let modes = setup.summed_frequencies(&unit, effects)?;
        // Frequencies go with the root of a factor on both constants.
        let anchored = |pole: &f64| modes.iter().take(ANCHORS).map(|mode| pole / mode).collect::<Vec<_>>();
        let factors: Vec<f64> =
            if *held == [None; 2] { poles.iter().take(ANCHORS).flat_map(anchored).collect() } else { vec![1.0] };
        let top = poles.last().copied().unwrap_or(0.0) * (1.0 + REACH);
        let charge = |factor: f64| pole_charge(poles, modes.iter().map(|mode| mode * factor), top, REACH);
        found.extend(factors.into_iter().map(|factor| (charge(factor), unit.map(|c| c * factor * factor))));
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
