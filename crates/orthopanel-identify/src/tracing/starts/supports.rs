//! Where the search for yielding clamps begins: the constants of a beam fitted with ideal clamps can be far off.

use orthopanel_model::{BEAM_CONSTANTS, Effect, Piece, ReceptanceSetup};

use super::stiffness_grid::StiffnessGrid;
use crate::IdentifyError;
use crate::accelerance_fit::pole_charge;
use crate::tracing::hypothesis::Switched;
use crate::tracing::record_problem::State;

/// The effect.
pub(in crate::tracing) const SUPPORT: &str = "support-compliance";
/// Springs tried against rotation, in $EI/L$, and against translation, in $EI/L^3$: from clamps that yield visibly to such that
/// hardly do.
const ROTATIONS: [f64; 3] = [10.0, 50.0, 250.0];
const TRANSLATIONS: [f64; 3] = [300.0, 3000.0, 30_000.0];
/// Ratios $E_x/G_{zx}$ tried: lowest, highest and steps between.
const RATIOS: (f64, f64, usize) = (6.0, 60.0, 5);
/// One of so many lowest poles is one of so many lowest modes.
const ANCHORS: usize = 3;
/// A pole further than this from every mode belongs to none.
pub(in crate::tracing) const REACH: f64 = 0.05;
/// Starts that are handed on.
const STARTS: usize = 6;

/// What tells where to begin.
pub(in crate::tracing) struct SupportStarts<'a> {
    /// Resonances \[Hz\], rising.
    pub poles: &'a [f64],
    /// $E_x$, $G_{zx}$ where they are declared.
    pub held: &'a [Option<f64>; 2],
    pub setup: &'a ReceptanceSetup,
    pub piece: &'a Piece,
}

/// `base` with springs at the clamps and constants at which the modes lie nearest to the poles, the likeliest first. With
/// the springs counted in $EI$, all frequencies go with the root of a factor on both constants.
///
/// # Errors
/// What the model refuses, as where no end is clamped.
pub(in crate::tracing) fn support_starts(
    SupportStarts { poles, held, setup, piece }: SupportStarts,
    base: &State,
    effect: &'static dyn Effect,
    count: usize,
) -> Result<Vec<State>, IdentifyError> {
    let top = poles.last().copied().unwrap_or(0.0) * (1.0 + REACH);
    let with = |constants: [f64; 2], rotation: f64, translation: f64| {
        let bending = constants[0] * piece.width * piece.thickness.powi(3) / 12.0;
        let springs = [rotation * bending / piece.length, translation * bending / piece.length.powi(3)];
        let value = |name: &str| Some(springs[usize::from(name == "translation")]);
        let switched = Switched::new(effect, piece, count, value, |_| false);
        let constants = constants.map(f64::ln);
        State { constants, hypothesis: base.hypothesis.and(switched), ..base.clone() }
    };
    let grid = StiffnessGrid { ratios: RATIOS, anchors: ANCHORS, poles, held };
    let mut found: Vec<(f64, State)> = Vec::new();
    for (rotation, translation) in ROTATIONS.iter().flat_map(|r| TRANSLATIONS.map(|t| (*r, t))) {
        for unit in grid.units(base.constants[0].exp()) {
            let state = with(unit, rotation, translation);
            let modes = setup.summed_frequencies(&unit, &state.hypothesis.states(count)?)?;
            let best = grid
                .factors(&modes)
                .into_iter()
                .map(|factor| (pole_charge(poles, modes.iter().map(|mode| mode * factor), top, REACH), factor));
            let Some((charge, factor)) = best.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            let values = unit.map(|constant| constant * factor * factor);
            if BEAM_CONSTANTS.iter().zip(&values).all(|(constant, &value)| constant.check(value).is_ok()) {
                found.push((charge, with(values, rotation, translation)));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(found.into_iter().take(STARTS).map(|(_, state)| state).collect())
}
