//! Natural modes of a panel with effects: real modes of what carries mass and stiffness.

use std::sync::Arc;

use faer::Mat;

use super::dressing::Dressing;
use super::receptance::modal_base::{ModalBase, Row, SharedStructure};
use super::receptance::view::View;
use super::{Action, EffectSetting, EffectState, ElementLaw, PointElement, RecordSetting, Seat};
use crate::dense::{Cholesky, symmetric_eigen};
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
    structure: SharedStructure,
    values: Vec<f64>,
    /// Block, coordinates and $\omega^2$ of each bare mode.
    bare: Vec<(usize, Vec<f64>, f64)>,
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
        let panel = Arc::new(panel);
        let grid = panel.grid(piece, count);
        let couplings = system.couplings(&found);
        let dressed = |((angular_frequency, damping_ratio, mut shares), damping_coupling): (FoundMode, Vec<f64>)| {
            shares.truncate(system.panel);
            let nodes = nodes(&grid, &shares);
            let panel = Arc::clone(&panel);
            DressedMode { panel, angular_frequency, damping_ratio, damping_coupling, nodes, shares }
        };
        Ok(found.into_iter().zip(couplings).map(dressed).collect())
    }

    /// The panel, its matrices, and $\omega$, $\zeta$ and coordinates of each mode, where suspension and sensor may be told; `even` is the beam
    /// without any effect.
    fn solve(
        setting: &EffectSetting,
        even: &Arc<TimoshenkoBeam>,
        values: &[f64],
        effects: &[EffectState],
        damping: &Damping,
        count: usize,
    ) -> Result<(Self, System, Vec<FoundMode>), ModelError> {
        let dressing = Dressing::of(effects, setting, 0)?;
        if dressing.core.is_some() {
            return Err(ModelError::Unsupported("viscoelastic-core in a model of modes".into()));
        }
        let summed = count + SPARE_MODES;
        let beam: SharedStructure = match dressing.terms {
            Some(terms) => {
                Arc::new(TimoshenkoBeam::with_terms(&setting.piece, setting.boundary, basis_terms(count), terms)?)
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
        let rigid = base.rigid;
        let system = System::new(&view, &elements, damping);
        let panel = Self { structure: beam, values: values.to_vec(), bare, rows: placed };
        let mut found = system.solve()?;
        found.truncate(rigid + count);
        Ok((panel, system, found))
    }

    /// The deflections of all coordinates at points along the piece: mode m has about m + 1 nodes, and eight points between
    /// two of them part every pair.
    fn grid(&self, piece: &Piece, count: usize) -> Vec<Vec<f64>> {
        let points = 8 * (count + 2);
        let place = |index: usize| Place { x: piece.length * ((index as f64 + 0.5) / points as f64 - 0.5), y: 0.0 };
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

fn basis_terms(count: usize) -> usize {
    2 * (count + SPARE_MODES) + 24
}

fn even_beam(setting: &EffectSetting, count: usize) -> Result<Arc<TimoshenkoBeam>, ModelError> {
    let terms = BeamTerms::default();
    Ok(Arc::new(TimoshenkoBeam::with_terms(&setting.piece, setting.boundary, basis_terms(count), terms)?))
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
        let grid = if told { vec![] } else { panel.grid(&setting.piece, count + rigid) };
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

/// $\omega$, $\zeta$ and all coordinates of a mode.
type FoundMode = (f64, f64, Vec<f64>);

/// Stiffness, mass and damping in the coordinates of a [`DressedPanel`].
struct System {
    stiffness: Mat<f64>,
    mass: Mat<f64>,
    damping: Mat<f64>,
    /// Where the residual shapes begin.
    residuals: usize,
    /// Coordinates that stand for the panel; the resonators' follow.
    panel: usize,
    /// A frequency squared of the size of the lowest.
    shift: f64,
}

impl System {
    fn new(view: &View, elements: &[PointElement], damping: &Damping) -> Self {
        let (layout, numbers) = (view.layout, &view.numbers);
        let (modes, count) = (layout.modes, layout.active);
        let resonators = elements.iter().filter(|element| matches!(element.law, ElementLaw::Resonator { .. })).count();
        let (panel, size) = (modes + count, modes + count + resonators);
        let series = |k: usize, a: usize, b: usize| numbers[layout.series(k) + a * count + b];
        let mut system = Self {
            stiffness: Mat::zeros(size, size),
            mass: Mat::zeros(size, size),
            damping: Mat::zeros(size, size),
            residuals: modes,
            panel,
            shift: numbers.get(layout.rigid).copied().unwrap_or(1.0),
        };
        for (m, &lambda) in numbers.iter().enumerate().take(modes) {
            system.stiffness[(m, m)] = lambda;
            system.mass[(m, m)] = 1.0;
            let zeta = if m < layout.rigid { 0.0 } else { damping.ratio(m + 1 - layout.rigid) };
            system.damping[(m, m)] = 2.0 * zeta * lambda.sqrt();
        }
        for (a, b) in (0..count).flat_map(|a| (0..count).map(move |b| (a, b))) {
            system.stiffness[(modes + a, modes + b)] = series(0, a, b);
            system.mass[(modes + a, modes + b)] = series(1, a, b);
        }
        let mut next = panel;
        for (a, element) in elements.iter().enumerate() {
            let mut row = vec![0.0; size];
            (0..modes).for_each(|m| row[m] = numbers[layout.shape(m) + a]);
            (0..count).for_each(|b| row[modes + b] = series(0, a, b));
            match element.law {
                ElementLaw::Mass { mass } => add(&mut system.mass, mass, &row),
                ElementLaw::Spring { stiffness, damping } => {
                    add(&mut system.stiffness, stiffness, &row);
                    add(&mut system.damping, damping, &row);
                }
                ElementLaw::Resonator { mass, frequency, zeta } => {
                    let own = frequency * std::f64::consts::TAU;
                    system.mass[(next, next)] += mass;
                    row[next] = -1.0;
                    add(&mut system.stiffness, mass * own * own, &row);
                    add(&mut system.damping, 2.0 * zeta * mass * own, &row);
                    next += 1;
                }
            }
        }
        system
    }

    /// $\omega$, $\zeta$ and all coordinates of each mode, rising. As in [`crate::ritz_modes()`], by the inverse
    /// of a shifted stiffness; a mass matrix that negative masses make indefinite leaves modes without meaning, which go.
    fn solve(&self) -> Result<Vec<FoundMode>, ModelError> {
        let kept = self.independent();
        let size = kept.len();
        let part = |matrix: &Mat<f64>| Mat::from_fn(size, size, |i, j| matrix[(kept[i], kept[j])]);
        let shifted = part(&self.stiffness) + faer::Scale(self.shift) * part(&self.mass);
        let scale: Vec<f64> = (0..size).map(|i| shifted[(i, i)].sqrt().recip()).collect();
        if scale.iter().any(|value| !value.is_finite()) {
            return Err(ModelError::Eigenproblem);
        }
        let scaled = |matrix: Mat<f64>| Mat::from_fn(size, size, |i, j| scale[i] * matrix[(i, j)] * scale[j]);
        let factor = Cholesky::new(&scaled(shifted)).ok_or(ModelError::Eigenproblem)?;
        let mut flexibility = scaled(part(&self.mass));
        factor.solve_lower(&mut flexibility);
        let mut flexibility = flexibility.transpose().to_owned();
        factor.solve_lower(&mut flexibility);
        let symmetric = Mat::from_fn(size, size, |i, j| 0.5 * (flexibility[(i, j)] + flexibility[(j, i)]));
        let (thetas, mut vectors) = symmetric_eigen(&symmetric).ok_or(ModelError::Eigenproblem)?;
        factor.solve_upper(&mut vectors);
        let positive = (0..size).rev().filter(|&column| thetas[column] > 0.0);
        let modes = positive.map(|column| {
            let norm = thetas[column].sqrt().recip();
            let mut whole = vec![0.0; self.mass.nrows()];
            (0..size).for_each(|i| whole[kept[i]] = norm * scale[i] * vectors[(i, column)]);
            let lambda = 1.0 / thetas[column] - self.shift;
            // Rounding of a rigid mode.
            let omega = if lambda > 1e-9 * self.shift { lambda.sqrt() } else { 0.0 };
            let lost = crate::structure::quadratic_form(&self.damping, &whole);
            let zeta = if omega > 0.0 { (lost / (2.0 * omega)).min(0.7) } else { 0.0 };
            (omega, zeta, whole)
        });
        Ok(modes.collect())
    }

    /// The damping matrix in these modes, less $2\zeta\omega$ on its diagonal; rigid modes have none.
    fn couplings(&self, modes: &[FoundMode]) -> Vec<Vec<f64>> {
        let row = |(m, (omega, zeta, shape)): (usize, &FoundMode)| {
            let forces: Vec<f64> = (0..shape.len())
                .map(|i| self.damping.col_as_slice(i).iter().zip(shape).map(|(damping, share)| damping * share).sum())
                .collect();
            let other = |(n, (other, _, along)): (usize, &FoundMode)| {
                let whole: f64 = forces.iter().zip(along).map(|(force, share)| force * share).sum();
                let rest = if n == m { whole - 2.0 * zeta * omega } else { whole };
                // What rounding leaves of a rigid mode, or of the diagonal.
                let rounding = 1e-12 * self.shift.sqrt();
                if *omega == 0.0 || *other == 0.0 || rest.abs() <= rounding { 0.0 } else { rest }
            };
            modes.iter().enumerate().map(other).collect()
        };
        modes.iter().enumerate().map(row).collect()
    }

    /// Coordinates without the residual shapes that others hold already, as of two elements at one place.
    fn independent(&self) -> Vec<usize> {
        let size = self.stiffness.nrows();
        let first = self.residuals;
        let mut kept: Vec<usize> = (0..first).collect();
        let mut residual: Vec<usize> = Vec::new();
        for candidate in first..self.panel {
            let with: Vec<usize> = residual.iter().copied().chain([candidate]).collect();
            let scale = |i: usize| self.stiffness[(i, i)].abs().sqrt().recip();
            let block = Mat::from_fn(with.len(), with.len(), |i, j| {
                scale(with[i]) * self.stiffness[(with[i], with[j])] * scale(with[j])
            });
            let smallest = symmetric_eigen(&block).and_then(|(values, _)| values.first().copied()).unwrap_or(0.0);
            if smallest > 1e-6 {
                residual = with;
            }
        }
        kept.extend(residual);
        kept.extend(self.panel..size);
        kept
    }
}

fn add(matrix: &mut Mat<f64>, factor: f64, row: &[f64]) {
    for (i, a) in row.iter().enumerate() {
        for (j, b) in row.iter().enumerate() {
            matrix[(i, j)] += factor * a * b;
        }
    }
}
