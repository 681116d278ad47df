//! What a pressure on the face, a weight and a moving frame do to a panel.
//!
//! A pressure $p$ does the work $p\int w\,dA$. A field of acceleration $g$, and a frame that moves by $r$ with the acceleration
//! $\ddot b$, work by the masses: with the motion $w$ of the panel against its frame and $\psi$ its rotations,
//! $$\Gamma_r(w) = \int\rho t\,w\,r + \tfrac{\rho t^3}{12}(\psi_x\psi_{x,r} + \psi_y\psi_{y,r})\,dA + \sum_jm_jw(x_j)r(x_j),$$
//! so that mode $m$ obeys
//! $$\ddot a_m + 2\zeta_m\omega_m\dot a_m + \omega_m^2a_m = g\,\Gamma_z(W_m) + p\int W_mdA - \sum_r\ddot b_r\Gamma_r(W_m),$$
//! and the panel moves absolutely by $w + \sum_rb_rr$. The frame is pushed by all loads less the rate of all momentum,
//! $$F_r = \sum_kf_k\,r(x_k) + g\,\Gamma_r(z) + p\int r\,dA - \sum_m\Gamma_r(W_m)\ddot a_m - \sum_s\Gamma_r(s)\ddot b_s,$$
//! of which the modes left out lack their own momentum alone: at rest it is exact.
//!
//! The rotations here are slopes, $\psi_x = -w_{,x}$, so that their part is one of the edges alone. What the shear strain adds is
//! below $(t/a)^2$ of the whole.

use crate::effects::{ElementLaw, PointElement, Seat, SpreadEffects, point_elements};
use crate::legendre::gauss_legendre;
use crate::structure::Motion;
use crate::{
    DeflectionRow, EffectSetting, EffectState, MindlinPlate, ModeRange, ModelError, PanelModel, Place, RigidMotion,
    StructureKind,
};

/// Points beyond one a mode: exact to rounding for the shapes of a beam without losses.
const SPARE_POINTS: usize = 24;

/// Places along one direction with their weights \[m\].
type Rule = Vec<(f64, f64)>;

impl PanelModel {
    /// $\int w\,dA$ \[m³\], what a pressure of 1 Pa along +z works by, for motions made of so many flexible modes.
    ///
    /// # Errors
    /// As [`PanelModel::modes`].
    pub fn area_row(&self, flexible: usize) -> Result<DeflectionRow, ModelError> {
        let [along, across] = self.rules(flexible)?;
        let terms = along.iter().flat_map(|&(x, dx)| across.iter().map(move |&(y, dy)| (Place { x, y }, dx * dy)));
        Ok(DeflectionRow { terms: terms.collect(), resonators: vec![] })
    }

    /// $\Gamma_r(w)$ \[kg m or kg m²\], alike; masses of effects count.
    ///
    /// # Errors
    /// As [`PanelModel::modes`], and [`ModelError::Unsupported`] for a resonator on a core that relaxes, whose mass follows no seat.
    pub fn inertia_row(&self, motion: RigidMotion, flexible: usize) -> Result<DeflectionRow, ModelError> {
        let (_, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let [along, across] = self.rules(flexible)?;
        let density = self.piece.mass_per_area;
        let mut row = self.area_row(flexible)?;
        row.terms.iter_mut().for_each(|(place, weight)| *weight *= density * motion.deflection(*place));
        let rotary = density * self.piece.thickness.powi(2) / 12.0 * rotary_factor(&effects, &setting)?;
        let (edge, side) = (0.5 * self.piece.length, 0.5 * self.piece.width);
        match motion {
            RigidMotion::AlongZ => {}
            RigidMotion::AboutX => row.terms.extend(
                along
                    .iter()
                    .flat_map(|&(x, dx)| [(Place { x, y: side }, rotary * dx), (Place { x, y: -side }, -rotary * dx)]),
            ),
            RigidMotion::AboutY => row.terms.extend(
                across
                    .iter()
                    .flat_map(|&(y, dy)| [(Place { x: edge, y }, -rotary * dy), (Place { x: -edge, y }, rotary * dy)]),
            ),
        }
        for PointElement { law, seat, .. } in
            point_elements(&effects, &setting)?.iter().filter(|element| element.motion == Motion::Deflection)
        {
            let seats: Vec<(Place, f64)> = match *seat {
                Seat::AlongEdge { middle: Place { x, .. }, along_x: false } => {
                    across.iter().map(|&(y, dy)| (Place { x, y }, dy / self.piece.width)).collect()
                }
                Seat::AlongEdge { middle: Place { y, .. }, along_x: true } => {
                    along.iter().map(|&(x, dx)| (Place { x, y }, dx / self.piece.length)).collect()
                }
                Seat::At(place) => vec![(place, 1.0)],
                Seat::AtResponse => vec![],
            };
            for (place, share) in seats {
                match *law {
                    ElementLaw::Mass { mass } => row.terms.push((place, share * mass * motion.deflection(place))),
                    ElementLaw::Resonator { .. } if self.relaxes() => {
                        let refused =
                            "a field of acceleration or a moving frame beside a sprung mass and a core that relaxes";
                        return Err(ModelError::Unsupported(refused.into()));
                    }
                    ElementLaw::Resonator { mass, frequency, .. } => {
                        let own = (frequency * std::f64::consts::TAU).powi(2);
                        row.resonators.push((place, share * mass * motion.deflection(place), own));
                    }
                    ElementLaw::Spring { .. } => {}
                }
            }
        }
        Ok(row)
    }

    /// How a frame may move this panel: a beam does not turn about its own axis.
    pub fn rigid_motions(&self) -> &'static [RigidMotion] {
        match self.structure {
            StructureKind::TimoshenkoBeam => &[RigidMotion::AlongZ, RigidMotion::AboutY],
            StructureKind::MindlinPlate => &[RigidMotion::AlongZ, RigidMotion::AboutX, RigidMotion::AboutY],
        }
    }

    /// Along x, and across, where a beam is one strip.
    fn rules(&self, flexible: usize) -> Result<[Rule; 2], ModelError> {
        let flexible = flexible.min(ModeRange::MOST);
        let on = |points: usize, size: f64| -> Rule {
            gauss_legendre(points).iter().map(|&(t, weight)| (0.5 * size * t, 0.5 * size * weight)).collect()
        };
        let (length, width) = (self.piece.length, self.piece.width);
        match self.structure {
            StructureKind::TimoshenkoBeam => Ok([on(flexible + SPARE_POINTS, length), vec![(0.0, width)]]),
            StructureKind::MindlinPlate => {
                let terms =
                    |count| MindlinPlate::terms_for_basis(&self.piece, self.boundary, &self.plate_constants()?, count);
                let [x, y] = match terms(flexible) {
                    Err(ModelError::BasisTooSmall { available, .. }) => terms(available)?,
                    found => found?,
                };
                // Polynomials below twice that degree are integrated exactly; the spare ones serve shapes with kinks.
                Ok([on(x, length), on(y, width)])
            }
        }
    }
}

fn rotary_factor(effects: &[EffectState], setting: &EffectSetting) -> Result<f64, ModelError> {
    Ok(SpreadEffects::of(effects, setting)?.terms.unwrap_or_default().rotary_factor)
}
