//! Natural modes of a panel with effects: real modes of what carries mass and stiffness.

use std::sync::Arc;

use super::coupled_panel::{CoupledPanel, Even, PanelWithEffects, elements, nodes};
use super::coupled_system::{FoundMode, System};
use super::{EffectSetting, EffectState, ElementLaw, PointElement, RecordSetting};
use crate::{Boundary, Damping, ModeName, ModelError, Piece, Place};

/// A mode of a [`CoupledPanel`].
#[derive(Clone)]
pub(crate) struct CoupledMode {
    panel: Arc<CoupledPanel>,
    /// $\omega$ \[rad/s\].
    pub angular_frequency: f64,
    /// Of the diagonal of the damping matrix in these modes.
    pub damping_ratio: f64,
    /// $c_{mn}$ \[1/s\] to all modes in their order: the damping matrix without what is in the ratios.
    pub damping_coupling: Vec<f64>,
    /// Share of each bare mode, then of each residual shape.
    shares: Vec<f64>,
    /// How many modes were asked for.
    count: usize,
}

impl std::fmt::Debug for CoupledMode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CoupledMode").field("angular_frequency", &self.angular_frequency).finish_non_exhaustive()
    }
}

impl CoupledPanel {
    /// The rigid modes and `count` flexible ones of a panel with effects.
    pub(crate) fn modes(parts: PanelWithEffects, count: usize) -> Result<Vec<CoupledMode>, ModelError> {
        let (panel, system, found) = Self::solve(parts, count)?;
        Ok(panel.modified(&system, found, count))
    }

    /// The modes as they are seen from outside.
    pub(super) fn modified(self, system: &System, found: Vec<FoundMode>, count: usize) -> Vec<CoupledMode> {
        let panel = Arc::new(self);
        let couplings = system.couplings(&found);
        let modified = |((angular_frequency, damping_ratio, mut shares), damping_coupling): (FoundMode, Vec<f64>)| {
            shares.truncate(system.panel);
            CoupledMode { panel: Arc::clone(&panel), angular_frequency, damping_ratio, damping_coupling, shares, count }
        };
        found.into_iter().zip(couplings).map(modified).collect()
    }
}

impl EffectSetting {
    /// Of a panel by itself.
    pub(crate) fn of_panel(piece: &Piece, boundary: Boundary) -> Self {
        Self { piece: *piece, boundary, suspension: vec![], record: RecordSetting::default() }
    }
}

impl CoupledMode {
    /// Mass-normalised deflection \[kg^-1/2\] at a place.
    pub(crate) fn deflection(&self, place: Place) -> f64 {
        self.in_basis(&self.basis_at(place))
    }

    /// What its panel's coordinates do at a place.
    pub(crate) fn basis_at(&self, place: Place) -> Vec<f64> {
        self.panel.deflections(place)
    }

    /// Its deflection where its panel's coordinates do this.
    pub(crate) fn in_basis(&self, basis: &[f64]) -> f64 {
        basis.iter().zip(&self.shares).map(|(value, share)| value * share).sum()
    }

    /// Whether it is written in the same coordinates.
    pub(crate) fn is_beside(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.panel, &other.panel)
    }

    /// Nodes along x and along y.
    pub(crate) fn nodes(&self) -> [usize; 2] {
        match self.name() {
            Some(name) => name.nodes,
            None => [self.panel.nodes(&self.shares, self.count), 0],
        }
    }

    /// Of a plate's mode.
    pub(crate) fn name(&self) -> Option<ModeName> {
        self.panel.name(&self.shares)
    }
}

/// The first `count` natural frequencies \[Hz\] of a beam's flexible modes with effects of panel and rig, at the constants $E_x$,
/// $G_{zx}$, rising.
///
/// What the effects ask of a test, they find in the setting: the places of suspension and sensor. Modes are undamped, and
/// those that a suspension makes of rigid motions are left out. What acts on an accelerance alone changes nothing.
///
/// # Errors
/// [`ModelError::EffectNeeds`] and [`ModelError::EffectParameter`] where an effect cannot act, [`ModelError::Unsupported`] for
/// a core that depends on frequency and for a plate, and as [`TimoshenkoBeam::new`](crate::TimoshenkoBeam::new) and
/// [`crate::ritz_modes()`].
pub fn natural_frequencies(
    setting: &EffectSetting,
    values: &[f64],
    effects: &[EffectState],
    count: usize,
) -> Result<Vec<f64>, ModelError> {
    let rigid = setting.boundary.rigid_modes();
    let beam = Even::beam(setting, count + rigid)?;
    let damping = Damping::default();
    let parts = PanelWithEffects { setting, even: &beam, values, effects, damping: &damping };
    let (panel, _, found) = CoupledPanel::solve(parts, count + rigid)?;
    // Without springs and resonators rigid motions stay at zero; else a free beam's have no node and one. A resonator's own mode
    // may have no more of these: the lowest are the rigid ones.
    let stays = |element: &PointElement| matches!(element.law, ElementLaw::Mass { .. });
    let told = rigid == 0 || elements(effects, setting)?.iter().all(stays);
    let grid = if told { vec![] } else { panel.grid(count + rigid) };
    let mut left = if told { 0 } else { rigid };
    let mut is_flexible = |omega: f64, shares: &_| {
        let is_rigid = left > 0 && (omega <= 0.0 || nodes(&grid, shares) < rigid);
        left -= usize::from(is_rigid);
        omega > 0.0 && !is_rigid
    };
    let flexible = found.iter().filter(|(omega, _, shares)| is_flexible(*omega, shares));
    Ok(flexible.take(count).map(|(omega, ..)| omega / std::f64::consts::TAU).collect())
}
