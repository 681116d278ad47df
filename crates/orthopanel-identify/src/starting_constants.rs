//! Constants from which a search may start.

use orthopanel_model::{Constant, SHEAR_COEFFICIENT};

use crate::free_constants::FreeConstants;
use crate::usual_ratios::{USUAL_SHEAR, usual_value};

/// Any value will do: a factor on all moduli puts it right.
const GUESS: f64 = 1e9;

/// $E_x/(k'G_{zx})$ of honeycomb panels, within a factor of seven or so.
pub(crate) const USUAL_SOFTNESS: f64 = 16.0;

/// $E_x/(k'G_{zx})$ tried, from solid metal to the softest core; first what is usual, for a single frequency fits them all.
pub(crate) const SOFTNESS: [f64; 4] = [USUAL_SOFTNESS, 2.0, 128.0, 1024.0];

/// All constants at one ratio $E_x/(k'G_{zx})$ of bending to shear, around those that are held, or near which the test file has them.
pub(crate) fn guess(constants: &FreeConstants, softness: f64) -> Vec<f64> {
    let shear_ratio = softness * SHEAR_COEFFICIENT;
    let held = |name: &str| constants.known_near(name);
    // In the plane, then through the thickness.
    let faces = held("e_x").or(held("e_y")).or(held("g_xy").map(|g_xy| g_xy / USUAL_SHEAR));
    let core = held("g_zx").or(held("g_yz"));
    let e_x = faces.or(core.map(|core| core * shear_ratio)).unwrap_or(GUESS);
    let g_zx = core.unwrap_or(e_x / shear_ratio);
    let in_plane = [e_x, held("e_y").unwrap_or(e_x)];
    let value = |constant: &Constant| held(constant.name).unwrap_or_else(|| usual_value(constant, in_plane, g_zx));
    constants.constants.iter().map(value).collect()
}
