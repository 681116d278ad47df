//! Static shapes of a beam under forces and strains, integrated between joints.

use std::sync::OnceLock;

use super::beam_terms::{BeamTerms, ShearLoss};
use super::exact::BeamMode;
use super::{Section, StaticFlexibility};
use crate::legendre::{gauss_legendre, legendre};
use crate::order::sort;
use crate::structure::Motion;
use crate::{Boundary, End, ModelError, Piece};

/// Points to each stretch between two joints: exact for the products of the shapes of two forces.
const POINTS: usize = 8;
/// A stretch is no longer than this part of the beam, and inside a loss, where modes wave.
const LONGEST: [f64; 2] = [0.125, 1.0 / 12.0];
/// Strains of a loss: these, and so many for a loss over the whole beam, the more the slower its waves are; more than the last would be
/// polynomials that the points do not carry.
const STRAINS: [f64; 3] = [3.0, 24.0, 16.0];

/// A beam that forces bend to static shapes: $M = E_xI\psi'$, $V = k'G_{zx}A\gamma$ in equilibrium with the force and with the reactions of
/// the held ends, for what is free to move with the inertia of the rigid motion; $w' = \gamma-\psi$.
#[derive(Debug)]
pub(crate) struct StaticShapes {
    pub half_length: f64,
    pub section: Section,
    /// $E_xI$ and $k'G_{zx}A$.
    pub stiffness: [f64; 2],
    boundary: Boundary,
    flexibility: StaticFlexibility,
    /// What a shape has no share of.
    rigid: Vec<BeamMode>,
}

/// The beam in stretches between joints.
pub(crate) struct Grid {
    /// Where each stretch begins, and the beam's end.
    joints: Vec<f64>,
    /// Place and weight of each point, [`POINTS`] to a stretch.
    pub points: Vec<(f64, f64)>,
}

/// A static shape at the points of a grid.
#[derive(Default)]
pub(crate) struct StaticShape {
    pub deflection: Vec<f64>,
    pub rotation: Vec<f64>,
    pub curvature: Vec<f64>,
    pub strain: Vec<f64>,
    /// Deflection, rotation and strain at each joint, where the strain steps, its middle.
    at_joints: Vec<[f64; 3]>,
}

/// A shear strain along a span: numbers of the span's points, and the values there.
pub(crate) type Strain = Vec<(usize, f64)>;

/// Moment and shear force at the points of a grid.
type Forces = Vec<[f64; 2]>;

/// [`StaticShapes`] on a grid.
pub(crate) struct OnGrid<'a> {
    of: &'a StaticShapes,
    grid: &'a Grid,
    /// Moment and shear force that need no load, orthogonal in complementary energy.
    self_stresses: Vec<Forces>,
}

impl StaticShapes {
    /// With this factor on the rotary inertia; `rigid` are its rigid modes.
    ///
    /// # Errors
    /// As [`StaticFlexibility::new`].
    pub(crate) fn new(
        (piece, boundary): (&Piece, Boundary),
        [e_x, g_zx]: [f64; 2],
        terms: &BeamTerms,
        rigid: &[BeamMode],
    ) -> Result<Self, ModelError> {
        let mut section = Section::of(piece);
        section.rotary_inertia *= terms.rotary_factor;
        Ok(Self {
            half_length: 0.5 * piece.length,
            section,
            stiffness: [e_x * section.second_moment, g_zx * section.shear_area],
            boundary,
            flexibility: StaticFlexibility::with_terms(piece, boundary, terms)?,
            rigid: rigid.to_vec(),
        })
    }

    /// From end to end, with a joint at each of these places and where a loss begins or ends.
    pub(crate) fn grid(&self, places: impl Iterator<Item = f64>, losses: &[ShearLoss]) -> Grid {
        let h = self.half_length;
        let mut places: Vec<f64> = places.chain(losses.iter().flat_map(|loss| loss.edges(h))).chain([-h, h]).collect();
        sort(&mut places);
        places.dedup();
        let mut joints = Vec::new();
        for pair in places.windows(2) {
            let length = pair[1] - pair[0];
            let in_loss = losses.iter().any(|loss| loss.holds(0.5 * (pair[0] + pair[1]), h));
            let parts =
                (length / (LONGEST[usize::from(in_loss)] * 2.0 * h)).ceil().max(if in_loss { 2.0 } else { 1.0 });
            joints.extend((0..parts as usize).map(|part| pair[0] + length * part as f64 / parts));
        }
        joints.push(h);
        let rule = rule();
        let points = joints.windows(2).flat_map(|pair| {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            (0..POINTS).map(move |i| (middle + half * rule.points[i], half * rule.weights[i]))
        });
        let points = points.collect();
        Grid { joints, points }
    }

    pub(crate) fn on<'a>(&'a self, grid: &'a Grid) -> OnGrid<'a> {
        let mut on = OnGrid { of: self, grid, self_stresses: vec![] };
        for state in self.flexibility.self_stresses() {
            let forces = grid.points.iter().map(|point| state.at(point.0)).collect();
            let forces = on.with_redundants(forces);
            on.self_stresses.push(forces);
        }
        on
    }

    /// $P_k$ over the span of a loss.
    pub(crate) fn strains(&self, loss: &ShearLoss, grid: &Grid) -> Vec<Strain> {
        let [low, high] = loss.edges(self.half_length);
        let part = (high - low) / (2.0 * self.half_length);
        let count =
            (STRAINS[0] + STRAINS[1] * part / (1.0 - loss.loss).min(1.0).sqrt()).ceil().min(STRAINS[2]) as usize;
        let mut strains = vec![vec![]; count];
        for (number, (x, _)) in grid.points.iter().enumerate().filter(|(_, point)| point.0 > low && point.0 < high) {
            let values = legendre(count, (2.0 * x - low - high) / (high - low));
            strains.iter_mut().zip(values).for_each(|(strain, value)| strain.push((number, value)));
        }
        strains.retain(|strain| !strain.is_empty());
        strains
    }
}

impl OnGrid<'_> {
    /// Under a unit force or couple on a deflection or a rotation at $x$.
    pub(crate) fn under(&self, (motion, x): (Motion, f64)) -> StaticShape {
        let field = self.of.flexibility.loaded(motion, x);
        self.shape(self.grid.points.iter().map(|point| field.at(point.0)).collect())
    }

    /// Under what strains a span so much, over $k'G_{zx}A$.
    pub(crate) fn strained(&self, strain: &Strain) -> StaticShape {
        let mut forces = vec![[0.0; 2]; self.grid.points.len()];
        strain.iter().for_each(|&(point, value)| forces[point][1] = value);
        self.shape(forces)
    }

    /// Under the forces $\rho Aw$ and couples $\rho I\psi$ of a shape: $V' = -\rho Aw$, $M' = V-\rho I\psi$.
    pub(crate) fn under_inertia(&self, shape: &StaticShape) -> StaticShape {
        let grid = self.grid;
        let Section { mass, rotary_inertia, .. } = self.of.section;
        let (mut forces, [mut moment, mut shear]) = (vec![[0.0; 2]; grid.points.len()], [0.0; 2]);
        let rule = rule();
        for (number, joints) in grid.joints.windows(2).enumerate() {
            let (first, half) = (number * POINTS, 0.5 * (joints[1] - joints[0]));
            let fallen = rule.integrals(|i| -mass * shape.deflection[first + i]);
            (0..POINTS).for_each(|i| forces[first + i][1] = shear + half * fallen[i]);
            let turned = rule.integrals(|i| forces[first + i][1] - rotary_inertia * shape.rotation[first + i]);
            (0..POINTS).for_each(|i| forces[first + i][0] = moment + half * turned[i]);
            (moment, shear) = (moment + half * turned[POINTS], shear + half * fallen[POINTS]);
        }
        // Reactions M = c + d (x + h), V = d at the left end, as far as equilibrium asks for them.
        let length = 2.0 * self.of.half_length;
        let (c, d) = match (self.of.boundary.left, self.of.boundary.right) {
            (End::Free, _) | (End::Pinned, End::Free) | (End::Clamped, End::Clamped) => {
                (0.0, if self.of.boundary.left == End::Pinned { -shear } else { 0.0 })
            }
            (End::Pinned, _) => (0.0, -moment / length),
            (End::Clamped, End::Pinned) => (-moment, 0.0),
            (End::Clamped, End::Free) => (length * shear - moment, -shear),
        };
        for (own, point) in forces.iter_mut().zip(&grid.points) {
            *own = [own[0] + c + d * (point.0 + self.of.half_length), own[1] + d];
        }
        self.shape(forces)
    }

    /// From moment and shear force to rotation and deflection.
    fn shape(&self, forces: Forces) -> StaticShape {
        let (grid, forces) = (self.grid, self.with_redundants(forces));
        let [bending, shear] = self.of.stiffness;
        let curvature: Vec<f64> = forces.iter().map(|forces| forces[0] / bending).collect();
        let strain: Vec<f64> = forces.iter().map(|forces| forces[1] / shear).collect();
        let (mut rotation, mut deflection) = (vec![0.0; strain.len()], vec![0.0; strain.len()]);
        let mut at_joints = vec![[0.0; 3]];
        let [mut w, mut psi] = [0.0; 2];
        let rule = rule();
        for (number, joints) in grid.joints.windows(2).enumerate() {
            let (first, half) = (number * POINTS, 0.5 * (joints[1] - joints[0]));
            let turned = rule.integrals(|i| curvature[first + i]);
            (0..POINTS).for_each(|i| rotation[first + i] = psi + half * turned[i]);
            let risen = rule.integrals(|i| strain[first + i] - rotation[first + i]);
            (0..POINTS).for_each(|i| deflection[first + i] = w + half * risen[i]);
            (w, psi) = (w + half * risen[POINTS], psi + half * turned[POINTS]);
            // Half of what each side brings, at an end of the beam all of it.
            let [before, after] = rule.at_ends(|i| strain[first + i]);
            at_joints[number][2] += if number == 0 { before } else { 0.5 * before };
            at_joints.push([w, psi, if number + 2 == grid.joints.len() { after } else { 0.5 * after }]);
        }
        let mut shape = StaticShape { deflection, rotation, curvature, strain, at_joints };
        self.settle(&mut shape);
        shape
    }

    /// Adds the rigid motion $w = \alpha+\beta x$, $\psi = -\beta$ that the ends ask for; what is free to move has no share of its rigid modes.
    fn settle(&self, shape: &mut StaticShape) {
        let grid = self.grid;
        let mut conditions: Vec<[f64; 3]> = Vec::new();
        let ends = [(self.of.boundary.left, 0), (self.of.boundary.right, grid.joints.len() - 1)];
        for (end, joint) in ends {
            let [w, psi, _] = shape.at_joints[joint];
            if end != End::Free {
                conditions.push([1.0, grid.joints[joint], -w]);
            }
            if end == End::Clamped {
                conditions.push([0.0, -1.0, -psi]);
            }
        }
        let Section { mass, rotary_inertia, .. } = self.of.section;
        for mode in &self.of.rigid {
            let mut sums = [0.0; 3];
            for (number, &(x, weight)) in grid.points.iter().enumerate() {
                let [w, psi] = [weight * mass * mode.deflection(x), weight * rotary_inertia * mode.rotation(x)];
                sums[0] += w;
                sums[1] += w * x - psi;
                sums[2] -= w * shape.deflection[number] + psi * shape.rotation[number];
            }
            conditions.push(sums);
        }
        let &[a, b, ..] = &conditions[..] else { return };
        let determinant = a[0] * b[1] - a[1] * b[0];
        let alpha = (a[2] * b[1] - a[1] * b[2]) / determinant;
        let beta = (a[0] * b[2] - a[2] * b[0]) / determinant;
        for (number, (x, _)) in grid.points.iter().enumerate() {
            shape.deflection[number] += alpha + beta * x;
            shape.rotation[number] -= beta;
        }
        for (at, x) in shape.at_joints.iter_mut().zip(&grid.joints) {
            at[0] += alpha + beta * x;
            at[1] -= beta;
        }
    }

    /// With the redundant reactions of least complementary energy.
    fn with_redundants(&self, mut forces: Forces) -> Forces {
        let [bending, shear] = self.of.stiffness;
        let energy = |a: &Forces, b: &Forces| -> f64 {
            let density = |(a, b): (&[f64; 2], &[f64; 2])| a[0] * b[0] / bending + a[1] * b[1] / shear;
            self.grid.points.iter().zip(a.iter().zip(b)).map(|(point, pair)| point.1 * density(pair)).sum()
        };
        for state in &self.self_stresses {
            let share = energy(&forces, state) / energy(state, state);
            forces
                .iter_mut()
                .zip(state)
                .for_each(|(own, state)| *own = [own[0] - share * state[0], own[1] - share * state[1]]);
        }
        forces
    }
}

impl StaticShape {
    /// Less so much of a mode, at the points alone.
    pub(crate) fn take(&mut self, share: f64, [deflection, rotation, curvature, strain]: &[Vec<f64>; 4]) {
        let fields = [
            (&mut self.deflection, deflection),
            (&mut self.rotation, rotation),
            (&mut self.curvature, curvature),
            (&mut self.strain, strain),
        ];
        for (own, mode) in fields {
            own.iter_mut().zip(mode).for_each(|(own, mode)| *own -= share * mode);
        }
    }
}

impl Grid {
    /// What a row sees of a shape; its place is a joint.
    pub(crate) fn seen(&self, shape: &StaticShape, (motion, x): (Motion, f64)) -> f64 {
        let joint = self
            .joints
            .binary_search_by(|joint| joint.total_cmp(&x))
            .unwrap_or_else(|next| next.min(self.joints.len() - 1));
        let [w, psi, strain] = shape.at_joints[joint];
        match motion {
            Motion::Deflection | Motion::Foot => w,
            Motion::Slope => strain - psi,
            Motion::Rotation => psi,
            Motion::Curvature | Motion::SlopeAcross | Motion::Shear(_) => 0.0,
        }
    }
}

/// Gauss' rule on $[-1, 1]$, with the integrals from $-1$ and the ends of the polynomial through its points.
struct Rule {
    points: [f64; POINTS],
    weights: [f64; POINTS],
    /// To each point, and to 1.
    integrals: [[f64; POINTS]; POINTS + 1],
    ends: [[f64; POINTS]; 2],
}

impl Rule {
    fn integrals(&self, values: impl Fn(usize) -> f64) -> [f64; POINTS + 1] {
        let values: [f64; POINTS] = std::array::from_fn(values);
        self.integrals.map(|row| row.iter().zip(&values).map(|(a, b)| a * b).sum())
    }

    fn at_ends(&self, values: impl Fn(usize) -> f64) -> [f64; 2] {
        let values: [f64; POINTS] = std::array::from_fn(values);
        self.ends.map(|row| row.iter().zip(&values).map(|(a, b)| a * b).sum())
    }
}

fn rule() -> &'static Rule {
    static RULE: OnceLock<Rule> = OnceLock::new();
    RULE.get_or_init(|| {
        let gauss = gauss_legendre(POINTS);
        let at: [f64; POINTS] = std::array::from_fn(|i| gauss[i].0);
        let weights: [f64; POINTS] = std::array::from_fn(|i| gauss[i].1);
        let polynomials = at.map(|t| legendre(POINTS, t));
        // The polynomial that is one at point j: w_j sum (2n + 1)/2 P_n(t_j) P_n(t).
        let share = |j: usize, n: usize| weights[j] * (n as f64 + 0.5) * polynomials[j][n];
        let through =
            |values: &dyn Fn(usize) -> f64, j: usize| (0..POINTS).map(|n| share(j, n) * values(n)).sum::<f64>();
        let integral = |t: f64| {
            let values = legendre(POINTS + 1, t);
            move |n: usize| if n == 0 { t + 1.0 } else { (values[n + 1] - values[n - 1]) / (2 * n + 1) as f64 }
        };
        let integrals = std::array::from_fn(|i| {
            let integral = integral(if i < POINTS { at[i] } else { 1.0 });
            std::array::from_fn(|j| through(&integral, j))
        });
        let ends = [-1.0, 1.0].map(|end: f64| std::array::from_fn(|j| through(&|n| end.powi(n as i32), j)));
        Rule { points: at, weights, integrals, ends }
    })
}
