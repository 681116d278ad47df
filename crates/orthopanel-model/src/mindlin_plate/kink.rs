//! What a series along x lacks of the answer to a point force.
//!
//! Under a force the shear strain jumps, and $w$ has a kink that polynomials follow slowly. Beside it the rotations are smooth,
//! so what is short is that of a membrane: with functions $v_m(y)$ across, $\int v_m'v_n'dy = \nu_m\delta_{mn}$ and
//! $\int v_mv_ndy = \delta_{mn}$, each $w_m(x)$ has the energy
//! $$\tfrac12\int\big(A_{55}w_m'^2 + a_mw_m^2\big)dx - Fv_m(y_0)w_m(x_0),\qquad
//! a_m = \frac{A_{44}\nu_m\,D_{22}\nu_m}{A_{44}+D_{22}\nu_m}$$
//! ($a_m$: bending and shear across yield one after the other), and
//! $$\Delta R = \sum_mv_m(y)v_m(y')\big[G(x,x';a_m)-G_n(x,x';a_m)\big]$$
//! with $G$ its exact answer, a product of hyperbolic functions, and $G_n$ that of the series along x.
//!
//! Under the force itself the sum over $m$ has no end: a point on a membrane gives way without limit, with the logarithm of the number of functions
//! across. What stands on a panel has a foot. With the exact functions across, $\sqrt{2/b}\cos k_my$ and the like, a force on a square of side $d$
//! moves the mean deflection there by
//! $$R(0) = \sum_m\frac{v_m^2(y)}{2A_{55}\kappa_m}\left(\frac{\sin k_md/2}{k_md/2}\right)^2f(\kappa_md),\qquad
//! f(u) = 2\,\frac{u-1+e^{-u}}{u^2},\qquad\kappa_m = \sqrt{a_m/A_{55}},$$
//! which replaces what the basis has of this sum where both motions are the same [`Motion::Foot`], with what comes back once from either end. A force of a hammer keeps its point: ports are seen from
//! afar.
//!
//! Limits: the rotation $\psi_x$ is taken as held in the waves that the series lacks, which leaves
//! $A_{55}/D_{11}k_x^2$ of $\Delta R$.

use faer::{Mat, MatRef};

use super::Field;
use super::edge_basis::EdgeBasis;
use crate::End;
use crate::dense::{product, symmetric_eigen};
use crate::order::sorted;
use crate::structure::Motion;

/// The series along x and the functions across in which the membrane falls apart.
#[derive(Debug, Clone)]
pub(crate) struct Membrane {
    half_length: f64,
    /// Sign of the wave that comes back from either end: of a free one as it came, of a held one turned round.
    returned: [f64; 2],
    /// Of each length that the series along x have.
    along: Vec<Modes>,
    /// Which of these each mode across has.
    along_of: Vec<usize>,
    across: Modes,
    /// Half the width \[m\], and what holds the edges at either end of it.
    half_width: f64,
    sides: [End; 2],
}

/// $\int f'g'$ and $\int fg$ made diagonal.
#[derive(Debug, Clone)]
struct Modes {
    /// $\int u_m'^2$ where $\int u_m^2 = 1$ \[1/m2\].
    slopes: Vec<f64>,
    /// Share of each function of the basis, a column a mode.
    shares: Mat<f64>,
}

impl Modes {
    /// Of the first `count` functions.
    fn of(basis: &EdgeBasis, count: usize) -> Option<Self> {
        let w = Field::Deflection;
        let first = |integrals: MatRef<'_, f64>| integrals.submatrix(0, 0, count, count).to_owned();
        let (mass, stiffness) = (first(basis.integrals((w, 0), (w, 0))), first(basis.integrals((w, 1), (w, 1))));
        let (sizes, turns) = symmetric_eigen(&mass)?;
        let unit = Mat::from_fn(mass.nrows(), mass.nrows(), |i, m| turns[(i, m)] / sizes[m].sqrt());
        let whole = product(unit.transpose(), product(stiffness.as_ref(), unit.as_ref()).as_ref());
        let whole = Mat::from_fn(whole.nrows(), whole.nrows(), |i, j| 0.5 * (whole[(i, j)] + whole[(j, i)]));
        let (slopes, turns) = symmetric_eigen(&whole)?;
        let greatest = slopes.last().copied().unwrap_or(0.0);
        Some(Self {
            slopes: slopes.into_iter().map(|slope| if slope < FLAT * greatest { 0.0 } else { slope }).collect(),
            shares: product(unit.as_ref(), turns.as_ref()),
        })
    }

    /// Values of the modes from those of the basis.
    fn at(&self, values: &[f64]) -> Vec<f64> {
        let values = &values[..values.len().min(self.shares.nrows())];
        let value = |m: usize| values.iter().enumerate().map(|(i, value)| value * self.shares[(i, m)]).sum();
        (0..self.slopes.len()).map(value).collect()
    }
}

/// Part of the greatest $\int u_m'^2$ below which there is but rounding: a constant, whose membrane nearly nothing holds, must be
/// one. A line across has 6e-7 of the greatest of 80 functions.
const FLAT: f64 = 1e-9;

/// A motion at a place, as the modes along x (of each length of series) and across see it.
struct Seen {
    side: Side,
    along: Vec<Vec<f64>>,
    across: Vec<f64>,
}

/// A place along one direction with the order of the derivative that is asked there.
type Side = (usize, f64);

impl Membrane {
    /// `None` where the basis has no such modes. `lengths` is how many functions along x each one across has: rising modes across
    /// are taken to have those of its functions in order.
    pub(super) fn new(
        [x, y]: &[EdgeBasis; 2],
        [half_length, half_width]: [f64; 2],
        [ends, sides]: [[End; 2]; 2],
        lengths: &[usize],
    ) -> Option<Self> {
        let returned = ends.map(|end| if end == End::Free { 1.0 } else { -1.0 });
        let mut counts = sorted(lengths.to_vec(), |&count| count as f64);
        counts.dedup();
        let along = counts.iter().map(|&count| Modes::of(x, count)).collect::<Option<Vec<_>>>()?;
        let along_of = lengths.iter().map(|length| counts.partition_point(|count| count < length)).collect();
        let across = Modes::of(y, y.count(Field::Deflection))?;
        Some(Self { half_length, returned, along, along_of, across, half_width, sides })
    }

    /// $\Delta R$ between two motions; `None` for a rotation, which has no kink.
    pub(super) fn kink(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: [f64; 3],
        [first, second]: [(Motion, crate::Place); 2],
    ) -> Option<f64> {
        let kink = self.between(stiffnesses, &self.end(bases, first)?, &self.end(bases, second)?);
        Some(if is_foot(first, second) { kink + self.under_foot(bases, stiffnesses, first.1) } else { kink })
    }

    /// The same between any two motions of a list; zero for a rotation.
    pub(super) fn kinks(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: [f64; 3],
        motions: &[(Motion, crate::Place)],
    ) -> Mat<f64> {
        let ends: Vec<Option<Seen>> = motions.iter().map(|motion| self.end(bases, *motion)).collect();
        let mut kinks = Mat::zeros(ends.len(), ends.len());
        for (p, first) in ends.iter().enumerate() {
            for (q, second) in ends.iter().enumerate().skip(p) {
                let (Some(first), Some(second)) = (first, second) else { continue };
                kinks[(p, q)] = self.between(stiffnesses, first, second);
                if is_foot(motions[p], motions[q]) {
                    kinks[(p, q)] += self.under_foot(bases, stiffnesses, motions[p].1);
                }
                kinks[(q, p)] = kinks[(p, q)];
            }
        }
        kinks
    }

    /// $\Delta R$ with $D_{22}$, $A_{55}$, $A_{44}$.
    fn between(&self, stiffnesses: [f64; 3], first: &Seen, second: &Seen) -> f64 {
        let lacking = |(m, &nu): (usize, &f64)| {
            let stiffness = [stiffnesses[1], self.foundation(nu, stiffnesses)];
            let terms: f64 = self.terms(m, [first, second], stiffness).sum();
            first.across[m] * second.across[m] * (self.green(stiffness, first.side, second.side) - terms)
        };
        self.across.slopes.iter().enumerate().map(lacking).sum()
    }

    /// What the functions across lack under a foot at a place.
    fn under_foot(&self, bases: &[EdgeBasis; 2], stiffnesses: [f64; 3], place: crate::Place) -> f64 {
        let [_, a_55, _] = stiffnesses;
        let kappa = |nu: f64| (self.foundation(nu, stiffnesses) / a_55).sqrt();
        // What comes back from either end doubles the answer at a free one, and takes it away at a held one.
        let returned = |kappa: f64| {
            let [left, right] = self.returned;
            let h = self.half_length;
            1.0 + left * (-2.0 * kappa * (h + place.x)).exp() + right * (-2.0 * kappa * (h - place.x)).exp()
        };
        let seen = self.across.at(&bases[1].values_at(Field::Deflection, place.y));
        let basis =
            seen.iter().zip(&self.across.slopes).map(|(value, nu)| value * value / kappa(*nu) * returned(kappa(*nu)));
        let held = self.sides.map(|end| end != End::Free);
        // Half-waves of the first function across.
        let first = match held {
            [false, false] => 0.0,
            [true, true] => 1.0,
            _ => 0.5,
        };
        let width = 2.0 * self.half_width;
        let from_edge = place.y + self.half_width;
        let count = (FINEST * width / FOOT).ceil() as usize;
        let exact = (0..count).map(|m| {
            let wave_number = std::f64::consts::PI * (m as f64 + first) / width;
            let shape = if held[0] { (wave_number * from_edge).sin() } else { (wave_number * from_edge).cos() };
            let square = if wave_number == 0.0 { 1.0 / width } else { 2.0 / width * shape * shape };
            let (half, kappa) = (0.5 * wave_number * FOOT, kappa(wave_number * wave_number));
            let mean = if half > 0.0 { (half.sin() / half).powi(2) } else { 1.0 };
            square * mean * mean_of_decay(kappa * FOOT) / kappa * returned(kappa)
        });
        (exact.sum::<f64>() - basis.sum::<f64>()) / (2.0 * a_55)
    }

    /// A motion as the membrane's modes see it.
    fn end(&self, [x, y]: &[EdgeBasis; 2], (motion, place): (Motion, crate::Place)) -> Option<Seen> {
        let (order, values) = match motion {
            Motion::Deflection | Motion::Foot => (0, x.values_at(Field::Deflection, place.x)),
            Motion::Slope => (1, x.slopes_at(Field::Deflection, place.x)),
            Motion::SlopeAcross | Motion::Rotation | Motion::Curvature | Motion::Shear(_) => return None,
        };
        Some(Seen {
            side: (order, place.x),
            along: self.along.iter().map(|modes| modes.at(&values)).collect(),
            across: self.across.at(&y.values_at(Field::Deflection, place.y)),
        })
    }

    /// $a_m$ of a mode across.
    fn foundation(&self, nu: f64, [d_22, a_55, a_44]: [f64; 3]) -> f64 {
        // A membrane that nothing holds answers a force without end; what its series lacks is finite.
        let least = LOOSE * a_55 / (self.half_length * self.half_length);
        let bending = d_22 * nu;
        (a_44 * nu * bending / (a_44 + bending)).max(least)
    }

    /// What each mode along x brings to $G_n$.
    fn terms<'a>(
        &'a self,
        across: usize,
        [first, second]: [&'a Seen; 2],
        [a_55, a]: [f64; 2],
    ) -> impl Iterator<Item = f64> + 'a {
        let along = self.along_of[across];
        let products = first.along[along].iter().zip(&second.along[along]).map(|(u, other)| u * other);
        self.along[along].slopes.iter().zip(products).map(move |(sigma, product)| product / (a_55 * sigma + a))
    }

    /// $A_{55}G'' - aG = -\delta$: $e^{-\kappa|x-x'|}$ with what comes back from the ends.
    fn green(&self, [a_55, a]: [f64; 2], first: Side, second: Side) -> f64 {
        let kappa = (a / a_55).sqrt();
        let h = self.half_length;
        let (left, right) = if first.1 <= second.1 { (first, second) } else { (second, first) };
        let [from_left, from_right] = self.returned;
        let value = |left: Side, right: Side| {
            // A derivative turns the sign of the returned wave.
            let turned = |order: usize| if order == 0 { 1.0 } else { -1.0 };
            let near_left =
                kappa.powi(left.0 as i32) * (1.0 + turned(left.0) * from_left * (-2.0 * kappa * (h + left.1)).exp());
            let near_right = (-kappa).powi(right.0 as i32)
                * (1.0 + turned(right.0) * from_right * (-2.0 * kappa * (h - right.1)).exp());
            near_left * near_right * (-kappa * (right.1 - left.1)).exp()
        };
        let both = if left.1 == right.1 { 0.5 * (value(left, right) + value(right, left)) } else { value(left, right) };
        both / (2.0 * a_55 * kappa * (1.0 - from_left * from_right * (-4.0 * kappa * h).exp()))
    }
}

/// Side of what stands on a panel \[m\]: a stud, an accelerometer. Twice as much changes $R(0)$ by $\ln2/2\pi\sqrt{A_{44}A_{55}}$.
const FOOT: f64 = 0.01;
/// Half-waves over a foot up to which functions across count.
const FINEST: f64 = 6.0;

/// Whether both are the mean deflection of one foot.
fn is_foot(first: (Motion, crate::Place), second: (Motion, crate::Place)) -> bool {
    first == second && first.0 == Motion::Foot
}

/// Mean of $e^{-|x-x'|\kappa}$ over a stretch of $u/\kappa$ for both.
fn mean_of_decay(u: f64) -> f64 {
    if u < 1e-3 { 1.0 - u / 3.0 } else { 2.0 * (u - 1.0 + (-u).exp()) / (u * u) }
}

/// Foundation of the membrane at least, beside $A_{55}/h^2$.
const LOOSE: f64 = 1e-5;
