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
use std::sync::Arc;

use faer::Mat;

use super::edge_basis::EdgeBasis;
use super::foot::{FOOT, mean_over_foot};
use super::membrane::{AXES, Membrane, Modes, Seen, Stiffnesses, compliance, resistances, shear_along};
use super::wave::WaveBetween;
use crate::End;
use crate::dense::product;
use crate::structure::Motion;

/// $k^2$ \[1/m2\] of a wave along one direction, and the square of its value at a place.
type Wave = (f64, f64);

/// A place along one direction with the order of the derivative that is asked there.
type Side = (usize, f64);

impl Membrane {
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

    /// Sign of the wave that comes back from either end along an axis: of a free one as it came, of a held one turned round.
    fn returned(&self, axis: usize) -> [f64; 2] {
        self.edges()[axis].map(|end| if end == End::Free { 1.0 } else { -1.0 })
    }
}

fn is_one_foot(first: (Motion, crate::Place), second: (Motion, crate::Place)) -> bool {
    first == second && first.0 == Motion::Foot
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

/// Powers of $\omega^2$ to which the waves that a basis lacks answer.
pub(super) const INERTIAL: usize = 3;

/// Waves along either side, over the functions that a basis has: what they answer with falls with the fourth power of theirs.
const WAVES: usize = 8;

/// What decays further than by this power of $e$ is left out.
const NEGLIGIBLE: f64 = 20.0;
