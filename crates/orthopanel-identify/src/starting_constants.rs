//! Constants from which a search may start.

use orthopanel_model::{SHEAR_COEFFICIENT, StructureKind};

use crate::free_constants::FreeConstants;
use crate::usual_plate::usual_plate;

/// Any value will do: a factor on all moduli puts it right.
const GUESS: f64 = 1e9;

/// All constants at one ratio $E_x/(k'G_{zx})$ of bending to shear, around those that are held.
pub(crate) fn guess(kind: StructureKind, constants: &FreeConstants, softness: f64) -> Vec<f64> {
    let shear_ratio = softness * SHEAR_COEFFICIENT;
    let held = |name: &str| {
        let named = constants.constants.iter().zip(&constants.held).find(|(constant, _)| constant.name == name);
        named.and_then(|(_, held)| *held)
    };
    let e_x = held("e_x").or(held("g_zx").map(|g_zx| g_zx * shear_ratio)).unwrap_or(GUESS);
    let g_zx = held("g_zx").unwrap_or(e_x / shear_ratio);
    match kind {
        StructureKind::TimoshenkoBeam => vec![e_x, g_zx],
        StructureKind::MindlinPlate => {
            usual_plate(e_x, g_zx).into_iter().map(|(name, value)| held(name).unwrap_or(value)).collect()
        }
    }
}
