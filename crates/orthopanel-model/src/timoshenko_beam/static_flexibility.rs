//! Deflection of the beam under a force that stands still: what all flexible modes together leave at low frequency.

use super::beam_terms::{BeamTerms, ShearLoss};
use super::static_field::StaticField;
use super::{Section, gauss_points};
use crate::structure::Motion;
use crate::{Boundary, End, ModelError, Piece};

/// $\sum_m W_m(x_1)W_m(x_2)/\omega_m^2$ over **all** flexible modes, in closed form:
/// $$G = \frac{1}{E_x}\frac1I\int M_1M_2\,dx + \frac{1}{G_{zx}}\frac{1}{k'A}\int V_1V_2\,dx$$
/// where $M_i$, $V_i$ are the moment and the shear force of a unit force at $x_i$ in equilibrium with the reactions of
/// the held ends and, for what is free to move, with the inertia of the rigid motion. Where the ends hold more than
/// equilibrium needs, the redundant reactions follow from least complementary energy.
///
/// Needed wherever a sum over modes is cut: at the force's own place the sum converges with one over its length only.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticFlexibility {
    half_length: f64,
    section: Section,
    boundary: Boundary,
    losses: Vec<ShearLoss>,
    /// Flexibility of the support of a clamped end: \[m/N\] and \[rad/(N m)\].
    support: [f64; 2],
}

impl StaticFlexibility {
    /// Of a beam with these sizes and ends.
    ///
    /// # Errors
    /// [`ModelError::Size`] where the piece has no physical meaning, [`ModelError::HeldSide`] where front or back is held.
    pub fn new(piece: &Piece, boundary: Boundary) -> Result<Self, ModelError> {
        Self::with_terms(piece, boundary, &BeamTerms::default())
    }

    pub(super) fn with_terms(piece: &Piece, boundary: Boundary, terms: &BeamTerms) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let boundary = boundary.of_beam()?;
        let mut section = Section::of(&piece);
        section.rotary_inertia *= terms.rotary_factor;
        let support = terms.support.map_or([0.0; 2], |support| [1.0 / support.translation, 1.0 / support.rotation]);
        Ok(Self { half_length: 0.5 * piece.length, section, boundary, losses: terms.losses.clone(), support })
    }

    /// $G$ \[m/N\] between two places at the constants $E_x$ and $G_{zx}$, and its derivatives by both.
    pub fn between(&self, first: f64, second: f64, e_x: f64, g_zx: f64) -> (f64, [f64; 2]) {
        self.between_motions([(Motion::Deflection, first), (Motion::Deflection, second)], [e_x, g_zx])
    }

    /// The like of [`StaticFlexibility::between`] for any two motions: the load is what works on each.
    pub(crate) fn between_motions(&self, at: [(Motion, f64); 2], [e_x, g_zx]: [f64; 2]) -> (f64, [f64; 2]) {
        let stiffness = [e_x * self.section.second_moment, g_zx * self.section.shear_area];
        // Redundants: both fields made orthogonal to the self-stresses, in complementary energy.
        let mut orthogonal: Vec<StaticField> = Vec::new();
        for state in self.self_stresses() {
            orthogonal.push(self.without(state, &orthogonal, stiffness));
        }
        let [a, b] = at.map(|(motion, x)| self.without(self.loaded(motion, x), &orthogonal, stiffness));
        let [bending, shear, support] = self.energies(&a, &b);
        let (by_bending, by_shear) = (bending / stiffness[0], shear / stiffness[1]);
        // Least energy: moving the redundants changes nothing to first order, so only the stiffnesses count.
        (by_bending + by_shear + support, [-by_bending / e_x, -by_shear / g_zx])
    }

    /// `field` less its share of each of `states`.
    fn without(&self, mut field: StaticField, states: &[StaticField], stiffness: [f64; 2]) -> StaticField {
        let energy = |a: &StaticField, b: &StaticField| {
            let [bending, shear, support] = self.energies(a, b);
            bending / stiffness[0] + shear / stiffness[1] + support
        };
        for state in states {
            field.take(state, energy(&field, state) / energy(state, state));
        }
        field
    }

    /// Moment and shear force that the ends can bear without any load: $M = c + dx$, $V = d$.
    pub(super) fn self_stresses(&self) -> Vec<StaticField> {
        let h = self.half_length;
        let linear = |at_centre: f64, slope: f64| StaticField::linear(at_centre, slope);
        match (self.boundary.left, self.boundary.right) {
            (End::Clamped, End::Clamped) => vec![linear(1.0, 0.0), linear(0.0, 1.0 / h)],
            (End::Clamped, End::Pinned) => vec![linear(-1.0, 1.0 / h)],
            (End::Pinned, End::Clamped) => vec![linear(1.0, 1.0 / h)],
            _ => vec![],
        }
    }

    /// One field in equilibrium with a unit load at `at`: $V' = -f + \rho A\ddot w$, $M' = V - c + \rho I\ddot\psi$.
    pub(super) fn loaded(&self, motion: Motion, at: f64) -> StaticField {
        let h = self.half_length;
        let Section { mass, rotary_inertia, .. } = self.section;
        let turning_inertia = |pivot: f64| 2.0 * h * (mass * (h * h / 3.0 + pivot * pivot) + rotary_inertia);
        // Work of the load on w = 1 and on the turning w = x, ψ = −1.
        let (pushes, turns) = match motion {
            Motion::Deflection | Motion::Foot => (1.0, at),
            Motion::Slope => (0.0, 1.0),
            Motion::Rotation => (0.0, -1.0),
            Motion::Curvature | Motion::SlopeAcross | Motion::Shear(_) => (0.0, 0.0),
        };
        // Rigid acceleration ẅ = p + q x, ψ̈ = −q.
        let (p, q) = match (self.boundary.left, self.boundary.right) {
            (End::Free, End::Free) => (pushes / (2.0 * h * mass), turns / turning_inertia(0.0)),
            (End::Pinned, End::Free) => {
                let q = (turns + h * pushes) / turning_inertia(h);
                (q * h, q)
            }
            (End::Free, End::Pinned) => {
                let q = (turns - h * pushes) / turning_inertia(h);
                (-q * h, q)
            }
            _ => (0.0, 0.0),
        };
        let mut field = StaticField::of_load(motion, at);
        // V = ρA∫(p + qs)ds from the left end, M its integral less ρI q (x + h).
        let shear = [mass * (p * h - 0.5 * q * h * h), mass * p, 0.5 * mass * q];
        let moment = [
            mass * (0.5 * p * h * h - q * h.powi(3) / 3.0) - rotary_inertia * q * h,
            shear[0] - rotary_inertia * q,
            0.5 * shear[1],
            shear[2] / 3.0,
        ];
        field.add_smooth(moment, shear);
        // Reactions at the left end, so that what must vanish at the right end does.
        let [moment, shear] = field.beyond(h);
        let (left_moment, left_shear) = match (self.boundary.left, self.boundary.right) {
            (End::Free, _) => (0.0, 0.0),
            (End::Pinned, End::Free) => (0.0, -shear),
            (End::Pinned, _) => (0.0, -moment / (2.0 * h)),
            (End::Clamped, End::Pinned) => (-moment, 0.0),
            (End::Clamped, _) => (-moment + 2.0 * h * shear, -shear),
        };
        field.add_smooth([left_moment + left_shear * h, left_shear, 0.0, 0.0], [left_shear, 0.0, 0.0]);
        field
    }

    /// $\int M_1M_2\,dx$, $\int V_1V_2\,dx$ with the shear losses in it, and what the supports of clamped ends store.
    fn energies(&self, a: &StaticField, b: &StaticField) -> [f64; 3] {
        let h = self.half_length;
        let mut sums = [0.0; 3];
        for [start, end] in segments(a, b, [-h, h]) {
            for (x, weight) in points(start, end) {
                let (a, b) = (a.at(x), b.at(x));
                sums[0] += weight * a[0] * b[0];
                sums[1] += weight * a[1] * b[1];
            }
        }
        let [moments, shears] = StaticField::concentrated(a, b);
        sums[0] += moments;
        sums[1] += shears;
        for loss in &self.losses {
            let [low, high] = loss.edges(h);
            sums[1] += (1.0 / (1.0 - loss.loss) - 1.0) * shear_between(a, b, low, high);
        }
        let ends = self.end_products(a, b);
        sums[2] = self.support[0] * ends[0] + self.support[1] * ends[1];
        sums
    }

    /// Products of shear forces and of moments at the clamped ends.
    fn end_products(&self, a: &StaticField, b: &StaticField) -> [f64; 2] {
        let h = self.half_length;
        let mut products = [0.0; 2];
        let mut add = |a: [f64; 2], b: [f64; 2]| {
            products[0] += a[1] * b[1];
            products[1] += a[0] * b[0];
        };
        if self.boundary.left == End::Clamped {
            add(a.before(-h), b.before(-h));
        }
        if self.boundary.right == End::Clamped {
            add(a.beyond(h), b.beyond(h));
        }
        products
    }
}

/// $\int V_1V_2\,dx$ between two places, peaks and all.
fn shear_between(a: &StaticField, b: &StaticField, low: f64, high: f64) -> f64 {
    let spread: f64 = segments(a, b, [low, high])
        .flat_map(|[start, end]| points(start, end))
        .map(|(x, weight)| weight * a.at(x)[1] * b.at(x)[1])
        .sum();
    let inside = |field: &StaticField| field.place() > low && field.place() < high;
    spread + a.concentrated_shear(b, inside(a)) + b.concentrated_shear(a, inside(b))
}

/// Stretches of `[low, high]` on which both fields are polynomials.
fn segments(a: &StaticField, b: &StaticField, [low, high]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let [a, b] = [a, b].map(|field| field.place().clamp(low, high));
    let nodes = [low, a.min(b), a.max(b), high];
    (0..3).map(move |i| [nodes[i], nodes[i + 1]]).filter(|[start, end]| end > start)
}

/// Four Gauss points a segment are exact for the products of two cubics.
fn points(start: f64, end: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    gauss_points().into_iter().map(move |(t, weight)| (middle + half * t, half * weight))
}
