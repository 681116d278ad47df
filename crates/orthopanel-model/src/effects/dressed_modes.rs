//! Natural modes of a panel with effects: real modes of what carries mass and stiffness.

use std::sync::Arc;

use super::dressed_system::{FoundMode, System};
use super::dressing::Dressing;
use super::receptance::modal_base::{ModalBase, Row, SharedStructure};
use super::receptance::view::View;
use super::{Action, CoreModulus, EffectSetting, EffectState, ElementLaw, PointElement, RecordSetting, Seat};
use crate::panel_mode::crossings;
use crate::structure::Motion;
use crate::{BeamTerms, Boundary, Damping, ModelError, Piece, Place, TimoshenkoBeam};

/// Modes of the bare structure beyond those asked for.
const SPARE_MODES: usize = 10;

/// A panel with effects, in coordinates of its bare modes, of the static residual shape under each element, and of each
/// resonator's own mass (Rubin, AIAA J. 13 (1975) 995).
///
/// With $C_0$, $C_1$ the residual flexibility and its next term, stiffness and mass are
/// $\mathrm{diag}(\omega_m^2)\oplus C_0$ and $I\oplus C_1$, and an element at row $r_p = (\phi_m(p), C_{0,p})$ adds
/// $k\,r_pr_p^T$ or $m\,r_pr_p^T$.
pub(crate) struct DressedPanel {
    pub(super) structure: SharedStructure,
    length: f64,
    pub(super) values: Vec<f64>,
    /// Block, coordinates and $\omega^2$ of each bare mode.
    pub(super) bare: Vec<(usize, Vec<f64>, f64)>,
    rigid: usize,
    /// Where the elements sit, and the bare modes' values there.
    rows: Vec<(Row, Vec<f64>)>,
}

/// A mode of a [`DressedPanel`].
#[derive(Clone)]
pub(crate) struct DressedMode {
    panel: Arc<DressedPanel>,
    /// $\omega$ \[rad/s\].
    pub angular_frequency: f64,
    /// Of the diagonal of the damping matrix in these modes.
    pub damping_ratio: f64,
    /// $c_{mn}$ \[1/s\] to all modes in their order: the damping matrix without what is in the ratios.
    pub damping_coupling: Vec<f64>,
    /// Nodes along x.
    pub nodes: usize,
    /// Share of each bare mode, then of each residual shape.
    shares: Vec<f64>,
}

impl std::fmt::Debug for DressedMode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DressedMode").field("angular_frequency", &self.angular_frequency).finish_non_exhaustive()
    }
}

impl DressedPanel {
    /// The rigid modes and `count` flexible ones of a beam with these effects. `damping` belongs to the bare modes.
    pub(crate) fn modes(
        (piece, boundary): (&Piece, Boundary),
        values: &[f64],
        effects: &[EffectState],
        damping: &Damping,
        count: usize,
    ) -> Result<Vec<DressedMode>, ModelError> {
        let setting = EffectSetting { piece: *piece, boundary, suspension: vec![], record: RecordSetting::default() };
        let beam = even_beam(&setting, count)?;
        let (panel, system, found) = Self::solve(&setting, &beam, values, effects, damping, count)?;
        Ok(panel.dressed(&system, found, count))
    }

    /// The modes as they are seen from outside.
    pub(super) fn dressed(self, system: &System, found: Vec<FoundMode>, count: usize) -> Vec<DressedMode> {
        let panel = Arc::new(self);
        let grid = panel.grid(count);
        let couplings = system.couplings(&found);
        let dressed = |((angular_frequency, damping_ratio, mut shares), damping_coupling): (FoundMode, Vec<f64>)| {
            shares.truncate(system.panel);
            let nodes = nodes(&grid, &shares);
            let panel = Arc::clone(&panel);
            DressedMode { panel, angular_frequency, damping_ratio, damping_coupling, nodes, shares }
        };
        found.into_iter().zip(couplings).map(dressed).collect()
    }

    /// The panel, its matrices, and $\omega$, $\zeta$ and coordinates of each mode, where suspension and sensor may be
    /// told; `even` is the beam without any effect.
    fn solve(
        setting: &EffectSetting,
        even: &Arc<TimoshenkoBeam>,
        values: &[f64],
        effects: &[EffectState],
        damping: &Damping,
        count: usize,
    ) -> Result<(Self, System, Vec<FoundMode>), ModelError> {
        let (panel, system, core) = Self::system(setting, even, values, effects, damping, count + SPARE_MODES)?;
        if core.is_some() {
            return Err(ModelError::Unsupported("viscoelastic-core in a model of modes".into()));
        }
        let rigid = panel.rigid();
        let mut found = system.solve()?;
        found.truncate(rigid + count);
        Ok((panel, system, found))
    }

    /// The panel on its first `summed` flexible bare modes, its matrices, and the core that these leave out.
    pub(super) fn system(
        setting: &EffectSetting,
        even: &Arc<TimoshenkoBeam>,
        values: &[f64],
        effects: &[EffectState],
        damping: &Damping,
        summed: usize,
    ) -> Result<(Self, System, Option<CoreModulus>), ModelError> {
        let dressing = Dressing::of(effects, setting, 0)?;
        let beam: SharedStructure = match dressing.terms {
            Some(terms) => {
                Arc::new(TimoshenkoBeam::with_terms(&setting.piece, setting.boundary, basis_terms(summed), terms)?)
            }
            None => Arc::<TimoshenkoBeam>::clone(even),
        };
        let elements = elements(effects, setting)?;
        let base = ModalBase::new(&beam, values, summed, &[], &[])?;
        let rows: Vec<Row> =
            elements.iter().filter_map(|element| Some((element.motion, place(element, setting)?))).collect();
        let view = View::new(&base, &rows, &[])?;
        let bare: Vec<_> = base
            .near
            .iter()
            .filter_map(|&(block, number)| {
                let modes = base.blocks.get(block)?;
                let coordinates = (0..modes.vectors.nrows()).map(|i| modes.vectors[(i, number)]).collect();
                Some((block, coordinates, modes.lambda[number]))
            })
            .collect();
        let at = |row: usize| (0..bare.len()).map(|m| view.numbers[view.layout.shape(m) + row]).collect::<Vec<f64>>();
        let placed = rows.iter().enumerate().map(|(row, place)| (*place, at(row))).collect();
        let system = System::new(&view, &elements, damping);
        let (length, rigid) = (setting.piece.length, base.rigid);
        let panel = Self { structure: beam, length, values: values.to_vec(), bare, rigid, rows: placed };
        Ok((panel, system, dressing.core.map(|(core, _)| core)))
    }

    /// Whether masses, springs or resonators sit on it.
    pub(super) fn has_elements(&self) -> bool {
        !self.rows.is_empty()
    }

    /// How many of the bare modes are rigid.
    pub(super) fn rigid(&self) -> usize {
        self.rigid
    }

    /// The deflections of all coordinates at points along the piece: mode m has about m + 1 nodes, and eight points between
    /// two of them part every pair.
    fn grid(&self, count: usize) -> Vec<Vec<f64>> {
        let points = 8 * (count + 2);
        let place = |index: usize| Place { x: self.length * ((index as f64 + 0.5) / points as f64 - 0.5), y: 0.0 };
        (0..points).map(|index| self.deflections(place(index))).collect()
    }
}

fn nodes(grid: &[Vec<f64>], shares: &[f64]) -> usize {
    let along = grid.iter().map(|row| row.iter().zip(shares).map(|(value, share)| value * share).sum());
    crossings(&along.collect::<Vec<f64>>())
}

fn elements(effects: &[EffectState], setting: &EffectSetting) -> Result<Vec<PointElement>, ModelError> {
    let mut elements = Vec::new();
    for state in effects {
        for action in state.effect.act(&state.values_in(1)?, setting)? {
            if let Action::Element(element) = action {
                elements.push(element);
            }
        }
    }
    Ok(elements)
}

fn basis_terms(summed: usize) -> usize {
    2 * summed + 24
}

pub(super) fn even_beam(setting: &EffectSetting, count: usize) -> Result<Arc<TimoshenkoBeam>, ModelError> {
    let terms = BeamTerms::default();
    Ok(Arc::new(TimoshenkoBeam::with_terms(&setting.piece, setting.boundary, basis_terms(count + SPARE_MODES), terms)?))
}

fn place(element: &PointElement, setting: &EffectSetting) -> Option<Place> {
    match element.seat {
        Seat::At(place) | Seat::Free(place, _) => Some(place),
        Seat::AtResponse => setting.record.response_at,
    }
}

/// The first natural frequencies \[Hz\] of a beam's flexible modes with effects of panel and rig, at any constants: what is
/// the same for all of them is worked out once.
///
/// What the effects ask of a test, they find in the setting: the places of suspension and sensor. Modes are undamped, and
/// those that a suspension makes of rigid motions are left out. What acts on an accelerance alone changes nothing.
#[derive(Debug, Clone)]
pub struct NaturalFrequencies {
    setting: EffectSetting,
    count: usize,
    beam: Arc<TimoshenkoBeam>,
}

impl NaturalFrequencies {
    /// Of the first `count` modes.
    ///
    /// # Errors
    /// As [`TimoshenkoBeam::new`].
    pub fn new(setting: &EffectSetting, count: usize) -> Result<Self, ModelError> {
        Ok(Self { setting: setting.clone(), count, beam: even_beam(setting, count + setting.boundary.rigid_modes())? })
    }

    /// Rising, at the constants $E_x$, $G_{zx}$.
    ///
    /// # Errors
    /// [`ModelError::EffectNeeds`] and [`ModelError::EffectParameter`] where an effect cannot act, [`ModelError::Unsupported`] for
    /// a core that depends on frequency and for a plate, and as [`crate::ritz_modes()`].
    pub fn at(&self, values: &[f64], effects: &[EffectState]) -> Result<Vec<f64>, ModelError> {
        let Self { setting, count, beam } = self;
        let rigid = setting.boundary.rigid_modes();
        let damping = Damping { ratios: vec![], beyond: 0.0 };
        let (panel, _, found) = DressedPanel::solve(setting, beam, values, effects, &damping, count + rigid)?;
        // Without springs and resonators rigid motions stay at zero; else a free beam's have no node and one.
        let stays = |element: &PointElement| matches!(element.law, ElementLaw::Mass { .. });
        let told = rigid == 0 || elements(effects, setting)?.iter().all(stays);
        let grid = if told { vec![] } else { panel.grid(count + rigid) };
        let flexible =
            found.iter().filter(|(omega, _, shares)| *omega > 0.0 && (told || nodes(&grid, shares) >= rigid));
        Ok(flexible.take(*count).map(|(omega, ..)| omega / std::f64::consts::TAU).collect())
    }
}

/// The first `count` natural frequencies \[Hz\], as [`NaturalFrequencies`] finds them.
///
/// # Errors
/// As [`NaturalFrequencies::at`].
pub fn natural_frequencies(
    setting: &EffectSetting,
    values: &[f64],
    effects: &[EffectState],
    count: usize,
) -> Result<Vec<f64>, ModelError> {
    NaturalFrequencies::new(setting, count)?.at(values, effects)
}

impl DressedPanel {
    /// Deflection at a place of each coordinate of the panel: bare modes, then residual shapes.
    fn deflections(&self, place: Place) -> Vec<f64> {
        let rows: Vec<_> =
            (0..self.structure.blocks().len()).map(|block| self.structure.shape_row(block, place)).collect();
        let of_mode = |(block, coordinates, _): &(usize, Vec<f64>, f64)| -> f64 {
            rows.get(*block).map_or(0.0, |row| row.iter().zip(coordinates).map(|(r, c)| r * c).sum())
        };
        let bare: Vec<f64> = self.bare.iter().map(of_mode).collect();
        let residual = |(row, there): &(Row, Vec<f64>)| {
            let whole = self.structure.static_flexibility(&self.values, [(Motion::Deflection, place), *row]);
            let summed = self.bare.iter().zip(&bare).zip(there).filter(|(((_, _, lambda), _), _)| *lambda > 0.0);
            let of_modes: f64 = summed.map(|(((_, _, lambda), a), b)| a * b / lambda).sum();
            whole.map_or(0.0, |whole| whole.value - of_modes)
        };
        let residuals: Vec<f64> = self.rows.iter().map(residual).collect();
        bare.into_iter().chain(residuals).collect()
    }
}

impl DressedMode {
    /// Mass-normalised deflection \[kg^-1/2\] at a place.
    pub(crate) fn deflection(&self, place: Place) -> f64 {
        self.panel.deflections(place).iter().zip(&self.shares).map(|(value, share)| value * share).sum()
    }
}
