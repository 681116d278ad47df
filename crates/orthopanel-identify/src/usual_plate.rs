//! What the constants of a plate usually are beside each other: a start for a search, and a place to rest for a constant
//! that the data do not show.

use crate::free_constants::Rest;

/// Poisson's ratio of aluminium faces.
const NU: f64 = 0.3;

/// Where a constant of a plate rests: faces and core alike in both directions,
/// $$E_y = E_x,\quad \nu_{xy} = 0.3,\quad G_{xy} = \frac{E_x}{2(1+\nu_{xy})},\quad G_{yz} = G_{zx}.$$
/// `None` for $E_x$ and $G_{zx}$, on which the others rest. `position` finds a constant by its name.
pub(crate) fn usual_rest(name: &str, position: impl Fn(&str) -> usize) -> Option<Rest> {
    let follows = |leader: &str, ratio: f64| Some(Rest::Follows { leader: position(leader), ratio });
    match name {
        "e_y" => follows("e_x", 1.0),
        "g_xy" => follows("e_x", 0.5 / (1.0 + NU)),
        "g_yz" => follows("g_zx", 1.0),
        "nu_xy" => Some(Rest::Held(NU)),
        _ => None,
    }
}

/// All constants of a plate beside these two, in the order of [`orthopanel_model::PLATE_CONSTANTS`].
pub(crate) fn usual_plate(e_x: f64, g_zx: f64) -> [(&'static str, f64); 6] {
    let g_xy = 0.5 * e_x / (1.0 + NU);
    [("e_x", e_x), ("e_y", e_x), ("nu_xy", NU), ("g_xy", g_xy), ("g_yz", g_zx), ("g_zx", g_zx)]
}
