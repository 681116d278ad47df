//! A panel whose core relaxes, with the internal variables that remember it.

use std::sync::Arc;

use faer::Mat;

use super::coupled_panel::{CoupledPanel, Even, ModifiedStructure, PanelWithEffects, Residual, row};
use super::coupled_system::{System, uncoupled};
use super::row::Row;
use super::{CoreFit, CoreModulus, CoupledMode, ElementLaw};
use crate::block_pencil::BlockPencil;
use crate::dense::{Cholesky, dot, product, symmetric_eigen};
use crate::order::sorted;
use crate::structure::Structure;
use crate::{ModelError, Place, SymmetricMatrix};

/// A panel on shapes that stay good while its core relaxes, at its low modulus.
pub(super) struct Relaxing {
    pub(super) panel: CoupledPanel,
    /// Its matrices, elements and all.
    pub(super) system: System,
    /// Of the flexible coordinates: their whole stiffness without elements, and the core's part of it.
    stiffness: Mat<f64>,
    pub(super) shear: Mat<f64>,
    pub(super) core: CoreModulus,
    /// How many places have shapes of their own.
    seats: usize,
}

impl Relaxing {
    /// On `count` flexible bare modes, with shapes of their own for the elements' places and for `ports`; `None` where no
    /// effect is a core.
    pub(super) fn new(parts: PanelWithEffects, count: usize, ports: &[Place]) -> Result<Option<Self>, ModelError> {
        let modified = ModifiedStructure::new(parts, count)?;
        let (Some(core), elements) = (modified.core, &modified.elements) else { return Ok(None) };
        let mut panel = modified.panel();
        let mut system = System::without_elements(&modified.low, parts.damping);
        let of_elements: Vec<Row> = elements.iter().filter_map(row).collect();
        let mut seats: Vec<Row> = Vec::new();
        for seat in of_elements.iter().copied().chain(modified.ports(ports)) {
            seats.extend((!seats.contains(&seat)).then_some(seat));
        }
        let rigid = panel.rigid();
        panel.add_changes(&seats)?;
        let stiffness = panel.form(&panel.structure.coefficients(parts.values)?, rigid);
        let shear = panel.form(&panel.shear_coefficients()?, rigid);
        let (stiffness, shear) = panel.add_kinks(&seats, stiffness, shear)?;
        let resonators = elements.iter().filter(|element| matches!(element.law, ElementLaw::Resonator { .. })).count();
        system.enlarge(&stiffness, [rigid, panel.bare.len()], resonators);
        let mut own = system.panel..system.panel + resonators;
        for (element, seat) in elements.iter().zip(&of_elements) {
            let mut row = panel.values_in(*seat)?;
            row.resize(system.panel + resonators, 0.0);
            system.join(element.law, row, &mut own);
        }
        Ok(Some(Self { panel, system, stiffness, shear, core, seats: seats.len() }))
    }
}

impl CoupledPanel {
    /// The rigid modes and those of `count` flexible bare modes together with all internal variables of the core, and its
    /// fit from a tenth of the first bare frequency to the last; `None` where no effect is a core, and no mode is made then.
    ///
    /// With $S$ the shear stiffness in the bare modes, the changes of their shapes and what the elements' forces do, and
    /// $S = \sum_kb_kb_k^T$ as [`shear_directions`] takes it apart, each term of the [`CoreFit`] adds $a_iS$ to the stiffness
    /// and oscillators
    /// $$\ddot z_{ik} + 2\zeta\omega_i\dot z_{ik} + \omega_i^2z_{ik} = \sqrt{a_i}\,\omega_ib_k^Tq,$$
    /// which act back alike. Modes are those of this whole without damping; dampers couple them.
    pub(crate) fn relaxing_modes(
        parts: PanelWithEffects,
        count: usize,
    ) -> Result<Option<(Vec<CoupledMode>, CoreFit)>, ModelError> {
        let Some(relaxing) = Relaxing::new(parts, count, &[])? else { return Ok(None) };
        let Relaxing { panel, mut system, stiffness, shear, core, seats } = relaxing;
        let frequency = |index: usize| panel.bare.get(index).map_or(0.0, |mode| mode.2.sqrt() / std::f64::consts::TAU);
        let rigid = panel.rigid();
        let fit = CoreFit::new(&core, [0.1 * frequency(rigid), frequency(rigid + count - 1)])?;
        // On a plate a wave shears both ways.
        let ways = if matches!(parts.even, Even::Plate(_)) { 2 } else { 1 };
        let kept = ways * (count + 2 * seats) + panel.residuals.len();
        system.relax(&shear_directions(&stiffness, &shear, kept)?, rigid, &fit);
        let found = system.solve()?;
        Ok(Some((panel.modified(&system, found, count), fit)))
    }

    /// How the stiffness coefficients follow the moduli of the core, times these.
    fn shear_coefficients(&self) -> Result<Vec<f64>, ModelError> {
        let by = self.structure.coefficient_derivatives(&self.values)?;
        let of_core = |(_, constant): &(usize, &crate::Constant)| matches!(constant.name, "g_zx" | "g_yz");
        let moduli: Vec<usize> =
            self.structure.constants().iter().enumerate().filter(of_core).map(|(index, _)| index).collect();
        let value = |index: usize| moduli.iter().map(|&modulus| self.values[modulus] * by[(index, modulus)]).sum();
        Ok((0..by.nrows()).map(value).collect())
    }

    /// Adds to the bare modes, orthonormal in the mass, what they lack of the shapes that the flexible ones take on when
    /// the core stiffens, $K^{-1}S\phi_m$, and of what forces at the elements do, $K^{-1}f$ and $K^{-1}SK^{-1}f$.
    ///
    /// Without the first a stiffer core would not change how much of a wave is shear: frequencies would err by the square of the
    /// change.
    fn add_changes(&mut self, seats: &[Row]) -> Result<(), ModelError> {
        let shear = self.shear_coefficients()?;
        let coefficients = self.structure.coefficients(&self.values)?;
        let structure = Arc::clone(&self.structure);
        let (first, rigid) = (self.bare.len(), self.rigid());
        for (index, block) in structure.blocks().iter().enumerate() {
            let own: Vec<usize> = (0..first).filter(|&mode| self.bare[mode].0 == index).collect();
            let modes = Mat::from_fn(block.size(), own.len(), |i, m| self.bare[own[m]].1[i]);
            let flexible: Vec<usize> = (0..own.len()).filter(|&m| own[m] >= rigid).collect();
            let moving = Mat::from_fn(block.size(), flexible.len(), |i, m| modes[(i, flexible[m])]);
            let (pencil, shear) = (BlockPencil::new(block, &coefficients)?, block.stiffness_at(&shear));
            let without_modes = |mut vectors: Mat<f64>| {
                for _ in 0..2 {
                    let held = product(modes.transpose(), block.mass.times(&vectors).as_ref());
                    vectors -= product(modes.as_ref(), held.as_ref());
                }
                vectors
            };
            let changed = |vectors: &Mat<f64>| without_modes(pencil.solve(shear.times(vectors)));
            let mut changes = changed(&moving);
            if !seats.is_empty() {
                let rows = seats.iter().map(|&(motion, place)| structure.motion_row(index, motion, place));
                let rows = rows.collect::<Option<Vec<_>>>();
                let rows = rows.ok_or_else(|| ModelError::Unsupported("an effect on a rotation here".into()))?;
                // A place on a line of symmetry pushes nothing that is odd about it.
                let size = |row: &Vec<f64>| row.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                let greatest = greatest_row(structure.as_ref(), seats);
                let rows: Vec<Vec<f64>> = rows.into_iter().filter(|row| size(row) > UNMOVED * greatest).collect();
                let forces = Mat::from_fn(block.size(), rows.len(), |i, force| rows[force][i]);
                let answers = without_modes(pencil.solve(forces));
                let again = changed(&answers);
                changes = faer::concat![[changes, answers, again]];
            }
            let gram = product(changes.transpose(), block.mass.times(&changes).as_ref());
            let size = |m: usize| gram[(m, m)].sqrt().max(f64::MIN_POSITIVE);
            let even = Mat::from_fn(gram.nrows(), gram.ncols(), |i, j| gram[(i, j)] / (size(i) * size(j)));
            let (shares, directions) = symmetric_eigen(&even).ok_or(ModelError::Eigenproblem)?;
            for k in (0..shares.len()).filter(|&k| shares[k] > DEPENDENT) {
                let of = |i: usize, m: usize| changes[(i, m)] * directions[(m, k)] / size(m);
                let shape = |i: usize| (0..gram.nrows()).map(|m| of(i, m)).sum::<f64>() / shares[k].sqrt();
                self.bare.push((index, (0..block.size()).map(shape).collect(), f64::NAN));
            }
        }
        Ok(())
    }

    /// Adds the kink under each element that the basis lacks, where the structure knows that: coordinates without mass, and all of their stiffness is the core's.
    fn add_kinks(
        &mut self,
        seats: &[Row],
        stiffness: Mat<f64>,
        shear: Mat<f64>,
    ) -> Result<(Mat<f64>, Mat<f64>), ModelError> {
        let (rigid, flexible) = (self.rigid(), stiffness.nrows());
        let knows = |seat: &Row| {
            self.structure.static_flexibility(&self.values, [*seat, *seat]).is_some()
                || self.structure.static_remainder(&self.values, [*seat, *seat]).is_some()
        };
        if seats.is_empty() || !seats.iter().all(knows) {
            return Ok((stiffness, shear));
        }
        let rows = seats.iter().map(|seat| self.bare_row(*seat)).collect::<Result<Vec<_>, _>>()?;
        let scale: Vec<f64> = (0..flexible).map(|i| stiffness[(i, i)].sqrt().recip()).collect();
        let scaled = Mat::from_fn(flexible, flexible, |i, j| scale[i] * stiffness[(i, j)] * scale[j]);
        let factor = Cholesky::new(&scaled).ok_or(ModelError::Eigenproblem)?;
        let mut images = Mat::from_fn(flexible, seats.len(), |i, e| scale[i] * rows[e][rigid + i]);
        factor.solve_lower(&mut images);
        factor.solve_upper(&mut images);
        for (e, seat) in seats.iter().enumerate() {
            let share = |i: usize| if i < rigid { 0.0 } else { scale[i - rigid] * images[(i - rigid, e)] };
            let image = (0..rigid + flexible).map(share).collect();
            self.residuals.push(Residual { row: *seat, image, shape: vec![] });
        }
        let value = |a: usize, e: usize| self.beyond_basis(seats[a], &rows[a], &self.residuals[e]);
        let lacking = Mat::from_fn(seats.len(), seats.len(), |a, e| 0.5 * (value(a, e) + value(e, a)));
        let with = |matrix: &Mat<f64>| {
            Mat::from_fn(flexible + seats.len(), flexible + seats.len(), |i, j| match (i < flexible, j < flexible) {
                (true, true) => matrix[(i, j)],
                (false, false) => lacking[(i - flexible, j - flexible)],
                _ => 0.0,
            })
        };
        Ok((with(&stiffness), with(&shear)))
    }

    /// All coordinates of the panel where an element sits: as [`CoupledPanel::deflections`], for any motion.
    pub(super) fn values_in(&self, row: Row) -> Result<Vec<f64>, ModelError> {
        let mut values = self.bare_row(row)?;
        let residual = |residual: &Residual| self.beyond_basis(row, &values, residual);
        let residuals: Vec<f64> = self.residuals.iter().map(residual).collect();
        values.extend(residuals);
        Ok(values)
    }

    /// $\sum_ic_iK_i$ in the bare shapes from `first` on.
    fn form(&self, coefficients: &[f64], first: usize) -> Mat<f64> {
        let shapes = &self.bare[first..];
        let matrices: Vec<SymmetricMatrix> =
            self.structure.blocks().iter().map(|block| block.stiffness_at(coefficients)).collect();
        let image = |(block, shape, _): &(usize, Vec<f64>, f64)| matrices[*block].image(shape);
        let images: Vec<Vec<f64>> = shapes.iter().map(image).collect();
        let entry = |m: usize, n: usize| if shapes[m].0 == shapes[n].0 { dot(&shapes[m].1, &images[n]) } else { 0.0 };
        Mat::from_fn(shapes.len(), shapes.len(), |m, n| 0.5 * (entry(m, n) + entry(n, m)))
    }
}

/// The greatest number of any coordinate at any of these places.
fn greatest_row(structure: &dyn Structure, seats: &[Row]) -> f64 {
    let row = |block: usize, (motion, place): Row| structure.motion_row(block, motion, place).unwrap_or_default();
    let all = (0..structure.blocks().len()).flat_map(|block| seats.iter().flat_map(move |seat| row(block, *seat)));
    all.fold(0.0, |most, value| most.max(value.abs()))
}

/// Share of the greatest row below which a place does not move with a block.
const UNMOVED: f64 = 1e-9;

/// Share of a new direction among the changes of shape below which it is another's.
const DEPENDENT: f64 = 1e-9;

/// $b_k$ with $S \approx \sum_kb_kb_k^T$: with $Su_k = \mu_kKu_k$ and $u_k^TKu_k = 1$, $b_k = \sqrt{\mu_k}Ku_k$ for the greatest
/// $\mu_k$, the share of shear in a stiffness. What is left out, no shape has more than its share of.
fn shear_directions(stiffness: &Mat<f64>, shear: &Mat<f64>, kept: usize) -> Result<Vec<Vec<f64>>, ModelError> {
    let size = stiffness.nrows();
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    for part in uncoupled(&[stiffness, shear], &(0..size).collect::<Vec<_>>()) {
        let of_part = |matrix: &Mat<f64>| Mat::from_fn(part.len(), part.len(), |i, j| matrix[(part[i], part[j])]);
        for (share, direction) in directions_of_part(&of_part(stiffness), &of_part(shear))? {
            let mut whole = vec![0.0; size];
            part.iter().zip(direction).for_each(|(&i, value)| whole[i] = value);
            found.push((share, whole));
        }
    }
    let found = sorted(found, |(share, _)| *share);
    Ok(found.into_iter().skip(size.saturating_sub(kept)).map(|(_, direction)| direction).collect())
}

/// $\mu_k$ and $b_k$ of coordinates that couple.
fn directions_of_part(stiffness: &Mat<f64>, shear: &Mat<f64>) -> Result<Vec<(f64, Vec<f64>)>, ModelError> {
    let size = stiffness.nrows();
    let scale: Vec<f64> = (0..size).map(|i| stiffness[(i, i)].max(f64::MIN_POSITIVE).sqrt().recip()).collect();
    let scaled = |matrix: &Mat<f64>| Mat::from_fn(size, size, |i, j| scale[i] * matrix[(i, j)] * scale[j]);
    // Kinks at one place are the same twice.
    let even = scaled(stiffness) + faer::Scale(1e-12) * Mat::<f64>::identity(size, size);
    let factor = Cholesky::new(&even).ok_or(ModelError::Eigenproblem)?;
    let mut half = scaled(shear);
    factor.solve_lower(&mut half);
    let mut both = half.transpose().to_owned();
    factor.solve_lower(&mut both);
    let symmetric = Mat::from_fn(size, size, |i, j| 0.5 * (both[(i, j)] + both[(j, i)]));
    let (shares, vectors) = symmetric_eigen(&symmetric).ok_or(ModelError::Eigenproblem)?;
    // K u = S^-1 L v, where L v = L L^T (L^-T v).
    let mut directions = vectors;
    factor.solve_upper(&mut directions);
    let images = product(even.as_ref(), directions.as_ref());
    let direction = |k: usize| (0..size).map(|i| shares[k].max(0.0).sqrt() * images[(i, k)] / scale[i]).collect();
    Ok((0..size).map(|k| (shares[k], direction(k))).collect())
}

impl System {
    /// Puts this stiffness of all flexible coordinates in the place of that of the bare modes. Those up to `bare` have the mass
    /// one, the others of the panel none; those of the resonators follow.
    fn enlarge(&mut self, stiffness: &Mat<f64>, [rigid, bare]: [usize; 2], resonators: usize) {
        let before = self.panel;
        self.panel = rigid + stiffness.nrows();
        self.grow(self.panel + resonators);
        (before..bare).for_each(|i| self.mass[(i, i)] = 1.0);
        for i in 0..stiffness.nrows() {
            (0..stiffness.nrows()).for_each(|j| self.stiffness[(rigid + i, rigid + j)] = stiffness[(i, j)]);
        }
        self.residuals = bare;
    }

    /// Adds the internal variables of a core with these directions of shear among the flexible coordinates, which follow
    /// `rigid` ones.
    fn relax(&mut self, directions: &[Vec<f64>], rigid: usize, fit: &CoreFit) {
        let before = self.stiffness.nrows();
        self.grow(before + directions.len() * fit.terms.len());
        for (term, &[weight, omega]) in fit.terms.iter().enumerate() {
            for (index, direction) in directions.iter().enumerate() {
                let own = before + term * directions.len() + index;
                self.mass[(own, own)] = 1.0;
                self.damping[(own, own)] = 2.0 * fit.ratio * omega;
                self.stiffness[(own, own)] = omega * omega;
                for (m, of_m) in direction.iter().enumerate() {
                    let coupling = weight.sqrt() * omega * of_m;
                    self.stiffness[(rigid + m, own)] -= coupling;
                    self.stiffness[(own, rigid + m)] -= coupling;
                    for (n, of_n) in direction.iter().enumerate() {
                        self.stiffness[(rigid + m, rigid + n)] += weight * of_m * of_n;
                    }
                }
            }
        }
    }

    pub(super) fn grow(&mut self, size: usize) {
        let before = self.stiffness.nrows();
        for matrix in [&mut self.stiffness, &mut self.mass, &mut self.damping] {
            *matrix = Mat::from_fn(size, size, |i, j| if i < before && j < before { matrix[(i, j)] } else { 0.0 });
        }
    }
}
