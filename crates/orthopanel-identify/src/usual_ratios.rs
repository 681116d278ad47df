//! What the constants of a panel usually are beside each other: a start for a search, and a place to rest for a constant
//! that the data do not show.

use orthopanel_model::Constant;

use crate::free_constants::{FreeConstants, Rest};
use crate::least_squares::Quadratic;

/// Poisson's ratio of aluminium faces.
pub(crate) const NU: f64 = 0.3;
/// $G_{xy}/E_x$ of faces alike in both directions.
pub(crate) const USUAL_SHEAR: f64 = 0.5 / (1.0 + NU);

/// Where a constant of a panel rests: faces and core alike in both directions,
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

/// A constant beside these; where nothing is usual of it, the middle of its bounds.
pub(crate) fn usual_value(constant: &Constant, [e_x, e_y]: [f64; 2], g_zx: f64) -> f64 {
    match constant.name {
        "e_x" => e_x,
        "e_y" => e_y,
        "nu_xy" => usual_poisson(e_x, e_y),
        "g_xy" => USUAL_SHEAR * e_x,
        "g_yz" | "g_zx" => g_zx,
        _ if constant.low > 0.0 => (constant.low * constant.high).sqrt(),
        _ => 0.5 * (constant.low + constant.high),
    }
}

/// Standard deviation of a modulus' logarithm beside what is usual, of Poisson's ratio, and of what rests on nothing beside
/// its start: wide, since they only hold what no datum moves.
pub(crate) const USUAL_LOG_STD: f64 = 0.5;
const USUAL_POISSON_STD: f64 = 0.1;
const START_LOG_STD: f64 = 1.5;

/// All free constants of a panel, each near what is usual beside the others: what data do not show then stays there.
pub(crate) struct BesideUsual<'a> {
    pub constants: &'a FreeConstants,
    /// Where parameters that rest on nothing are kept.
    pub start: Vec<f64>,
    /// Indices of the pieces that the data are of.
    pub pieces: Vec<usize>,
}

impl BesideUsual<'_> {
    /// A residual of each parameter over the standard deviation that is open to it; fills the lower triangle.
    pub fn add_to(&self, sum: &mut Quadratic, parameters: &[f64]) {
        for index in 0..parameters.len() {
            let (residual, std, leader) = self.residual(index, parameters);
            let mut row = vec![(index, std.recip())];
            row.extend(leader.map(|leader| (leader, -std.recip())));
            row.sort_by_key(|(parameter, _)| *parameter);
            sum.add_row(residual / std, &row);
        }
    }

    /// Standard deviation of a parameter that nothing but what is usual tells.
    pub fn open(&self, index: usize) -> f64 {
        self.residual(index, &self.start).1
    }

    /// The parameter less what is usual, the standard deviation of that, and the parameter that it follows.
    fn residual(&self, index: usize, parameters: &[f64]) -> (f64, f64, Option<usize>) {
        let constant = self.constants.free[index].constant;
        let mut pieces = self.pieces.iter().copied();
        let has_it = |piece: &usize| self.constants.parameters_of(*piece)[constant] == Some(index);
        let piece = pieces.find(has_it).unwrap_or(0);
        match usual_rest(self.constants, constant) {
            Some(Rest::Held(value)) => (parameters[index] - value, USUAL_POISSON_STD, None),
            Some(Rest::Follows { leader, ratio }) => {
                let value = self.constants.values(parameters, piece)[leader];
                let leads = self.constants.parameters_of(piece)[leader];
                (parameters[index] - (ratio * value).ln(), USUAL_LOG_STD, leads)
            }
            None => (parameters[index] - self.start[index], START_LOG_STD, None),
        }
    }
}
