//! A panel whose core relaxes, with the internal variables that remember it.

use faer::Mat;

use super::dressed_modes::even_beam;
use super::dressed_system::System;
use super::{CoreFit, DressedMode, DressedPanel, EffectSetting, EffectState, RecordSetting};
use crate::block_pencil::BlockPencil;
use crate::dense::{dot, product, symmetric_eigen};
use crate::{Block, Boundary, Damping, ModelError, Piece};

impl DressedPanel {
    /// The rigid modes and those of `count` flexible bare modes together with all internal variables of the core, and its
    /// fit from a tenth of the first bare frequency to the last; `None` where no effect is a core, and no mode is made then.
    ///
    /// With $S$ the shear stiffness in the bare modes and the changes of their shapes, and $u_k$, $\sigma_k$ its eigenvectors and eigenvalues, each term of
    /// the [`CoreFit`] adds $a_iS$ to the stiffness and oscillators
    /// $$\ddot z_{ik} + 2\zeta\omega_i\dot z_{ik} + \omega_i^2z_{ik} = \sqrt{a_i\sigma_k}\,\omega_iu_k^Tq,$$
    /// which act back alike. Modes are those of this whole without damping; dampers couple them.
    pub(crate) fn relaxing_modes(
        (piece, boundary): (&Piece, Boundary),
        values: &[f64],
        effects: &[EffectState],
        damping: &Damping,
        count: usize,
    ) -> Result<Option<(Vec<DressedMode>, CoreFit)>, ModelError> {
        let setting = EffectSetting { piece: *piece, boundary, suspension: vec![], record: RecordSetting::default() };
        let beam = even_beam(&setting, count)?;
        let (mut panel, mut system, core) = Self::system(&setting, &beam, values, effects, damping, count)?;
        let Some(core) = core else { return Ok(None) };
        if panel.has_elements() {
            return Err(ModelError::Unsupported(
                "viscoelastic-core beside masses, springs or resonators in a model of modes".into(),
            ));
        }
        let frequency = |index: usize| panel.bare.get(index).map_or(0.0, |mode| mode.2.sqrt() / std::f64::consts::TAU);
        let rigid = panel.rigid();
        let fit = CoreFit::new(&core, [0.1 * frequency(rigid), frequency(rigid + count - 1)])?;
        system.add_changes(&panel.add_changes()?);
        let shear = panel.form(&panel.shear_coefficients()?, rigid);
        system.relax(&shear, rigid, count, &fit)?;
        let found = system.solve()?;
        Ok(Some((panel.dressed(&system, found, count), fit)))
    }

    /// How each stiffness coefficient follows the last constant, the shear modulus, times that.
    fn shear_coefficients(&self) -> Result<Vec<f64>, ModelError> {
        let by = self.structure.coefficient_derivatives(&self.values)?;
        let modulus = by.ncols() - 1;
        let value = self.values.get(modulus).copied().unwrap_or(0.0);
        Ok((0..by.nrows()).map(|index| value * by[(index, modulus)]).collect())
    }

    /// The shapes that the flexible bare modes take on when the shear modulus changes, $K^{-1}K_s\phi_m$ without what the
    /// bare modes hold already; added to these, orthonormal in the mass. Their stiffnesses, block by block.
    ///
    /// Without them a stiffer core would not change how much of a wave is shear: frequencies would err by the square of the
    /// change.
    fn add_changes(&mut self) -> Result<Mat<f64>, ModelError> {
        let shear = self.shear_coefficients()?;
        let coefficients = self.structure.coefficients(&self.values)?;
        let structure = std::sync::Arc::clone(&self.structure);
        let (first, rigid) = (self.bare.len(), self.rigid());
        for (index, block) in structure.blocks().iter().enumerate() {
            let own: Vec<usize> = (0..first).filter(|&mode| self.bare[mode].0 == index).collect();
            let modes = Mat::from_fn(block.size(), own.len(), |i, m| self.bare[own[m]].1[i]);
            let flexible: Vec<usize> = (0..own.len()).filter(|&m| own[m] >= rigid).collect();
            let moving = Mat::from_fn(block.size(), flexible.len(), |i, m| modes[(i, flexible[m])]);
            let loads = product(weighted(block, &shear).as_ref(), moving.as_ref());
            let mut changes = BlockPencil::new(block, &coefficients)?.solve(loads);
            for _ in 0..2 {
                let held = product(modes.transpose(), product(block.mass.as_ref(), changes.as_ref()).as_ref());
                changes -= product(modes.as_ref(), held.as_ref());
            }
            let gram = product(changes.transpose(), product(block.mass.as_ref(), changes.as_ref()).as_ref());
            let size = |m: usize| gram[(m, m)].sqrt();
            let even = Mat::from_fn(gram.nrows(), gram.ncols(), |i, j| gram[(i, j)] / (size(i) * size(j)));
            let (shares, directions) = symmetric_eigen(&even).ok_or(ModelError::Eigenproblem)?;
            for k in (0..shares.len()).filter(|&k| shares[k] > DEPENDENT) {
                let of = |i: usize, m: usize| changes[(i, m)] * directions[(m, k)] / size(m);
                let shape = |i: usize| (0..gram.nrows()).map(|m| of(i, m)).sum::<f64>() / shares[k].sqrt();
                self.bare.push((index, (0..block.size()).map(shape).collect(), f64::NAN));
            }
        }
        Ok(self.form(&coefficients, first))
    }

    /// $\sum_ic_iK_i$ in the bare shapes from `first` on.
    fn form(&self, coefficients: &[f64], first: usize) -> Mat<f64> {
        let shapes = &self.bare[first..];
        let matrices: Vec<Mat<f64>> =
            self.structure.blocks().iter().map(|block| weighted(block, coefficients)).collect();
        let image = |(block, shape, _): &(usize, Vec<f64>, f64)| -> Vec<f64> {
            (0..shape.len()).map(|i| dot(matrices[*block].col_as_slice(i), shape)).collect()
        };
        let images: Vec<Vec<f64>> = shapes.iter().map(image).collect();
        let entry = |m: usize, n: usize| if shapes[m].0 == shapes[n].0 { dot(&shapes[m].1, &images[n]) } else { 0.0 };
        Mat::from_fn(shapes.len(), shapes.len(), |m, n| 0.5 * (entry(m, n) + entry(n, m)))
    }
}

/// Share of a new direction among the changes of shape below which it is another's.
const DEPENDENT: f64 = 1e-9;

/// $\sum_ic_iK_i$ of one block.
fn weighted(block: &Block, coefficients: &[f64]) -> Mat<f64> {
    let mut sum = Mat::zeros(block.size(), block.size());
    for (matrix, &coefficient) in block.stiffness.iter().zip(coefficients) {
        sum += faer::Scale(coefficient) * matrix;
    }
    sum
}

impl System {
    /// Adds coordinates of mass one with this stiffness.
    fn add_changes(&mut self, stiffness: &Mat<f64>) {
        let before = self.panel;
        self.grow(before + stiffness.nrows());
        for i in 0..stiffness.nrows() {
            self.mass[(before + i, before + i)] = 1.0;
            (0..stiffness.nrows()).for_each(|j| self.stiffness[(before + i, before + j)] = stiffness[(i, j)]);
        }
        (self.residuals, self.panel) = (self.stiffness.nrows(), self.stiffness.nrows());
    }

    /// Adds the internal variables of a core with this shear stiffness among the flexible coordinates, which follow
    /// `rigid` ones: of its `kept` greatest directions, as many as there are wave lengths.
    fn relax(&mut self, shear: &Mat<f64>, rigid: usize, kept: usize, fit: &CoreFit) -> Result<(), ModelError> {
        let (flexible, before) = (shear.nrows(), self.stiffness.nrows());
        let (sizes, directions) = symmetric_eigen(shear).ok_or(ModelError::Eigenproblem)?;
        let kept: Vec<usize> = (flexible.saturating_sub(kept)..flexible).collect();
        self.grow(before + kept.len() * fit.terms.len());
        for (term, &[weight, omega]) in fit.terms.iter().enumerate() {
            for (index, &k) in kept.iter().enumerate() {
                let own = before + term * kept.len() + index;
                self.mass[(own, own)] = 1.0;
                self.damping[(own, own)] = 2.0 * fit.ratio * omega;
                self.stiffness[(own, own)] = omega * omega;
                let size = weight * sizes[k].max(0.0);
                for m in 0..flexible {
                    let coupling = size.sqrt() * omega * directions[(m, k)];
                    self.stiffness[(rigid + m, own)] -= coupling;
                    self.stiffness[(own, rigid + m)] -= coupling;
                    for n in 0..flexible {
                        self.stiffness[(rigid + m, rigid + n)] += size * directions[(m, k)] * directions[(n, k)];
                    }
                }
            }
        }
        Ok(())
    }

    fn grow(&mut self, size: usize) {
        let before = self.stiffness.nrows();
        for matrix in [&mut self.stiffness, &mut self.mass, &mut self.damping] {
            *matrix = Mat::from_fn(size, size, |i, j| if i < before && j < before { matrix[(i, j)] } else { 0.0 });
        }
    }
}
