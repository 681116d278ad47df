//! Deflection of the beam under a force that stands still: what all flexible modes together leave at low frequency.

use super::Section;
use crate::{Boundary, End, ModelError, Piece};

/// $\sum_m W_m(x_1)W_m(x_2)/\omega_m^2$ over **all** flexible modes, in closed form:
/// $$G = \frac{1}{E_x}\frac1I\int M_1M_2\,dx + \frac{1}{G_{zx}}\frac{1}{k'A}\int V_1V_2\,dx$$
/// where $M_i$, $V_i$ are the moment and the shear force of a unit force at $x_i$ in equilibrium with the reactions of
/// the held ends and, for what is free to move, with the inertia of the rigid motion. Where the ends hold more than
/// equilibrium needs, the redundant reactions follow from least complementary energy.
///
/// Needed wherever a sum over modes is cut: at the force's own place the sum converges with one over its length only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticFlexibility {
    half_length: f64,
    section: Section,
    boundary: Boundary,
}

/// Moment and shear force along the beam.
type Field<'a> = Box<dyn Fn(f64) -> [f64; 2] + 'a>;

impl StaticFlexibility {
    /// Of a beam with these sizes and ends.
    ///
    /// # Errors
    /// [`ModelError::Size`] where the piece has no physical meaning, [`ModelError::HeldSide`] where front or back is held.
    pub fn new(piece: &Piece, boundary: Boundary) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let boundary = boundary.of_beam()?;
        Ok(Self { half_length: 0.5 * piece.length, section: Section::of(&piece), boundary })
    }

    /// $G$ \[m/N\] between two places at the constants $E_x$ and $G_{zx}$, and its derivatives by both.
    pub fn between(&self, first: f64, second: f64, e_x: f64, g_zx: f64) -> (f64, [f64; 2]) {
        let stiffness = [e_x * self.section.second_moment, g_zx * self.section.shear_area];
        let breaks = [first, second];
        let states = self.self_stresses();
        // Redundants: both fields made orthogonal to the self-stresses, in complementary energy.
        let mut orthogonal: Vec<Field> = Vec::new();
        for state in states {
            orthogonal.push(self.without(state, &orthogonal, stiffness, breaks));
        }
        let fields = [first, second].map(|x| self.without(self.loaded(x), &orthogonal, stiffness, breaks));
        let [bending, shear] = self.energies(&fields[0], &fields[1], breaks);
        let (by_bending, by_shear) = (bending / stiffness[0], shear / stiffness[1]);
        // Least energy: moving the redundants changes nothing to first order, so only the stiffnesses count.
        (by_bending + by_shear, [-by_bending / e_x, -by_shear / g_zx])
    }

    /// `field` less its share of each of `states`.
    fn without<'a>(&self, field: Field<'a>, states: &[Field<'a>], stiffness: [f64; 2], breaks: [f64; 2]) -> Field<'a>
    where
        Self: 'a,
    {
        let energy = |a: &Field, b: &Field| {
            let [bending, shear] = self.energies(a, b, breaks);
            bending / stiffness[0] + shear / stiffness[1]
        };
        // Every state is linear in x with a constant shear force: two numbers hold it.
        let mut taken = [0.0; 2];
        for state in states {
            let share = energy(&field, state) / energy(state, state);
            let [at_centre, slope] = state(0.0);
            taken = [taken[0] + share * at_centre, taken[1] + share * slope];
        }
        Box::new(move |x| {
            let [moment, shear] = field(x);
            [moment - taken[0] - taken[1] * x, shear - taken[1]]
        })
    }

    /// Moment and shear force that the ends can bear without any load: $M = c + dx$, $V = d$.
    fn self_stresses<'a>(&self) -> Vec<Field<'a>> {
        let h = self.half_length;
        let linear = |at_centre: f64, slope: f64| -> Field<'a> { Box::new(move |x| [at_centre + slope * x, slope]) };
        match (self.boundary.left, self.boundary.right) {
            (End::Clamped, End::Clamped) => vec![linear(1.0, 0.0), linear(0.0, 1.0 / h)],
            (End::Clamped, End::Pinned) => vec![linear(-1.0, 1.0 / h)],
            (End::Pinned, End::Clamped) => vec![linear(1.0, 1.0 / h)],
            _ => vec![],
        }
    }

    /// One field in equilibrium with a unit force at `at`: $V' = -\delta + \rho A\ddot w$, $M' = V + \rho I\ddot\psi$.
    fn loaded<'a>(&self, at: f64) -> Field<'a> {
        let h = self.half_length;
        let Section { mass, rotary_inertia, .. } = self.section;
        let turning_inertia = |pivot: f64| 2.0 * h * (mass * (h * h / 3.0 + pivot * pivot) + rotary_inertia);
        // Rigid acceleration ẅ = p + q x, ψ̈ = −q.
        let (p, q) = match (self.boundary.left, self.boundary.right) {
            (End::Free, End::Free) => (1.0 / (2.0 * h * mass), at / turning_inertia(0.0)),
            (End::Pinned, End::Free) => {
                let q = (at + h) / turning_inertia(h);
                (q * h, q)
            }
            (End::Free, End::Pinned) => {
                let q = (at - h) / turning_inertia(h);
                (-q * h, q)
            }
            _ => (0.0, 0.0),
        };
        let inertia = move |x: f64| {
            let (s, x2) = (x + h, x * x - h * h);
            let shear = mass * (p * s + 0.5 * q * x2);
            let moment = mass * (0.5 * p * s * s + 0.5 * q * ((x.powi(3) + h.powi(3)) / 3.0 - h * h * s));
            [moment - rotary_inertia * q * s, shear]
        };
        let with_force = move |x: f64| {
            let [moment, shear] = inertia(x);
            if x > at { [moment - (x - at), shear - 1.0] } else { [moment, shear] }
        };
        // Reactions at the left end, so that what must vanish at the right end does.
        let [moment, shear] = with_force(h + h * 1e-15);
        let (left_moment, left_shear) = match (self.boundary.left, self.boundary.right) {
            (End::Free, _) => (0.0, 0.0),
            (End::Pinned, End::Free) => (0.0, -shear),
            (End::Pinned, _) => (0.0, -moment / (2.0 * h)),
            (End::Clamped, End::Pinned) => (-moment, 0.0),
            (End::Clamped, _) => (-moment + 2.0 * h * shear, -shear),
        };
        Box::new(move |x| {
            let [moment, shear] = with_force(x);
            [moment + left_moment + left_shear * (x + h), shear + left_shear]
        })
    }

    /// $\int M_1M_2\,dx$ and $\int V_1V_2\,dx$: four Gauss points a segment are exact for these polynomials.
    fn energies(&self, first: &Field, second: &Field, breaks: [f64; 2]) -> [f64; 2] {
        let h = self.half_length;
        let mut nodes = [-h, breaks[0].clamp(-h, h), breaks[1].clamp(-h, h), h];
        nodes.sort_by(f64::total_cmp);
        let mut sums = [0.0; 2];
        for pair in nodes.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            for (t, weight) in super::gauss_points() {
                let x = middle + half * t;
                let (a, b) = (first(x), second(x));
                sums[0] += half * weight * a[0] * b[0];
                sums[1] += half * weight * a[1] * b[1];
            }
        }
        sums
    }
}
