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
//! In $R$ the rotation $\psi_x$ is taken as held in the waves that the series lacks, which leaves $A_{55}/D_{11}k_x^2$ of $\Delta R$. Under a foot that
//! is made good: a wave $\cos k_xx\cos k_yy$ gives way by
//! $$c = \frac1{A_{55}k_x^2+A_{44}k_y^2}+\frac1{D_{11}k_x^4+2(D_{12}+2D_{66})k_x^2k_y^2+D_{22}k_y^4}$$
//! (exact where both shear stiffnesses are one), and swings with the mass per area $\rho$, so that the waves that the basis lacks answer with $c +
//! \omega^2\rho c^2 + \omega^4\rho^2c^3 + \dots$ Sums over waves less those over the basis' own functions are what it lacks; the lower half of these functions are such waves to
//! all digits, and need no part in it.

use std::cell::OnceCell;

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

/// $D_{11}, D_{22}, D_{12}, D_{66}$ \[N m\], $A_{55}, A_{44}$ \[N/m\].
type Stiffnesses = [f64; 6];

/// $k^2$ \[1/m2\] of a wave along one direction, and the square of its value at a place.
type Wave = (f64, f64);

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
        stiffnesses: Stiffnesses,
        motions: [(Motion, crate::Place); 2],
    ) -> Option<f64> {
        let has_kink = motions.iter().all(|motion| self.end(bases, *motion).is_some());
        let [first, second] = motions.each_ref().map(std::slice::from_ref);
        has_kink.then(|| self.kinks(bases, stiffnesses, [first, second])[(0, 0)])
    }

    /// The same between the motions of two lists, a row each of the first; zero for a rotation.
    pub(super) fn kinks(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: Stiffnesses,
        motions: [&[(Motion, crate::Place)]; 2],
    ) -> Mat<f64> {
        let ends = motions.map(|motions| motions.iter().map(|motion| self.end(bases, *motion)).collect::<Vec<_>>());
        let a_55 = stiffnesses[4];
        let foundations: Vec<f64> = self.across.slopes.iter().map(|nu| self.foundation(*nu, stiffnesses)).collect();
        let root = |(m, a): (usize, &f64)| -> Vec<f64> {
            self.along[self.along_of[m]].slopes.iter().map(|sigma| (a_55 * sigma + a).sqrt().recip()).collect()
        };
        let roots: Vec<Vec<f64>> = foundations.iter().enumerate().map(root).collect();
        // What the series have is a sum over products of one factor a motion.
        let in_series = |end: &Seen| -> Vec<f64> {
            let of_mode = |(m, roots): (usize, &Vec<f64>)| {
                let (along, across) = (&end.along[self.along_of[m]], end.across[m]);
                roots.iter().zip(along).map(move |(root, u)| across * u * root).collect::<Vec<_>>()
            };
            roots.iter().enumerate().flat_map(of_mode).collect()
        };
        let [rows, columns] = ends.each_ref().map(|ends| {
            let columns: Vec<Vec<f64>> = ends.iter().map(|end| end.as_ref().map_or_else(Vec::new, in_series)).collect();
            let factors = roots.iter().map(Vec::len).sum();
            Mat::from_fn(factors, columns.len(), |i, p| columns[p].get(i).copied().unwrap_or(0.0))
        });
        let mut kinks = -product(rows.transpose(), columns.as_ref());
        for (m, &a) in foundations.iter().enumerate() {
            let answer = Answer::of((a_55, a), (self.half_length, self.returned));
            let near = |end: &Option<Seen>| end.as_ref().map(|end| (end.across[m], end.side.1, answer.near(end.side)));
            let [rows, columns] = ends.each_ref().map(|ends| ends.iter().map(near).collect::<Vec<_>>());
            for (q, second) in columns.iter().enumerate() {
                for (p, first) in rows.iter().enumerate() {
                    if let (Some(first), Some(second)) = (first, second) {
                        kinks[(p, q)] += first.0 * second.0 * answer.between((first.1, first.2), (second.1, second.2));
                    }
                }
            }
        }
        let [rows, columns] = motions;
        for (q, column) in columns.iter().enumerate().filter(|(_, column)| column.0 == Motion::Foot) {
            let under = OnceCell::new();
            for (p, _) in rows.iter().enumerate().filter(|(_, row)| *row == column) {
                kinks[(p, q)] += under.get_or_init(|| self.under_foot(bases, stiffnesses, column.1));
            }
        }
        kinks
    }

    /// What the basis lacks of $\sum\phi_{1m}\phi_{2m}/\omega_m^{2+2k}$ between any two motions of a list, on a mass per area \[kg/m2\], from $k = 1$ on:
    /// told under a foot alone.
    pub(super) fn inertia(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: Stiffnesses,
        mass_per_area: f64,
        motions: &[(Motion, crate::Place)],
    ) -> [Mat<f64>; INERTIAL] {
        let mut lacking = [(); INERTIAL].map(|()| Mat::zeros(motions.len(), motions.len()));
        for (q, column) in motions.iter().enumerate().filter(|(_, column)| column.0 == Motion::Foot) {
            let by_waves = OnceCell::new();
            for (p, _) in motions.iter().enumerate().filter(|(_, row)| *row == column) {
                let [_, squares @ ..] = by_waves.get_or_init(|| self.by_waves(bases, stiffnesses, column.1));
                for ((power, lacking), square) in (1..).zip(&mut lacking).zip(squares) {
                    lacking[(p, q)] = square * mass_per_area.powi(power);
                }
            }
        }
        lacking
    }

    /// What the functions across lack under a foot at a place.
    fn under_foot(&self, bases: &[EdgeBasis; 2], stiffnesses: Stiffnesses, place: crate::Place) -> f64 {
        let a_55 = stiffnesses[4];
        let kappa = |nu: f64| (self.foundation(nu, stiffnesses) / a_55).sqrt();
        // What comes back from either end doubles the answer at a free one, and takes it away at a held one.
        let returned = |kappa: f64| {
            let [left, right] = self.returned;
            let h = self.half_length;
            left * (-2.0 * kappa * (h + place.x)).exp() + right * (-2.0 * kappa * (h - place.x)).exp()
        };
        let seen = self.across.at(&mean_over_foot(&bases[1], (place.y, self.half_width)));
        let basis = seen
            .iter()
            .zip(&self.across.slopes)
            .map(|(value, nu)| value * value / kappa(*nu) * (1.0 + returned(kappa(*nu))));
        let count = (FINEST * 2.0 * self.half_width / FOOT).ceil() as usize;
        let exact = self.waves_across(place.y, count).into_iter().map(|(square, seen)| {
            let kappa = kappa(square);
            // What comes back has no kink, and its mean over the foot is its value in the middle.
            seen * (mean_of_decay(kappa * FOOT) + returned(kappa)) / kappa
        });
        let [bends, ..] = self.by_waves(bases, stiffnesses, place);
        (exact.sum::<f64>() - basis.sum::<f64>()) / (2.0 * a_55) + bends
    }

    /// Waves less functions of the basis under a foot: of $c$ what it has beside the answer of the membrane, then of $c^2$, $c^3$ and $c^4$.
    fn by_waves(&self, bases: &[EdgeBasis; 2], stiffnesses: Stiffnesses, place: crate::Place) -> [f64; 1 + INERTIAL] {
        let [d_11, d_22, d_12, d_66, a_55, a_44] = stiffnesses;
        let seen = |modes: &Modes, values: &[f64]| -> Vec<Wave> {
            let values = modes.at(values);
            modes.slopes.iter().zip(values).map(|(square, value)| (*square, value * value)).collect()
        };
        let across = seen(&self.across, &mean_over_foot(&bases[1], (place.y, self.half_width)));
        let values = mean_over_foot(&bases[0], (place.x, self.half_length));
        let along: Vec<Vec<Wave>> = self.along.iter().map(|modes| seen(modes, &values)).collect();
        let longest = along.iter().map(Vec::len).max().unwrap_or(0);
        let counts = [longest, across.len()];
        let sum = |across: &[Wave], (along, of): (&[Vec<Wave>], &dyn Fn(usize) -> usize)| {
            let mut sums = [0.0; 1 + INERTIAL];
            for (j, &(y, seen_y)) in across.iter().enumerate() {
                let foundation = self.foundation(y, stiffnesses);
                // The lower half are such waves to all digits.
                let low = if 2 * j < counts[1] { counts[0].div_ceil(2) } else { 0 };
                for &(x, seen_x) in along[of(j)].iter().skip(low) {
                    let bending = d_11 * x * x + 2.0 * (d_12 + 2.0 * d_66) * x * y + d_22 * y * y;
                    let (shear, membrane) = (a_55 * x + a_44 * y, a_55 * x + foundation);
                    // One division for all three.
                    let share = (shear * bending * membrane).recip();
                    let (c, of_membrane) = ((shear + bending) * membrane * share, shear * bending * share);
                    let seen = seen_x * seen_y;
                    let square = seen * c * c;
                    let terms = [seen * (c - of_membrane), square, square * c, square * c * c];
                    sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
                }
            }
            sums
        };
        let waves = self.waves_across(place.y, WAVES * counts[1]);
        let exact = sum(&waves, (&[self.waves_along(place.x, WAVES * counts[0])], &|_| 0));
        let in_basis = sum(&across, (&along, &|j| self.along_of[j]));
        std::array::from_fn(|k| exact[k] - in_basis[k])
    }

    fn waves_along(&self, x: f64, count: usize) -> Vec<Wave> {
        waves((2.0 * self.half_length, x + self.half_length), self.returned.map(|sign| sign < 0.0), count)
    }

    fn waves_across(&self, y: f64, count: usize) -> Vec<Wave> {
        waves((2.0 * self.half_width, y + self.half_width), self.sides.map(|end| end != End::Free), count)
    }

    /// A motion as the membrane's modes see it.
    fn end(&self, [x, y]: &[EdgeBasis; 2], (motion, place): (Motion, crate::Place)) -> Option<Seen> {
        let values_across = || y.values_at(Field::Deflection, place.y);
        let (order, values, across) = match motion {
            Motion::Deflection => (0, x.values_at(Field::Deflection, place.x), values_across()),
            Motion::Foot => {
                (0, mean_over_foot(x, (place.x, self.half_length)), mean_over_foot(y, (place.y, self.half_width)))
            }
            Motion::Slope => (1, x.slopes_at(Field::Deflection, place.x), values_across()),
            Motion::SlopeAcross | Motion::Rotation | Motion::Curvature | Motion::Shear(_) => return None,
        };
        Some(Seen {
            side: (order, place.x),
            along: self.along.iter().map(|modes| modes.at(&values)).collect(),
            across: self.across.at(&across),
        })
    }

    /// $a_m$ of a mode across.
    fn foundation(&self, nu: f64, [_, d_22, _, _, a_55, a_44]: Stiffnesses) -> f64 {
        // A membrane that nothing holds answers a force without end; what its series lacks is finite.
        let least = LOOSE * a_55 / (self.half_length * self.half_length);
        let bending = d_22 * nu;
        (a_44 * nu * bending / (a_44 + bending)).max(least)
    }
}

/// $G$ of $A_{55}G'' - aG = -\delta$: $e^{-\kappa|x-x'|}$ with what comes back from the ends.
struct Answer {
    kappa: f64,
    half_length: f64,
    returned: [f64; 2],
    /// $2A_{55}\kappa$, less what comes back twice.
    stiffness: f64,
}

impl Answer {
    fn of((a_55, a): (f64, f64), (half_length, returned): (f64, [f64; 2])) -> Self {
        let kappa = (a / a_55).sqrt();
        let twice = returned[0] * returned[1] * (-4.0 * kappa * half_length).exp();
        Self { kappa, half_length, returned, stiffness: 2.0 * a_55 * kappa * (1.0 - twice) }
    }

    /// At a place what is there and what comes back from the left end, and the same from the right end.
    fn near(&self, (order, x): Side) -> [f64; 2] {
        // A derivative turns the sign of the returned wave.
        let turned = if order == 0 { 1.0 } else { -1.0 };
        let sides = [(self.kappa, self.half_length + x), (-self.kappa, self.half_length - x)];
        [0, 1].map(|side| {
            let (slope, away) = sides[side];
            slope.powi(order as i32) * (1.0 + turned * self.returned[side] * (-2.0 * self.kappa * away).exp())
        })
    }

    fn between(&self, first: (f64, [f64; 2]), second: (f64, [f64; 2])) -> f64 {
        let (left, right) = if first.0 <= second.0 { (first, second) } else { (second, first) };
        let ends = if left.0 == right.0 {
            0.5 * (left.1[0] * right.1[1] + right.1[0] * left.1[1])
        } else {
            left.1[0] * right.1[1]
        };
        ends * (-self.kappa * (right.0 - left.0)).exp() / self.stiffness
    }
}

/// Side of what stands on a panel \[m\]: a stud, an accelerometer. Twice as much changes $R(0)$ by $\ln2/2\pi\sqrt{A_{44}A_{55}}$.
const FOOT: f64 = 0.01;
/// Values of the functions of deflection along one side, in the mean over a foot about a place, between edges half a side from the middle: by Gauss'
/// two points, exact to the third degree.
fn mean_over_foot(basis: &EdgeBasis, (place, half): (f64, f64)) -> Vec<f64> {
    let [before, after] = gauss_points(place, half).map(|place| basis.values_at(Field::Deflection, place));
    before.iter().zip(after).map(|(before, after)| 0.5 * (before + after)).collect()
}

/// Gauss' two points of a foot along one side.
pub(super) fn gauss_points(place: f64, half: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|side| (place + side * 0.5 * FOOT / 3.0_f64.sqrt()).clamp(-half, half))
}

/// Half-waves over a foot up to which functions across count.
const FINEST: f64 = 6.0;

/// Powers of $\omega^2$ to which the waves that a basis lacks answer.
pub(super) const INERTIAL: usize = 3;

/// Waves along either side, over the functions that a basis has: what they answer with falls with the fourth power of theirs.
const WAVES: usize = 8;

/// $k^2$ of the first waves between two edges, and the square of their mean over a foot, where the integral of their square is one.
fn waves((size, from_edge): (f64, f64), held: [bool; 2], count: usize) -> Vec<Wave> {
    // Half-waves of the first.
    let first = match held {
        [false, false] => 0.0,
        [true, true] => 1.0,
        _ => 0.5,
    };
    let wave = |m: usize| {
        let wave_number = std::f64::consts::PI * (m as f64 + first) / size;
        let shape = if held[0] { (wave_number * from_edge).sin() } else { (wave_number * from_edge).cos() };
        let square = if wave_number == 0.0 { 1.0 / size } else { 2.0 / size * shape * shape };
        let half = 0.5 * wave_number * FOOT;
        let mean = if half > 0.0 { (half.sin() / half).powi(2) } else { 1.0 };
        (wave_number * wave_number, square * mean)
    };
    (0..count).map(wave).collect()
}

/// Mean of $e^{-|x-x'|\kappa}$ over a stretch of $u/\kappa$ for both.
fn mean_of_decay(u: f64) -> f64 {
    if u < 1e-3 { 1.0 - u / 3.0 } else { 2.0 * (u - 1.0 + (-u).exp()) / (u * u) }
}

/// Foundation of the membrane at least, beside $A_{55}/h^2$.
const LOOSE: f64 = 1e-5;
