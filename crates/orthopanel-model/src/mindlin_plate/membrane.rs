//! The membrane that a plate is to what its series are short of: the functions of a basis, and waves, as motions at places see them.
//!
//! With functions $v_m(y)$ across, $\int v_m'v_n'dy = \nu_m\delta_{mn}$ and $\int v_mv_ndy = \delta_{mn}$, each $w_m(x)$ has the energy
//! $$\tfrac12\int\big(A_{55}w_m'^2 + a_mw_m^2\big)dx,\qquad a_m = \frac{A_{44}\nu_m\,D_{22}\nu_m}{A_{44}+D_{22}\nu_m}$$
//! ($a_m$: bending and shear across yield one after the other).

use std::sync::{Arc, Mutex, PoisonError};

use faer::{Mat, MatRef};

use super::edge_basis::EdgeBasis;
use super::field::Field;
use super::foot::{FOOT, mean_over_foot};
use super::wave::WaveBetween;
use crate::End;
use crate::dense::{product, symmetric_eigen};
use crate::order::sorted;
use crate::structure::Motion;

/// The series along x and the functions across in which the membrane falls apart.
#[derive(Debug, Clone)]
pub(crate) struct Membrane {
    pub(super) half_length: f64,
    /// What holds either end of it.
    pub(super) ends: [End; 2],
    /// Of each length that the series along x have.
    pub(super) along: Vec<Modes>,
    /// Which of these each mode across has.
    pub(super) along_of: Vec<usize>,
    pub(super) across: Modes,
    /// Half the width \[m\], and what holds the edges at either end of it.
    pub(super) half_width: f64,
    pub(super) sides: [End; 2],
    /// Waves along x and along y, down to the finest that a foot sees.
    pub(super) waves: [Vec<WaveBetween>; 2],
    seen: Arc<Mutex<KnownMotions>>,
}

/// $\int f'g'$ and $\int fg$ made diagonal.
#[derive(Debug, Clone)]
pub(super) struct Modes {
    /// $\int u_m'^2$ where $\int u_m^2 = 1$ \[1/m2\].
    pub(super) slopes: Vec<f64>,
    /// Share of each function of the basis, a column a mode.
    pub(super) shares: Mat<f64>,
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
    pub(super) fn at(&self, values: &[f64]) -> Vec<f64> {
        let values = &values[..values.len().min(self.shares.nrows())];
        let value = |m: usize| values.iter().enumerate().map(|(i, value)| value * self.shares[(i, m)]).sum();
        (0..self.slopes.len()).map(value).collect()
    }
}

/// Part of the greatest $\int u_m'^2$ below which there is but rounding: a constant, whose membrane nearly nothing holds, must be
/// one. A line across has 6e-7 of the greatest of 80 functions.
const FLAT: f64 = 1e-9;

/// A motion at a place, as the modes along x (of each length of series) and across see it.
#[derive(Debug)]
pub(super) struct Seen {
    pub(super) place: [f64; 2],
    /// Of the derivatives along x and y.
    pub(super) orders: [usize; 2],
    pub(super) along: Vec<Vec<f64>>,
    pub(super) across: Vec<f64>,
    /// The first waves along x and along y.
    pub(super) waves: [Vec<f64>; 2],
}

/// Motions that were seen last: those at ports are asked for again and again.
type KnownMotions = Vec<((Motion, crate::Place), Arc<Seen>)>;

/// $D_{11}, D_{22}, D_{12}, D_{66}$ \[N m\], $A_{55}, A_{44}$ \[N/m\].
pub(super) type Stiffnesses = [f64; 6];

/// Along x and along y.
pub(super) const AXES: [usize; 2] = [0, 1];

impl Membrane {
    /// `None` where the basis has no such modes. `lengths` is how many functions along x each one across has: rising modes across
    /// are taken to have those of its functions in order.
    pub(super) fn new(
        [x, y]: &[EdgeBasis; 2],
        [half_length, half_width]: [f64; 2],
        [ends, sides]: [[End; 2]; 2],
        lengths: &[usize],
    ) -> Option<Self> {
        let mut counts = sorted(lengths.to_vec(), |&count| count as f64);
        counts.dedup();
        let along = counts.iter().map(|&count| Modes::of(x, count)).collect::<Option<Vec<_>>>()?;
        let along_of = lengths.iter().map(|length| counts.partition_point(|count| count < length)).collect();
        let across = Modes::of(y, y.count(Field::Deflection))?;
        let waves = [(half_length, ends), (half_width, sides)].map(|(half, ends)| {
            let count = (FINEST * 2.0 * half / FOOT).ceil() as usize;
            (0..count).map(|m| WaveBetween::new(m, 2.0 * half, ends)).collect()
        });
        let seen = Arc::default();
        Some(Self { half_length, ends, along, along_of, across, half_width, sides, waves, seen })
    }

    /// Waves less functions of the basis between the motions of two lists, each times what `term` has of its $k_x^2$ and $k_y^2$.
    pub(super) fn beyond(&self, ends: &[Vec<Option<Arc<Seen>>>; 2], term: &dyn Fn([f64; 2]) -> f64) -> Mat<f64> {
        let counts = self.counts();
        // The lower half are such waves to all digits.
        let weight = |(i, x): (usize, f64), (j, y): (usize, f64)| {
            if 2 * i < counts[0] && 2 * j < counts[1] { 0.0 } else { term([x, y]) }
        };
        let values = |count: usize, value: &dyn Fn(&Seen, usize) -> f64| {
            ends.each_ref()
                .map(|ends| Mat::from_fn(count, ends.len(), |i, p| ends[p].as_ref().map_or(0.0, |end| value(end, i))))
        };
        let waves = AXES.map(|axis| &self.waves[axis][..self.waves_between(axis)]);
        let [x, y] = AXES.map(|axis| values(waves[axis].len(), &|end, m| end.waves[axis][m]));
        let weights = Mat::from_fn(waves[0].len(), waves[1].len(), |i, j| {
            weight((i, waves[0][i].square()), (j, waves[1][j].square()))
        });
        let mut sum = weighted(&weights, [&x[0], &y[0]], [&x[1], &y[1]]);
        for (number, modes) in self.along.iter().enumerate() {
            let across: Vec<usize> = (0..self.across.slopes.len()).filter(|j| self.along_of[*j] == number).collect();
            let x = values(modes.slopes.len(), &|end, i| end.along[number][i]);
            let y = values(across.len(), &|end, j| end.across[across[j]]);
            let weights = Mat::from_fn(modes.slopes.len(), across.len(), |i, j| {
                weight((i, modes.slopes[i]), (across[j], self.across.slopes[across[j]]))
            });
            sum -= weighted(&weights, [&x[0], &y[0]], [&x[1], &y[1]]);
        }
        sum
    }

    pub(super) fn halves(&self) -> [f64; 2] {
        [self.half_length, self.half_width]
    }

    pub(super) fn edges(&self) -> [[End; 2]; 2] {
        [self.ends, self.sides]
    }

    /// Most functions along x, and those across.
    pub(super) fn counts(&self) -> [usize; 2] {
        [self.along.iter().map(|modes| modes.slopes.len()).max().unwrap_or(0), self.across.slopes.len()]
    }

    /// Waves along an axis that count between two motions.
    pub(super) fn waves_between(&self, axis: usize) -> usize {
        (WAVES_BETWEEN * self.counts()[axis]).min(self.waves[axis].len())
    }

    /// A motion as the membrane's modes see it.
    pub(super) fn end(&self, bases: &[EdgeBasis; 2], motion: (Motion, crate::Place)) -> Option<Arc<Seen>> {
        let lock = || self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, seen)) = lock().iter().find(|(known, _)| *known == motion) {
            return Some(Arc::clone(seen));
        }
        let seen = Arc::new(self.seen(bases, motion)?);
        let mut known = lock();
        known.truncate(KEPT - 1);
        known.insert(0, (motion, Arc::clone(&seen)));
        Some(seen)
    }

    fn seen(&self, [x, y]: &[EdgeBasis; 2], (motion, place): (Motion, crate::Place)) -> Option<Seen> {
        let orders = match motion {
            Motion::Deflection | Motion::Foot => [0, 0],
            Motion::Slope => [1, 0],
            Motion::SlopeAcross => [0, 1],
            Motion::Rotation | Motion::Curvature | Motion::Shear(_) => return None,
        };
        let values = |basis: &EdgeBasis, order: usize, place: f64, half: f64| match (motion, order) {
            (Motion::Foot, _) => mean_over_foot(basis, (place, half)),
            (_, 0) => basis.values_at(Field::Deflection, place),
            _ => basis.slopes_at(Field::Deflection, place),
        };
        let along = values(x, orders[0], place.x, self.half_length);
        let across = values(y, orders[1], place.y, self.half_width);
        let from_edge = [place.x + self.half_length, place.y + self.half_width];
        let waves = AXES.map(|axis| {
            let waves = self.waves[axis][..self.waves_between(axis)].iter();
            waves.map(|wave| wave.over_foot(orders[axis], from_edge[axis])).collect()
        });
        Some(Seen {
            place: [place.x, place.y],
            orders,
            waves,
            along: self.along.iter().map(|modes| modes.at(&along)).collect(),
            across: self.across.at(&across),
        })
    }

    /// $a_m$ of a wave across an axis.
    pub(super) fn foundation(&self, axis: usize, square: f64, stiffnesses: Stiffnesses) -> f64 {
        // A membrane that nothing holds answers a force without end; what its series lacks is finite.
        let least = LOOSE * shear_along(axis, stiffnesses) / self.halves()[axis].powi(2);
        let bending = stiffnesses[1 - axis] * square;
        let shear = shear_along(1 - axis, stiffnesses);
        (shear * square * bending / (shear + bending)).max(least)
    }
}

/// $c$ of a wave with these $k_x^2$ and $k_y^2$.
pub(super) fn compliance(wave: [f64; 2], stiffnesses: Stiffnesses) -> f64 {
    let [bending, shear] = resistances(wave, stiffnesses);
    shear.recip() + bending.recip()
}

/// What a wave with these $k_x^2$ and $k_y^2$ meets in bending and in shear.
pub(super) fn resistances([x, y]: [f64; 2], [d_11, d_22, d_12, d_66, a_55, a_44]: Stiffnesses) -> [f64; 2] {
    [d_11 * x * x + 2.0 * (d_12 + 2.0 * d_66) * x * y + d_22 * y * y, a_55 * x + a_44 * y]
}

/// $\sum_{ij}w_{ij}x_{ip}y_{jp}x'_{iq}y'_{jq}$.
fn weighted(weights: &Mat<f64>, [x, y]: [&Mat<f64>; 2], [other_x, other_y]: [&Mat<f64>; 2]) -> Mat<f64> {
    let mut sums = Mat::zeros(x.ncols(), other_x.ncols());
    for q in 0..other_x.ncols() {
        let own =
            Mat::from_fn(weights.nrows(), weights.ncols(), |i, j| weights[(i, j)] * other_x[(i, q)] * other_y[(j, q)]);
        let along = product(own.as_ref(), y.as_ref());
        for p in 0..x.ncols() {
            sums[(p, q)] = x.col_as_slice(p).iter().zip(along.col_as_slice(p)).map(|(a, b)| a * b).sum();
        }
    }
    sums
}

/// $A_{55}$ along x, $A_{44}$ along y.
pub(super) fn shear_along(axis: usize, stiffnesses: Stiffnesses) -> f64 {
    stiffnesses[4 + axis]
}

/// Half-waves over a foot up to which functions across count.
const FINEST: f64 = 6.0;

/// The same between two motions, where waves turn their signs against each other.
const WAVES_BETWEEN: usize = 3;

/// Motions that are kept: those at ports, and some of what a search moves.
const KEPT: usize = 256;

/// Foundation of the membrane at least, beside $A_{55}/h^2$.
const LOOSE: f64 = 1e-5;
