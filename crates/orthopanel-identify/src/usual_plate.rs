//! What the constants of a plate usually are beside each other: a start for a search, and a place to rest for a constant
//! that the data do not show.

use crate::free_constants::{FreeConstants, Rest};

/// Poisson's ratio of aluminium faces.
const NU: f64 = 0.3;
/// $G_{xy}/E_x$ of faces alike in both directions.
pub(crate) const USUAL_SHEAR: f64 = 0.5 / (1.0 + NU);

/// Where a constant of a plate rests: faces and core alike in both directions,
/// $$E_y = E_x,\quad \nu_{xy} = 0.3,\quad G_{xy} = \frac{E_x}{2(1+\nu_{xy})},\quad G_{yz} = G_{zx}.$$
/// `None` for $E_x$ and $G_{zx}$, on which the others rest.
pub(crate) fn usual_rest(constants: &FreeConstants, constant: usize) -> Option<Rest> {
    let position = |name: &str| constants.constants.iter().position(|constant| constant.name == name).unwrap_or(0);
    let follows = |leader: &str, ratio: f64| Some(Rest::Follows { leader: position(leader), ratio });
    match constants.constants[constant].name {
        "e_y" => follows("e_x", 1.0),
        "g_xy" => follows("e_x", USUAL_SHEAR),
        "g_yz" => follows("g_zx", 1.0),
        "nu_xy" => Some(Rest::Held(match [constants.held_at("e_x"), constants.held_at("e_y")] {
            [Some(e_x), Some(e_y)] => usual_poisson(e_x, e_y),
            _ => NU,
        })),
        _ => None,
    }
}

/// $\nu_{xy}$ where $\nu_{xy}\nu_{yx}$ is that of equal moduli: no less can be said of a law that must be definite.
fn usual_poisson(e_x: f64, e_y: f64) -> f64 {
    NU * (e_x / e_y).sqrt().min(1.0)
}

/// All constants of a plate beside these, in the order of [`orthopanel_model::PLATE_CONSTANTS`].
pub(crate) fn usual_plate([e_x, e_y]: [f64; 2], g_zx: f64) -> [(&'static str, f64); 6] {
    let (nu_xy, g_xy) = (usual_poisson(e_x, e_y), USUAL_SHEAR * e_x);
    [("e_x", e_x), ("e_y", e_y), ("nu_xy", nu_xy), ("g_xy", g_xy), ("g_yz", g_zx), ("g_zx", g_zx)]
}
