//! What a basis lacks of the answer to moments of shear strain over a square, of which the shear stiffness that a patch lost is made.

use std::sync::Arc;

use faer::Mat;

use super::edge_basis::EdgeBasis;
use super::field::Field;
use super::membrane::{AXES, Membrane, Seen, Stiffnesses, resistances, shear_along};
use super::wave::WaveBetween;
use crate::structure::{Motion, ShearMoment};

/// The square of a moment of shear strain: of either side, from the first edge of the plate on, its middle and half its length.
struct Square {
    moment: ShearMoment,
    sides: [[f64; 2]; 2],
}

impl Membrane {
    /// What the basis lacks of the static flexibility where one of two motions is a moment of shear strain; `None` where none is: of the waves that it lacks
    /// [`strain_compliance`] between their moments $q = \int p\,\partial w$. Of two of one square the sum falls off as $1/k$: that of the shortest waves is one
    /// along the strain alone, for functions across are complete, and from the finest on $q$ is what the polynomials are at the edges.
    pub(super) fn under_moments(
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
