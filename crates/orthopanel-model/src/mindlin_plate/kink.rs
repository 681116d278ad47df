//! What a series along x lacks of the answer to a point force.
//!
//! Under a force the shear strain jumps, and $w$ has a kink that polynomials of degree below $n$ follow slowly. For a
//! deflection $Q_j(y)$ across, with $\int Q_iQ_jdy = \delta_{ij}$, energy and load of what is short beside the bending part are
//! $\tfrac12A_{55}\int w_{,x}^2dx - FQ_j(y_0)w(x_0)$, so $w_{,x}$ is the projection of a step on the Legendre polynomials up to
//! $P_{n-2}$, and the rest of the step's square is known:
//! $$\Delta R = \frac{h}{A_{55}}\Big[1-\max(t,t') - \sum_{k=0}^{n-2}\tfrac{2k+1}{2}q_k(t)q_k(t')\Big]
//! \sum_jw_jQ_j(y)Q_j(y'),\qquad q_k(t) = \int_t^1P_k = \frac{P_{k-1}-P_{k+1}}{2k+1},\ q_0 = 1-t$$
//! with $t = x/h$ and $h$ half the length. Where the shear across takes part, the first wave left out, $k_x = n/h$, has
//! $w_j = A_{55}k_x^2/(A_{55}k_x^2+A_{44}k_y^2)$ with $k_y = 2j/b$.
//!
//! Limits: that share is of the first wave left out. On a panel 0.8 m by 0.27 m some 3e-11 m/N remain, a quarter of what the
//! kink alone would leave: at 1 kHz 0.001 (m/s2)/N beside 1/m = 0.7.

use super::MindlinPlate;
use crate::Place;
use crate::legendre::legendre;
use crate::structure::Motion;

impl MindlinPlate {
    /// $\Delta R$ between two motions and its derivatives by $A_{55}$ and $A_{44}$; `None` for a rotation, which has no kink.
    pub(super) fn kink(&self, [a_55, a_44]: [f64; 2], motions: [(Motion, Place); 2]) -> Option<[f64; 3]> {
        let [terms_x, terms_y] = self.terms;
        let half = 0.5 * self.piece.length;
        let mut order = 0;
        for (motion, _) in motions {
            match motion {
                Motion::Deflection => {}
                Motion::Slope => order += 1,
                Motion::Rotation | Motion::Curvature => return None,
            }
        }
        let [along, other] = motions.map(|(motion, place)| {
            let t = place.x / half;
            let values = legendre(terms_x + 1, t);
            let of_degree = |k: usize| match (motion, k) {
                (Motion::Slope, _) => -values[k],
                (_, 0) => 1.0 - t,
                _ => (values[k - 1] - values[k + 1]) / (2 * k + 1) as f64,
            };
            (motion, t, (0..terms_x - 1).map(of_degree).collect::<Vec<f64>>())
        });
        // 1 - max(t, t'), derived by the place of each slope.
        let whole = match (along.0, other.0) {
            (Motion::Slope, Motion::Slope) => 0.0,
            (Motion::Slope, _) => -step(along.1 - other.1),
            (_, Motion::Slope) => -step(other.1 - along.1),
            _ => 1.0 - along.1.max(other.1),
        };
        let known: f64 =
            along.2.iter().zip(&other.2).enumerate().map(|(k, (a, b))| 0.5 * (2 * k + 1) as f64 * a * b).sum();
        let width = self.piece.width;
        let [first, second] = motions.map(|(_, place)| legendre(terms_y, 2.0 * place.y / width));
        let stiff = a_55 * (terms_x as f64 / half).powi(2);
        // The sum over j, and its derivative by ln A_55, which is minus that by ln A_44.
        let (mut across, mut turned) = (0.0, 0.0);
        for j in 0..terms_y {
            let share = stiff / (stiff + a_44 * (2.0 * j as f64 / width).powi(2));
            let term = share * (2 * j + 1) as f64 / width * first[j] * second[j];
            across += term;
            turned += (1.0 - share) * term;
        }
        let scale = half.powi(1 - order) / a_55 * (whole - known);
        Some([scale * across, scale * (turned - across) / a_55, -scale * turned / a_44])
    }
}

/// One above zero, half at it.
fn step(t: f64) -> f64 {
    if t == 0.0 { 0.5 } else { f64::from(u8::from(t > 0.0)) }
}
