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
//! across. What stands on a panel has a foot, and so have here a hammer's tip and a sensor. With the exact functions across, $\sqrt{2/b}\cos k_my$ and the
//! like, a force on a square of side $d$ at $x$ moves the mean deflection of one at $x'$ by
//! $$R = \sum_m\frac{v_m(y)v_m(y')}{2A_{55}\kappa_m}\left(\frac{\sin k_md/2}{k_md/2}\right)^2\big[g(|x-x'|;\kappa_m)+\dots\big],\qquad
//! \kappa_m = \sqrt{a_m/A_{55}},$$
//! with $g$ the mean of $e^{-\kappa|x-x'|}$ over both, and what comes back from the ends. It falls off with the distance along x: where two places lie farther apart
//! along y, the same is done with x and y exchanged. With functions of the basis across in place of waves, what a mass does 12 mm beside a port along x
//! hung on the basis by 2 % of a residue.
//!
//! In $R$ the rotation along the exact direction is taken as held in the waves that the series lacks. That is made good: a wave $\cos k_xx\cos k_yy$ gives way by
//! $$c = \frac1{A_{55}k_x^2+A_{44}k_y^2}+\frac1{D_{11}k_x^4+2(D_{12}+2D_{66})k_x^2k_y^2+D_{22}k_y^4}$$
//! (exact where both shear stiffnesses are one), and swings with the mass per area $\rho$, so that the waves that the basis lacks answer with $c +
//! \omega^2\rho c^2 + \omega^4\rho^2c^3 + \dots$ Sums over waves less those over the basis' own functions are what it lacks; the lower half of these functions are such waves to
//! all digits, and need no part in it.

use std::cell::OnceCell;
use std::sync::{Arc, Mutex, PoisonError};

use faer::{Mat, MatRef};

use super::Field;
use super::edge_basis::EdgeBasis;
use crate::End;
use crate::dense::{product, symmetric_eigen};
use crate::order::sorted;
use crate::structure::{Motion, ShearMoment};

/// The series along x and the functions across in which the membrane falls apart.
#[derive(Debug, Clone)]
pub(crate) struct Membrane {
    half_length: f64,
    /// What holds either end of it.
    ends: [End; 2],
    /// Of each length that the series along x have.
    along: Vec<Modes>,
    /// Which of these each mode across has.
    along_of: Vec<usize>,
    across: Modes,
    /// Half the width \[m\], and what holds the edges at either end of it.
    half_width: f64,
    sides: [End; 2],
    /// Waves along x and along y, down to the finest that a foot sees.
    waves: [Vec<WaveBetween>; 2],
    seen: Arc<Mutex<KnownMotions>>,
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
#[derive(Debug)]
struct Seen {
    place: [f64; 2],
    /// Of the derivatives along x and y.
    orders: [usize; 2],
    along: Vec<Vec<f64>>,
    across: Vec<f64>,
    /// The first waves along x and along y.
    waves: [Vec<f64>; 2],
}

/// The square of a moment of shear strain: of either side, from the first edge of the plate on, its middle and half its length.
struct Square {
    moment: ShearMoment,
    sides: [[f64; 2]; 2],
}

/// Motions that were seen last: those at ports are asked for again and again.
type KnownMotions = Vec<((Motion, crate::Place), Arc<Seen>)>;

/// $D_{11}, D_{22}, D_{12}, D_{66}$ \[N m\], $A_{55}, A_{44}$ \[N/m\].
type Stiffnesses = [f64; 6];

/// $k^2$ \[1/m2\] of a wave along one direction, and the square of its value at a place.
type Wave = (f64, f64);

/// A place along one direction with the order of the derivative that is asked there.
type Side = (usize, f64);

/// Along x and along y.
const AXES: [usize; 2] = [0, 1];

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

    /// $\Delta R$ between two motions; `None` for a rotation, which has no kink.
    pub(super) fn kink(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: Stiffnesses,
        motions: [(Motion, crate::Place); 2],
    ) -> Option<f64> {
        let has_kink = |motion: &(Motion, crate::Place)| {
            matches!(motion.0, Motion::Shear(_)) || self.end(bases, *motion).is_some()
        };
        let has_kink = motions.iter().all(has_kink);
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
        let in_series = AXES.map(|axis| self.in_series(axis, stiffnesses, &ends));
        let bending = AXES.map(|axis| {
            self.beyond(&ends, &|wave| {
                let exact = shear_along(axis, stiffnesses) * wave[axis];
                compliance(wave, stiffnesses) - (exact + self.foundation(axis, wave[1 - axis], stiffnesses)).recip()
            })
        });
        let answers = AXES.map(|axis| self.answers(axis, stiffnesses));
        let [rows, columns] = motions;
        let strained = self.under_moments(bases, stiffnesses, motions, &ends);
        Mat::from_fn(rows.len(), columns.len(), |p, q| {
            let (Some(first), Some(second)) = (&ends[0][p], &ends[1][q]) else {
                return strained.as_ref().map_or(0.0, |strained| strained[(p, q)]);
            };
            let axis = self.axis_between(first.place, second.place, stiffnesses);
            let kink = self.exact(axis, &answers[axis], [first, second]) - in_series[axis][(p, q)];
            if is_one_foot(rows[p], columns[q]) {
                let [bends, ..] = self.by_waves(bases, stiffnesses, rows[p].1);
                kink + bends
            } else {
                kink + bending[axis][(p, q)]
            }
        })
    }

    /// What the basis lacks of the static flexibility where one of two motions is a moment of shear strain; `None` where none is: of the waves that it lacks
    /// [`strain_compliance`] between their moments $q = \int p\,\partial w$. Of two of one square the sum falls off as $1/k$: that of the shortest waves is one
    /// along the strain alone, for functions across are complete, and from the finest on $q$ is what the polynomials are at the edges.
    fn under_moments(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: Stiffnesses,
        motions: [&[(Motion, crate::Place)]; 2],
        ends: &[Vec<Option<Arc<Seen>>>; 2],
    ) -> Option<Mat<f64>> {
        let squares = motions.map(|motions| motions.iter().map(|motion| self.square(*motion)).collect::<Vec<_>>());
        if squares.iter().flatten().all(Option::is_none) {
            return None;
        }
        let strain = |square: &Square| if square.moment.across { Strain::Across } else { Strain::Along };
        let seen = [0, 1].map(|list| {
            let own = squares[list].iter().zip(&ends[list]);
            let of_motion = |(square, end): (&Option<Square>, &Option<Arc<Seen>>)| match square {
                Some(square) => Some((strain(square), Arc::new(self.strained(bases, square)))),
                None => Some((Strain::None, Arc::clone(end.as_ref()?))),
            };
            own.map(of_motion).collect::<Vec<_>>()
        });
        let [rows, columns] = motions.map(<[_]>::len);
        let mut lacking = Mat::zeros(rows, columns);
        let of = |list: usize, strain: Strain| -> (Vec<usize>, Vec<Option<Arc<Seen>>>) {
            let own = seen[list].iter().enumerate().filter_map(|(number, seen)| Some((number, seen.as_ref()?)));
            own.filter(|(_, seen)| seen.0 == strain).map(|(number, seen)| (number, Some(Arc::clone(&seen.1)))).unzip()
        };
        for (first, second) in STRAINS.into_iter().flat_map(|first| STRAINS.map(|second| (first, second))) {
            let ((rows, one), (columns, other)) = (of(0, first), of(1, second));
            if rows.is_empty() || columns.is_empty() || (first, second) == (Strain::None, Strain::None) {
                continue;
            }
            let between = self.beyond(&[one, other], &|wave| strain_compliance(wave, stiffnesses, (first, second)));
            for (j, q) in columns.into_iter().enumerate() {
                rows.iter().enumerate().for_each(|(i, p)| lacking[(*p, q)] = between[(i, j)]);
            }
        }
        for (q, column) in squares[1].iter().enumerate() {
            for (p, row) in squares[0].iter().enumerate() {
                if let (Some(row), Some(column)) = (row, column) {
                    lacking[(p, q)] += self.shortest(stiffnesses, [row, column]);
                }
            }
        }
        Some(lacking)
    }

    /// What waves along the strain that are shorter than those of [`Self::beyond`] bring between two moments of one strain over one square.
    fn shortest(&self, stiffnesses: Stiffnesses, [first, second]: [&Square; 2]) -> f64 {
        let axis = usize::from(first.moment.across);
        let is_one = first.sides == second.sides && first.moment.across == second.moment.across;
        if !is_one || first.moment.degrees[1 - axis] != second.moment.degrees[1 - axis] {
            return 0.0;
        }
        let (side, degrees) = (first.sides[axis], [first, second].map(|square| square.moment.degrees[axis]));
        let waves = &self.waves[axis][self.waves_between(axis)..];
        let moved = |wave: &WaveBetween| degrees.map(|degree| wave.moment(1, (side, degree))).iter().product::<f64>();
        let sum: f64 = waves.iter().map(|wave| moved(wave) / wave.square()).sum();
        let finest = self.waves[axis].last().map_or(f64::INFINITY, |wave| wave.number);
        let [one, other] = degrees.map(|degree| (2.0 * degree as f64 + 1.0).sqrt());
        let at_edges = if (degrees[0] + degrees[1]) % 2 == 0 { 2.0 * one * other / (2.0 * side[1]) } else { 0.0 };
        (sum + at_edges / (std::f64::consts::PI * finest)) / shear_along(axis, stiffnesses)
    }

    /// The square of a moment of shear strain, as far as it lies on the plate.
    fn square(&self, (motion, at): (Motion, crate::Place)) -> Option<Square> {
        let Motion::Shear(moment) = motion else { return None };
        let halves = self.halves();
        let sides = AXES.map(|axis| {
            let (middle, half) = ([at.x, at.y][axis], halves[axis]);
            let [low, high] = [-0.5, 0.5].map(|part| (middle + part * moment.span).clamp(-half, half));
            [0.5 * (low + high) + half, 0.5 * (high - low)]
        });
        Some(Square { moment, sides })
    }

    /// A moment of shear strain as the membrane's modes see it.
    fn strained(&self, [x, y]: &[EdgeBasis; 2], Square { moment, sides }: &Square) -> Seen {
        let halves = self.halves();
        let orders = if moment.across { [0, 1] } else { [1, 0] };
        let values = |axis: usize, basis: &EdgeBasis| {
            let [middle, half] = sides[axis];
            let ends = [middle - half, middle + half].map(|from_edge| from_edge - halves[axis]);
            basis.moments(Field::Deflection, orders[axis], (ends, moment.degrees[axis]))
        };
        let waves = AXES.map(|axis| {
            let waves = self.waves[axis][..self.waves_between(axis)].iter();
            waves.map(|wave| wave.moment(orders[axis], (sides[axis], moment.degrees[axis]))).collect()
        });
        let along = values(0, x);
        Seen {
            place: AXES.map(|axis| sides[axis][0] - halves[axis]),
            orders,
            waves,
            along: self.along.iter().map(|modes| modes.at(&along)).collect(),
            across: self.across.at(&values(1, y)),
        }
    }

    /// The direction in which two places lie farther apart, for the membrane: along it the answer falls off with the distance.
    fn axis_between(&self, first: [f64; 2], second: [f64; 2], stiffnesses: Stiffnesses) -> usize {
        let apart = AXES.map(|axis| (first[axis] - second[axis]).abs() / shear_along(axis, stiffnesses).sqrt());
        usize::from(apart[1] > apart[0])
    }

    /// What the series hold of the answer that is exact along an axis, between the motions of two lists: a sum over products of one factor a motion.
    fn in_series(&self, axis: usize, stiffnesses: Stiffnesses, ends: &[Vec<Option<Arc<Seen>>>; 2]) -> Mat<f64> {
        let shear = shear_along(axis, stiffnesses);
        let root = |(m, nu): (usize, &f64)| -> Vec<f64> {
            let root = |sigma: &f64| {
                let [exact, other] = if axis == 0 { [*sigma, *nu] } else { [*nu, *sigma] };
                (shear * exact + self.foundation(axis, other, stiffnesses)).sqrt().recip()
            };
            self.along[self.along_of[m]].slopes.iter().map(root).collect()
        };
        let roots: Vec<Vec<f64>> = self.across.slopes.iter().enumerate().map(root).collect();
        let factors = |end: &Seen| -> Vec<f64> {
            let of_mode = |(m, roots): (usize, &Vec<f64>)| {
                let (along, across) = (&end.along[self.along_of[m]], end.across[m]);
                roots.iter().zip(along).map(move |(root, u)| across * u * root).collect::<Vec<_>>()
            };
            roots.iter().enumerate().flat_map(of_mode).collect()
        };
        let [rows, columns] = ends.each_ref().map(|ends| {
            let columns: Vec<Vec<f64>> = ends.iter().map(|end| end.as_deref().map_or_else(Vec::new, factors)).collect();
            let count = roots.iter().map(Vec::len).sum();
            Mat::from_fn(count, columns.len(), |i, p| columns[p].get(i).copied().unwrap_or(0.0))
        });
        product(rows.transpose(), columns.as_ref())
    }

    /// What is exact along an axis, of each wave along the other.
    fn answers(&self, axis: usize, stiffnesses: Stiffnesses) -> Vec<Answer> {
        let shear = shear_along(axis, stiffnesses);
        let of_wave = |wave: &WaveBetween| {
            let a = self.foundation(axis, wave.square(), stiffnesses);
            Answer::of((shear, a), (self.halves()[axis], self.returned(axis)))
        };
        self.waves[1 - axis].iter().map(of_wave).collect()
    }

    /// The answer of the membrane from foot to foot: exact along an axis, and a sum over waves along the other.
    fn exact(&self, axis: usize, answers: &[Answer], ends: [&Arc<Seen>; 2]) -> f64 {
        let other = 1 - axis;
        let half = self.halves()[other];
        let along = ends.map(|end| (end.orders[axis], end.place[axis]));
        let apart = (along[0].1 - along[1].1).abs();
        let counts = |answer: &&Answer| answer.kappa * (apart - FOOT) <= NEGLIGIBLE;
        let of_wave = |(m, answer): (usize, &Answer)| {
            let wave = |end: &Arc<Seen>| {
                let beyond = || self.waves[other][m].over_foot(end.orders[other], end.place[other] + half);
                end.waves[other].get(m).copied().unwrap_or_else(beyond)
            };
            wave(ends[0]) * wave(ends[1]) * answer.between(along)
        };
        answers.iter().take_while(counts).enumerate().map(of_wave).sum()
    }

    /// What the basis lacks of $\sum\phi_{1m}\phi_{2m}/\omega_m^{2+2k}$ between the motions of two lists, on a mass per area \[kg/m2\], from $k = 1$ on:
    /// of $k > 1$ under a foot alone.
    pub(super) fn inertia(
        &self,
        bases: &[EdgeBasis; 2],
        stiffnesses: Stiffnesses,
        mass_per_area: f64,
        motions: [&[(Motion, crate::Place)]; 2],
    ) -> [Mat<f64>; INERTIAL] {
        let ends = motions.map(|motions| motions.iter().map(|motion| self.end(bases, *motion)).collect::<Vec<_>>());
        let [rows, columns] = motions;
        let mut lacking = [(); INERTIAL].map(|()| Mat::zeros(rows.len(), columns.len()));
        lacking[0] = self.beyond(&ends, &|wave| mass_per_area * compliance(wave, stiffnesses).powi(2));
        for (q, column) in columns.iter().enumerate().filter(|(_, column)| column.0 == Motion::Foot) {
            let by_waves = OnceCell::new();
            for (p, _) in rows.iter().enumerate().filter(|(_, row)| *row == column) {
                let [_, squares @ ..] = by_waves.get_or_init(|| self.by_waves(bases, stiffnesses, column.1));
                for ((power, lacking), square) in (1..).zip(&mut lacking).zip(squares) {
                    lacking[(p, q)] = square * mass_per_area.powi(power);
                }
            }
        }
        lacking
    }

    /// Waves less functions of the basis between the motions of two lists, each times what `term` has of its $k_x^2$ and $k_y^2$.
    fn beyond(&self, ends: &[Vec<Option<Arc<Seen>>>; 2], term: &dyn Fn([f64; 2]) -> f64) -> Mat<f64> {
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

    /// Waves less functions of the basis under a foot: of $c$ what it has beside the answer of the membrane, then of $c^2$, $c^3$ and $c^4$.
    fn by_waves(&self, bases: &[EdgeBasis; 2], stiffnesses: Stiffnesses, place: crate::Place) -> [f64; 1 + INERTIAL] {
        let a_55 = shear_along(0, stiffnesses);
        let seen = |modes: &Modes, values: &[f64]| -> Vec<Wave> {
            let values = modes.at(values);
            modes.slopes.iter().zip(values).map(|(square, value)| (*square, value * value)).collect()
        };
        let across = seen(&self.across, &mean_over_foot(&bases[1], (place.y, self.half_width)));
        let values = mean_over_foot(&bases[0], (place.x, self.half_length));
        let along: Vec<Vec<Wave>> = self.along.iter().map(|modes| seen(modes, &values)).collect();
        let counts = self.counts();
        let sum = |across: &[Wave], (along, of): (&[Vec<Wave>], &dyn Fn(usize) -> usize)| {
            let mut sums = [0.0; 1 + INERTIAL];
            for (j, &(y, seen_y)) in across.iter().enumerate() {
                let foundation = self.foundation(0, y, stiffnesses);
                // The lower half are such waves to all digits.
                let low = if 2 * j < counts[1] { counts[0].div_ceil(2) } else { 0 };
                for &(x, seen_x) in along[of(j)].iter().skip(low) {
                    let [bending, shear] = resistances([x, y], stiffnesses);
                    let membrane = a_55 * x + foundation;
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
        let waves = self.waves(1, place.y, WAVES * counts[1]);
        let exact = sum(&waves, (&[self.waves(0, place.x, WAVES * counts[0])], &|_| 0));
        let in_basis = sum(&across, (&along, &|j| self.along_of[j]));
        std::array::from_fn(|k| exact[k] - in_basis[k])
    }

    /// $k^2$ of the first waves along an axis, and the square of their mean over a foot there.
    fn waves(&self, axis: usize, place: f64, count: usize) -> Vec<Wave> {
        let from_edge = place + self.halves()[axis];
        self.waves[axis].iter().take(count).map(|wave| (wave.square(), wave.over_foot(0, from_edge).powi(2))).collect()
    }

    fn halves(&self) -> [f64; 2] {
        [self.half_length, self.half_width]
    }

    fn edges(&self) -> [[End; 2]; 2] {
        [self.ends, self.sides]
    }

    /// Sign of the wave that comes back from either end along an axis: of a free one as it came, of a held one turned round.
    fn returned(&self, axis: usize) -> [f64; 2] {
        self.edges()[axis].map(|end| if end == End::Free { 1.0 } else { -1.0 })
    }

    /// Most functions along x, and those across.
    fn counts(&self) -> [usize; 2] {
        [self.along.iter().map(|modes| modes.slopes.len()).max().unwrap_or(0), self.across.slopes.len()]
    }

    /// Waves along an axis that count between two motions.
    fn waves_between(&self, axis: usize) -> usize {
        (WAVES_BETWEEN * self.counts()[axis]).min(self.waves[axis].len())
    }

    /// A motion as the membrane's modes see it.
    fn end(&self, bases: &[EdgeBasis; 2], motion: (Motion, crate::Place)) -> Option<Arc<Seen>> {
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
    fn foundation(&self, axis: usize, square: f64, stiffnesses: Stiffnesses) -> f64 {
        // A membrane that nothing holds answers a force without end; what its series lacks is finite.
        let least = LOOSE * shear_along(axis, stiffnesses) / self.halves()[axis].powi(2);
        let bending = stiffnesses[1 - axis] * square;
        let shear = shear_along(1 - axis, stiffnesses);
        (shear * square * bending / (shear + bending)).max(least)
    }
}

fn is_one_foot(first: (Motion, crate::Place), second: (Motion, crate::Place)) -> bool {
    first == second && first.0 == Motion::Foot
}

/// $c$ of a wave with these $k_x^2$ and $k_y^2$.
fn compliance(wave: [f64; 2], stiffnesses: Stiffnesses) -> f64 {
    let [bending, shear] = resistances(wave, stiffnesses);
    shear.recip() + bending.recip()
}

/// What a wave with these $k_x^2$ and $k_y^2$ meets in bending and in shear.
fn resistances([x, y]: [f64; 2], [d_11, d_22, d_12, d_66, a_55, a_44]: Stiffnesses) -> [f64; 2] {
    [d_11 * x * x + 2.0 * (d_12 + 2.0 * d_66) * x * y + d_22 * y * y, a_55 * x + a_44 * y]
}

/// Which shear strain a motion is a moment of.
#[derive(Clone, Copy, PartialEq)]
enum Strain {
    None,
    Along,
    Across,
}

const STRAINS: [Strain; 3] = [Strain::None, Strain::Along, Strain::Across];

/// What a wave gives way by between two moments of its strains $\gamma = \nabla w+\psi$, or of one and its deflection, over $ww'$, $k_xk_x'$ and the like of
/// these. With the bending stiffness of the rotations $K$ and $k_\perp = (-k_y, k_x)$ nothing but $k_\perp^T\psi$ holds them: the deflection is free,
/// $$F = (A + \sigma k_\perp k_\perp^T)^{-1},\qquad \sigma = \frac{\det K}{k^TKk}\ .$$
/// Short waves strain along $k$ alone, $F = kk^T/(k^TAk)$, and so they are taken to move $w$.
fn strain_compliance(wave: [f64; 2], stiffnesses: Stiffnesses, strains: (Strain, Strain)) -> f64 {
    let ([x, y], [d_11, d_22, d_12, d_66, a_55, a_44]) = (wave, stiffnesses);
    let [bending, shear] = resistances(wave, stiffnesses);
    let sigma = ((d_11 * x + d_66 * y) * (d_22 * y + d_66 * x) - (d_12 + d_66).powi(2) * x * y) / bending;
    let held = sigma / (1.0 + sigma * shear / (a_55 * a_44));
    let direct = |own: f64, other: f64, a: f64| if own > 0.0 { (1.0 - held * other / a) / (a * own) } else { 0.0 };
    match strains {
        (Strain::Along, Strain::Along) => direct(x, y, a_55),
        (Strain::Across, Strain::Across) => direct(y, x, a_44),
        (Strain::Along, Strain::Across) | (Strain::Across, Strain::Along) => held / (a_55 * a_44),
        _ => shear.recip(),
    }
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
fn shear_along(axis: usize, stiffnesses: Stiffnesses) -> f64 {
    stiffnesses[4 + axis]
}

/// $G$ of $A_{55}G'' - aG = -\delta$ from foot to foot: the mean of $e^{-\kappa|x-x'|}$ over both, with what comes back from the ends.
struct Answer {
    kappa: f64,
    half_length: f64,
    returned: [f64; 2],
    /// What is left of a wave that came back from both ends.
    twice: f64,
    /// Of the mean over a foot of what decays beyond it, over its value at the foot's edge.
    over_foot: f64,
    /// $2A_{55}\kappa$.
    stiffness: f64,
}

impl Answer {
    fn of((a_55, a): (f64, f64), (half_length, returned): (f64, [f64; 2])) -> Self {
        let kappa = (a / a_55).sqrt();
        let u = kappa * FOOT;
        Self {
            kappa,
            half_length,
            returned,
            twice: returned[0] * returned[1] * (-4.0 * kappa * half_length).exp(),
            over_foot: if u > 0.0 { -(-u).exp_m1() / u } else { 1.0 },
            stiffness: 2.0 * a_55 * kappa,
        }
    }

    fn between(&self, [first, second]: [Side; 2]) -> f64 {
        let (left, right) = if first.1 <= second.1 { (first, second) } else { (second, first) };
        let apart = right.1 - left.1;
        // What comes back has no kink, and its mean over a foot is its value in the middle.
        let back = |order: usize, returned: f64, away: f64| {
            // A derivative turns the sign of the returned wave.
            let turned = if order == 0 { 1.0 } else { -1.0 };
            turned * returned * (-2.0 * self.kappa * away).exp()
        };
        let from_left = back(left.0, self.returned[0], self.half_length + left.1);
        let from_right = back(right.0, self.returned[1], self.half_length - right.1);
        let slopes = self.kappa.powi(left.0 as i32) * (-self.kappa).powi(right.0 as i32);
        let echoes = (1.0 + from_left) * (1.0 + from_right) / (1.0 - self.twice) - 1.0;
        let decay = self.decay(apart);
        let direct = match [left.0, right.0] {
            [0, 0] => decay[0],
            [0, _] => decay[1],
            [_, 0] => -decay[1],
            _ => -decay[2],
        };
        (direct + slopes * echoes * (-self.kappa * apart).exp()) / self.stiffness
    }

    /// Mean $g$ of $e^{-\kappa|x-x'|}$ over two feet whose middles lie $\Delta$ apart, and its first two derivatives by $\Delta$.
    fn decay(&self, apart: f64) -> [f64; 3] {
        let kappa = self.kappa;
        let u = kappa * FOOT;
        if apart >= FOOT {
            let value = (-kappa * (apart - FOOT)).exp() * self.over_foot * self.over_foot;
            return [value, -kappa * value, kappa * kappa * value];
        }
        let inside = FOOT - apart;
        if u < 1e-3 {
            // $1 - \kappa$ times the mean of the distance.
            let part = inside / FOOT;
            return [
                1.0 - kappa * (apart + inside * part * part / 3.0),
                -kappa * (1.0 - part * part),
                -2.0 * kappa * part / FOOT,
            ];
        }
        let [near, far, middle] = [inside, FOOT + apart, apart].map(|distance| (-kappa * distance).exp());
        let of = |value: f64| value / (u * u);
        [
            of(2.0 * kappa * inside + far + near - 2.0 * middle),
            kappa * of(near - far - 2.0 + 2.0 * middle),
            kappa * kappa * of(far + near - 2.0 * middle),
        ]
    }
}

/// Side of what stands on a panel \[m\]: a stud, an accelerometer. Twice as much changes $R(0)$ by $\ln2/2\pi\sqrt{A_{44}A_{55}}$.
pub(crate) const FOOT: f64 = 0.01;
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

/// The same between two motions, where waves turn their signs against each other.
const WAVES_BETWEEN: usize = 3;

/// Motions that are kept: those at ports, and some of what a search moves.
const KEPT: usize = 256;

/// What decays further than by this power of $e$ is left out.
const NEGLIGIBLE: f64 = 20.0;

/// A wave between two edges, with one for the integral of its square.
#[derive(Debug, Clone)]
struct WaveBetween {
    /// $k$.
    number: f64,
    /// Where its sine or cosine is one; and of its mean over a foot there.
    at_point: f64,
    largest: f64,
    from_held: bool,
}

impl WaveBetween {
    fn new(m: usize, size: f64, edges: [End; 2]) -> Self {
        let held = edges.map(|end| end != End::Free);
        // Half-waves of the first.
        let first = match held {
            [false, false] => 0.0,
            [true, true] => 1.0,
            _ => 0.5,
        };
        let number = std::f64::consts::PI * (m as f64 + first) / size;
        let half = 0.5 * number * FOOT;
        let at_point = if number > 0.0 { (2.0 / size).sqrt() } else { size.sqrt().recip() };
        let largest = if number > 0.0 { at_point * half.sin() / half } else { at_point };
        Self { number, at_point, largest, from_held: held[0] }
    }

    fn square(&self) -> f64 {
        self.number * self.number
    }

    /// The mean over a foot, or of its first derivative, at a place from the first edge on.
    fn over_foot(&self, order: usize, from_edge: f64) -> f64 {
        let (sin, cos) = (self.number * from_edge).sin_cos();
        let shape = match (order, self.from_held) {
            (0, true) => sin,
            (0, false) => cos,
            (_, true) => self.number * cos,
            (_, false) => -self.number * sin,
        };
        self.largest * shape
    }

    /// Its moment with the Legendre polynomial $p_n$ that is normalised on a side, about a middle from the first edge on with this half length $h$, or that of
    /// its first derivative: $\int p_ne^{ikx}dx = \sqrt{2(2n+1)h}\,i^nj_n(kh)e^{ikx_0}$.
    fn moment(&self, order: usize, ([middle, half], degree): ([f64; 2], usize)) -> f64 {
        let (sin, cos) = (self.number * middle).sin_cos();
        // Of i^n e^{ikx}, times ik of a derivative.
        let turns = degree + order;
        let [real, imaginary] = match turns % 4 {
            0 => [cos, sin],
            1 => [-sin, cos],
            2 => [-cos, -sin],
            _ => [sin, -cos],
        };
        let shape = if self.from_held { imaginary } else { real };
        let size = (2.0 * (2.0 * degree as f64 + 1.0) * half).sqrt() * spherical_bessel(degree, self.number * half);
        self.at_point * shape * size * if order == 0 { 1.0 } else { self.number }
    }
}

/// $j_n(x)$ for $x \ge 0$.
fn spherical_bessel(degree: usize, x: f64) -> f64 {
    // Upward it is as good as the first two from its degree on, and below that a series converges at once.
    if x < degree as f64 + 1.0 {
        let first: f64 = (1..=degree).map(|n| x / (2.0 * n as f64 + 1.0)).product();
        let (mut term, mut sum) = (first, 0.0);
        for k in 1.. {
            sum += term;
            if term.abs() <= f64::EPSILON * sum.abs() {
                break;
            }
            term *= -0.5 * x * x / (k as f64 * (2.0 * (degree + k) as f64 + 1.0));
        }
        return sum;
    }
    let (sin, cos) = x.sin_cos();
    let (mut before, mut own) = (cos / x, sin / x);
    for n in 0..degree {
        (before, own) = (own, (2.0 * n as f64 + 1.0) / x * own - before);
    }
    own
}

/// Foundation of the membrane at least, beside $A_{55}/h^2$.
const LOOSE: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::legendre::legendre;

    /// Moments of waves, and of their slopes, by a sum over small steps.
    #[test]
    fn val_moments_of_waves_are_those_of_a_sum() {
        let (size, side) = (1.2, [0.47, 0.04]);
        let steps = 20_000_u32;
        for ends in [[End::Free; 2], [End::Clamped; 2], [End::Clamped, End::Free], [End::Free, End::Clamped]] {
            for (m, degree, order) in [(0, 0, 0), (1, 1, 0), (5, 2, 1), (40, 3, 0), (40, 3, 1), (200, 1, 1), (3, 3, 1)]
            {
                let wave = WaveBetween::new(m, size, ends);
                let value = |from_edge: f64| {
                    let (sin, cos) = (wave.number * from_edge).sin_cos();
                    let [shape, slope] = if wave.from_held { [sin, cos] } else { [cos, -sin] };
                    wave.at_point * if order == 0 { shape } else { wave.number * slope }
                };
                let of_step = |step: u32| {
                    let t = 2.0 * (f64::from(step) + 0.5) / f64::from(steps) - 1.0;
                    let polynomial = ((degree as f64 + 0.5) / side[1]).sqrt() * legendre(degree + 1, t)[degree];
                    polynomial * value(side[0] + side[1] * t) * 2.0 * side[1] / f64::from(steps)
                };
                let sum: f64 = (0..steps).map(of_step).sum();
                let moment = wave.moment(order, (side, degree));
                assert!((moment - sum).abs() < 1e-6 * (1.0 + wave.number), "{m} {degree} {order}: {moment} {sum}");
            }
        }
    }
}
