//! The exact solution of the beam (eqs 8 to 11), below and above the cut-off (9), none missed.

mod end_conditions;
mod pinned_spectrum;
mod search;
mod shape;
mod waves;

use std::iter::Peekable;

use end_conditions::{Family, families, probe};
use search::ModeSearch;
use shape::WaveShape;
use waves::{DEFLECTION, ROTATION, Ratios};

use super::{BeamConstants, Section};
use crate::{Boundary, End, ModelError, Motion, Piece};

/// A beam with given constants and ends, solved exactly.
///
/// Natural frequencies are the roots of eq. 11 and of its like for pinned and clamped ends. Each is bracketed by a
/// Wittrick-Williams count, so none is missed, however close two lie. Reference: Wittrick and Williams, Q. J. Mech.
/// Appl. Math. 24 (1971) 263.
///
/// Limits: slenderness $a/t$ from 3 to 1000 and $E_x/(k'G_{zx})$ from 1 to 1000 are tested, over 100 modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactBeam {
    piece: Piece,
    section: Section,
    boundary: Boundary,
    ratios: Ratios,
    /// $EI/(\rho A a^4)$ \[1/s²\]: $\omega^2$ over $\mu$.
    omega2_per_mu: f64,
}

impl ExactBeam {
    /// A beam of the piece's length, section and mass.
    ///
    /// # Errors
    /// [`ModelError::Size`] or [`ModelError::Constant`] where a number has no physical meaning, [`ModelError::HeldSide`]
    /// where front or back is held.
    pub fn new(piece: &Piece, boundary: Boundary, constants: BeamConstants) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let boundary = boundary.of_beam()?;
        let BeamConstants { e_x, g_zx } = constants.checked()?;
        let section = Section::of(&piece);
        let a2 = piece.length * piece.length;
        let bending = e_x * section.second_moment;
        let ratios =
            Ratios { r2: section.rotary_inertia / (section.mass * a2), s2: bending / (g_zx * section.shear_area * a2) };
        Ok(Self { piece, section, boundary, ratios, omega2_per_mu: bending / (section.mass * a2 * a2) })
    }

    /// With a rotary inertia $\rho I$ of so many times that of evenly spread mass.
    pub(crate) fn with_rotary_factor(mut self, factor: f64) -> Self {
        self.section.rotary_inertia *= factor;
        self.ratios.r2 *= factor;
        self
    }

    /// The rigid modes, then the first `count` flexible ones in rising order.
    pub fn modes(&self, count: usize) -> Vec<BeamMode> {
        self.rigid_modes().into_iter().chain(self.flexible_modes().take(count)).collect()
    }

    /// The flexible modes in rising order, without end; each is found when asked for.
    pub fn flexible_modes(&self) -> impl Iterator<Item = BeamMode> + '_ {
        self.eigenvalues().map(|(family, mu)| self.mode(family, mu))
    }

    /// Frequencies \[Hz\] of the first `count` flexible modes, without their shapes.
    pub fn natural_frequencies(&self, count: usize) -> Vec<f64> {
        self.eigenvalues().take(count).map(|(_, mu)| self.angular_frequency(mu) / std::f64::consts::TAU).collect()
    }

    /// Number of modes below `frequency` \[Hz\], rigid ones included; by the count alone, without a search.
    pub fn count_below(&self, frequency: f64) -> usize {
        let omega = frequency * std::f64::consts::TAU;
        let mu = omega * omega / self.omega2_per_mu;
        if mu > 0.0 {
            families(self.boundary).iter().map(|&family| probe(self.ratios, self.boundary, family, mu).below).sum()
        } else {
            0
        }
    }

    /// Frequency \[Hz\] above which both waves travel (eq. 9): $\omega^2 = k'G_{zx}A/(\rho I)$.
    pub fn cut_off(&self) -> f64 {
        let mu = 1.0 / (self.ratios.r2 * self.ratios.s2);
        self.angular_frequency(mu) / std::f64::consts::TAU
    }

    /// The rigid modes: translation, then rotation about the centre; rotation about the pin where one end is pinned.
    pub fn rigid_modes(&self) -> Vec<BeamMode> {
        let half = 0.5 * self.piece.length;
        let turning = |pivot: f64| RigidShape { at_centre: -pivot, slope: -1.0 };
        let shapes = match (self.boundary.left, self.boundary.right) {
            (End::Free, End::Free) => vec![RigidShape { at_centre: 1.0, slope: 0.0 }, turning(0.0)],
            (End::Free, End::Pinned) => vec![turning(half)],
            (End::Pinned, End::Free) => vec![turning(-half)],
            _ => vec![],
        };
        shapes
            .into_iter()
            .map(|RigidShape { at_centre, slope }| {
                let Section { mass, rotary_inertia, .. } = self.section;
                let a = self.piece.length;
                let (w2, psi2) = (a * (at_centre * at_centre + slope * slope * a * a / 12.0), a * slope * slope);
                let scale = 1.0 / (mass * w2 + rotary_inertia * psi2).sqrt();
                let shape = RigidShape { at_centre: scale * at_centre, slope: scale * slope };
                BeamMode { angular_frequency: 0.0, sensitivity: [0.0; 2], shape: Shape::Rigid(shape) }
            })
            .collect()
    }

    fn angular_frequency(&self, mu: f64) -> f64 {
        (mu * self.omega2_per_mu).sqrt()
    }

    fn eigenvalues(&self) -> impl Iterator<Item = (Family, f64)> + '_ {
        let mut searches: Vec<(Family, Peekable<ModeSearch>)> = families(self.boundary)
            .iter()
            .map(|&family| (family, ModeSearch::new(self.ratios, self.boundary, family).peekable()))
            .collect();
        std::iter::from_fn(move || {
            let mut lowest: Option<(usize, f64)> = None;
            for (index, (_, search)) in searches.iter_mut().enumerate() {
                let mu = *search.peek()?;
                if lowest.is_none_or(|(_, least)| mu < least) {
                    lowest = Some((index, mu));
                }
            }
            let (index, mu) = lowest?;
            searches[index].1.next();
            Some((searches[index].0, mu))
        })
    }

    fn mode(&self, family: Family, mu: f64) -> BeamMode {
        let a = self.piece.length;
        let shape = WaveShape::of_mode(self.ratios, self.boundary, family, mu);
        let integrals = shape.integrals();
        // Eq. 18 in units of a: ρA a³ ∫(w̄² + r²ψ²) dξ = 1.
        let mass = self.section.mass * a.powi(3) * (integrals.deflection + self.ratios.r2 * integrals.rotation);
        let sensitivity = [
            self.section.second_moment / a * integrals.moment / mass,
            self.section.shear_area * a * integrals.shear / mass,
        ];
        // The sign is free; the right end goes up, or turns up where it is held.
        let field = shape.field(0.5);
        let upward =
            if field[DEFLECTION].abs() > 1e-9 * field[ROTATION].abs() { field[DEFLECTION] } else { -field[ROTATION] };
        let scale = mass.sqrt().recip().copysign(upward);
        BeamMode {
            angular_frequency: self.angular_frequency(mu),
            sensitivity,
            shape: Shape::Waves { shape: shape.scaled(scale), length: a },
        }
    }
}

/// One mode of an [`ExactBeam`], mass-normalised (eq. 18).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamMode {
    angular_frequency: f64,
    sensitivity: [f64; 2],
    shape: Shape,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Rigid(RigidShape),
    Waves { shape: WaveShape, length: f64 },
}

/// $w = w_0 - \psi x$ with $\psi$ constant, hence without shear.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RigidShape {
    at_centre: f64,
    slope: f64,
}

impl BeamMode {
    /// $\omega$ \[rad/s\]; zero for a rigid mode.
    pub fn angular_frequency(&self) -> f64 {
        self.angular_frequency
    }

    /// Natural frequency \[Hz\].
    pub fn frequency(&self) -> f64 {
        self.angular_frequency / std::f64::consts::TAU
    }

    /// $\partial\omega^2/\partial E_x$ and $\partial\omega^2/\partial G_{zx}$ \[1/(s² Pa)\], exact:
    /// $I\int\psi'^2dx$ and $k'A\int(w'+\psi)^2dx$. Their products with the constants add up to $\omega^2$.
    pub fn sensitivity(&self) -> [f64; 2] {
        self.sensitivity
    }

    /// Deflection $W(x)$ \[kg^-1/2\] at $x$ from the centre \[m\].
    pub fn deflection(&self, x: f64) -> f64 {
        match self.shape {
            Shape::Rigid(RigidShape { at_centre, slope }) => at_centre - slope * x,
            Shape::Waves { shape, length } => length * shape.field(x / length)[DEFLECTION],
        }
    }

    /// Deflection, rotation, curvature $\Psi'$ and shear strain at $x$ from the centre \[m\].
    pub(crate) fn field(&self, x: f64) -> [f64; 4] {
        match self.shape {
            Shape::Rigid(RigidShape { at_centre, slope }) => [at_centre - slope * x, slope, 0.0, 0.0],
            Shape::Waves { shape, length } => {
                let [deflection, rotation, moment, strain] = shape.field(x / length);
                [length * deflection, rotation, moment / length, strain]
            }
        }
    }

    /// What a motion at $x$ sees of it.
    pub(crate) fn motion(&self, (motion, x): (Motion, f64)) -> f64 {
        let [deflection, rotation, curvature, strain] = self.field(x);
        match motion {
            Motion::Deflection | Motion::Foot => deflection,
            Motion::Slope => strain - rotation,
            Motion::Rotation => rotation,
            Motion::Curvature => curvature,
            Motion::SlopeAcross | Motion::Shear(_) => 0.0,
        }
    }

    /// Rotation $\Psi(x)$ \[kg^-1/2 m^-1\] at $x$ from the centre \[m\].
    pub fn rotation(&self, x: f64) -> f64 {
        match self.shape {
            Shape::Rigid(RigidShape { slope, .. }) => slope,
            Shape::Waves { shape, length } => shape.field(x / length)[ROTATION],
        }
    }
}
