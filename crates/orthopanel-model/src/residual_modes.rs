//! Residual attachment modes: what forces at places bend a panel to beyond the modes that are kept, with its own inertia.
//!
//! Under unit forces at places $a$ that swing at a frequency $\sqrt\sigma$ the modes left out, $m > N$, stand as
//! $$\psi_{a\sigma} = \sum_{m>N}\frac{\phi_m\,\phi_m(a)}{\omega_m^2-\sigma}.$$
//! Two of each force are taken: at rest, $\sigma = 0$, and at three quarters of the last frequency kept, where the next modes have begun
//! to answer. They hold nothing of the modes kept. Between two of them mass and stiffness are
//! $$M = \sum_{m>N}\frac{\phi_m(a)\phi_m(b)}{(\omega_m^2-\sigma)(\omega_m^2-\tau)},\qquad
//! K = \sum_{m>N}\frac{\omega_m^2\,\phi_m(a)\phi_m(b)}{(\omega_m^2-\sigma)(\omega_m^2-\tau)}.$$
//! With $KC = MC\Lambda$ and $C^TMC = 1$ the shapes $\psi C$ are mass-normalised modes of the frequencies $\sqrt{\Lambda_k}$, all above those
//! kept. A force at one of the places has its whole static answer in them, at all places; there, and at $\sqrt\sigma$, the accelerance of
//! its own place is exact with its derivative by $\omega^2$. Displacement, velocity and acceleration of the sum are derivatives of each other.
//!
//! References: R. R. Craig and C.-J. Chang, AIAA J. 14 (1976) 1633; R. H. MacNeal, Comput. Struct. 1 (1971) 581; S. Rubin, AIAA J. 13
//! (1975) 995; for the second frequency E. J. Grimme, Krylov projection methods for model reduction (thesis, Illinois 1997), chapter 3.

use faer::Mat;

use crate::dense::{product, symmetric_eigen};
use crate::effects::{FarMode, FarModes};
use crate::{Mode, ModelError, PanelModel, Place, TimeModel};

/// Residual modes to be joined to the modes of a [`TimeModel`].
#[derive(Debug, Clone, PartialEq)]
pub struct Attachments {
    /// Forces at these have their whole static answer.
    pub places: Vec<Place>,
    /// So many modes, whatever the panel; those that it has not are without shape. `None` for as many as these places move apart.
    pub count: Option<usize>,
    /// $\zeta$ of each \[1\].
    pub damping_ratio: f64,
}

impl Attachments {
    /// Of forces on a panel of which so many flexible modes are kept: as many residual modes as there are, damped as the next mode.
    pub fn new(panel: &PanelModel, flexible: usize, forces: &[Place]) -> Self {
        Self { places: forces.to_vec(), count: None, damping_ratio: panel.damping.ratio(flexible + 1) }
    }
}

/// Share of the last frequency kept at which forces are answered once more: of the errors at 0.8 of it and between it and rest, about the
/// same.
const ANSWERED: f64 = 0.75;

/// Share of a shape below which it is made of others.
const DEPENDENT: f64 = 1e-6;

/// Share of $1/(m\omega^4)$, for the panel's mass and the first frequency left out, below which an inertia is rounding: the place does not
/// move, as a clamped end.
const UNMOVED: f64 = 1e-16;

impl PanelModel {
    /// The residual modes of some places beside `flexible` modes that are kept, as seen from these ports: two of each place, less those
    /// that others make. A force at one of the places has its whole static answer in them and the modes kept.
    ///
    /// # Errors
    /// As [`PanelModel::static_flexibility`], and [`ModelError::OffPiece`] for a place off the piece.
    pub fn residual_modes(
        &self,
        flexible: usize,
        attachments: &Attachments,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Vec<Mode>, ModelError> {
        let Attachments { places, count, damping_ratio } = attachments;
        for &place in places {
            self.piece.contains(place)?;
        }
        let ports: Vec<Place> = forces.iter().chain(responses).copied().collect();
        let far = self.far_modes(flexible, places, &ports)?;
        let first = far.modes.first().map_or(1.0, |(omega, _)| *omega);
        let unmoved = UNMOVED / (self.piece.mass() * first.powi(4));
        let mut shapes = Answers::of(&far, [places.len(), ports.len()]).modes(places.len(), unmoved)?;
        // What rounding leaves among the modes kept would be no residue.
        shapes.retain(|(omega, _)| *omega > far.last_kept);
        let count = count.unwrap_or(shapes.len());
        shapes.truncate(count);
        let silent = shapes.last().map_or(2.0 * far.last_kept.max(1.0), |(omega, _)| *omega);
        shapes.resize(count, (silent, vec![0.0; ports.len()]));
        let residual = shapes.into_iter().map(|(angular_frequency, mut at_forces)| Mode {
            angular_frequency,
            damping_ratio: *damping_ratio,
            at_responses: at_forces.split_off(forces.len()),
            at_forces,
        });
        Ok(residual.collect())
    }
}

impl TimeModel {
    /// With [`PanelModel::residual_modes`] behind the others.
    ///
    /// # Errors
    /// As there.
    pub fn with_residual_modes(
        self,
        panel: &PanelModel,
        attachments: &Attachments,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Self, ModelError> {
        let further = panel.residual_modes(self.flexible, attachments, forces, responses)?;
        let (mut modes, residual) = (self.modes, self.residual + further.len());
        modes.join(further);
        Ok(Self { modes: modes.checked()?, residual, ..self })
    }
}

/// The answers to forces of both frequencies, a column each.
struct Answers {
    /// Deflections: a row a place, then a port.
    seen: Mat<f64>,
    stiffness: Mat<f64>,
    mass: Mat<f64>,
}

impl Answers {
    fn of(far: &FarModes, [places, ports]: [usize; 2]) -> Self {
        let shifts = [0.0, (ANSWERED * far.last_kept).powi(2)];
        // Without a mode kept there is but the one at rest.
        let shifts = if shifts[1] > 0.0 { &shifts[..] } else { &shifts[..1] };
        let columns = places * shifts.len();
        let share =
            |(omega, seen): &FarMode, column: usize| seen[column % places] / (omega * omega - shifts[column / places]);
        let sum = |term: &dyn Fn(&FarMode) -> f64| far.modes.iter().map(term).sum::<f64>();
        let at = |row: usize, column: usize| sum(&|mode| mode.1[row] * share(mode, column));
        let stiffness = |a: usize, b: usize| sum(&|mode| mode.0 * mode.0 * share(mode, a) * share(mode, b));
        Self {
            seen: Mat::from_fn(places + ports, columns, at),
            stiffness: Mat::from_fn(columns, columns, stiffness),
            mass: Mat::from_fn(columns, columns, |a, b| sum(&|mode| share(mode, a) * share(mode, b))),
        }
    }

    /// $\sqrt{\Lambda_k}$, rising, and the shapes at the ports.
    fn modes(&self, places: usize, unmoved: f64) -> Result<Vec<FarMode>, ModelError> {
        let Self { seen, stiffness, mass } = self;
        let count = mass.nrows();
        let scale = |i: usize| if mass[(i, i)] > unmoved { mass[(i, i)].sqrt().recip() } else { 0.0 };
        let even = Mat::from_fn(count, count, |i, j| scale(i) * mass[(i, j)] * scale(j));
        let (shares, directions) = symmetric_eigen(&even).ok_or(ModelError::Eigenproblem)?;
        let kept: Vec<usize> = (0..count).filter(|&k| shares[k] > DEPENDENT).collect();
        let base = Mat::from_fn(count, kept.len(), |i, k| scale(i) * directions[(i, kept[k])] / shares[kept[k]].sqrt());
        let reduced = product(base.transpose(), product(stiffness.as_ref(), base.as_ref()).as_ref());
        let even = Mat::from_fn(kept.len(), kept.len(), |i, j| 0.5 * (reduced[(i, j)] + reduced[(j, i)]));
        let (squares, turns) = symmetric_eigen(&even).ok_or(ModelError::Eigenproblem)?;
        let shapes = product(seen.as_ref(), product(base.as_ref(), turns.as_ref()).as_ref());
        let modes = (0..kept.len()).map(|k| {
            let (own, at_ports) = shapes.col_as_slice(k).split_at(places);
            let sense = sense(own);
            (squares[k].max(0.0).sqrt(), at_ports.iter().map(|value| sense * value).collect())
        });
        Ok(modes.collect())
    }
}

/// Up at the first of the places that move at least half as much as any.
fn sense(shape: &[f64]) -> f64 {
    let most = shape.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let first = shape.iter().find(|value| value.abs() >= 0.5 * most);
    first.map_or(1.0, |value| value.signum())
}
