//! A structure on a few shapes of its own: quick steps of a search near some values of the constants.

use std::sync::Arc;

use faer::Mat;

use crate::block_pencil::BlockPencil;
use crate::dense::{product, symmetric_eigen, symmetric_eigenvalues};
use crate::ritz_modes::{checked_coefficients, ritz_modes};
use crate::structure::{Block, Motion, RitzMode, Structure};
use crate::{Constant, ModelError, Place, SymmetricMatrix, side_by_side};

/// A structure on the space of its lowest modes at some values of the constants and of their first changes with these.
///
/// With $V$ the modes $\phi_m$ and what $K^{-1}K_i\phi_m$ adds to them (the part of $\partial\phi_m/\partial c_i$ that lies in
/// modes far above), stiffness and mass are $V^TK_iV$ and $V^TMV$, so all that a [`Structure`] gives follows. At those values
/// its modes, and how they follow the constants, are the structure's own. At others its frequencies lie above, by the square
/// of the change or less: a search that ends there must be held against the whole structure.
#[derive(Debug, Clone)]
pub struct ReducedStructure<S> {
    whole: Arc<S>,
    /// $V$ of each block, a column a shape: $V^TMV = I$.
    shapes: Vec<Mat<f64>>,
    blocks: Vec<Block>,
    /// What moves at the places that it answers, of each block: asked for at every step of a search.
    rows: Vec<KnownRow>,
}

/// What moves, where, and the row of each block.
pub(crate) type KnownRow = ((Motion, Place), Vec<Vec<f64>>);

/// Rows of a structure that are asked for again and again.
pub(crate) fn rows_at(structure: &dyn Structure, places: &[Place]) -> Vec<KnownRow> {
    let motions = [Motion::Deflection, Motion::Foot, Motion::Slope, Motion::SlopeAcross];
    let all = places.iter().flat_map(|place| motions.map(|motion| (motion, *place)));
    let row = |(motion, place): (Motion, Place)| {
        let rows = (0..structure.blocks().len()).map(|block| structure.motion_row(block, motion, place));
        Some(((motion, place), rows.collect::<Option<Vec<_>>>()?))
    };
    all.filter_map(row).collect()
}

/// One of them.
pub(crate) fn known_row(rows: &[KnownRow], block: usize, row: (Motion, Place)) -> Option<Vec<f64>> {
    rows.iter().find(|(known, _)| *known == row).and_then(|(_, rows)| rows.get(block).cloned())
}

/// Changes of a shape below this, for a coefficient that doubles, are left out: root of their energy over the mode's. They move frequencies by half
/// their square.
const SMALL_CHANGE: f64 = 2e-3;

impl<S: Structure + Send + Sync> ReducedStructure<S> {
    /// On the `count` lowest flexible modes at these values of the constants.
    ///
    /// # Errors
    /// As [`ritz_modes`].
    pub fn near(whole: Arc<S>, values: &[f64], count: usize) -> Result<Self, ModelError> {
        Self::answering(whole, values, count, &[])
    }

    /// The same, on the space of what forces at these places do besides: $K^{-1}F$ and $K^{-1}MK^{-1}F$, so that the
    /// receptances between them hold what all modes above give, to the order $s^2$.
    ///
    /// # Errors
    /// As [`ritz_modes`].
    pub fn answering(whole: Arc<S>, values: &[f64], count: usize, forces: &[Place]) -> Result<Self, ModelError> {
        let modes = ritz_modes(whole.as_ref(), values, count)?;
        Self::on_modes(whole, values, &modes, forces)
    }

    /// On these modes, which are the structure's lowest, rigid ones too, at these values of the constants.
    ///
    /// # Errors
    /// As [`ritz_modes`].
    pub fn on(whole: Arc<S>, values: &[f64], modes: &[RitzMode]) -> Result<Self, ModelError> {
        Self::on_modes(whole, values, modes, &[])
    }

    fn on_modes(whole: Arc<S>, values: &[f64], modes: &[RitzMode], places: &[Place]) -> Result<Self, ModelError> {
        let coefficients = checked_coefficients(whole.as_ref(), values)?;
        let numbered: Vec<(usize, &Block)> = whole.blocks().iter().enumerate().collect();
        let reduced = side_by_side::map(&numbered, |&(index, block)| {
            let own: Vec<&RitzMode> = modes.iter().filter(|mode| mode.block == index).collect();
            let rows: Vec<Vec<f64>> = places.iter().map(|&place| whole.shape_row(index, place)).collect();
            let forces = Mat::from_fn(block.size(), rows.len(), |i, force| rows[force][i]);
            let shapes = shapes(block, &coefficients, &own, forces)?;
            let project = |matrix: &SymmetricMatrix| between(&shapes, matrix, &shapes).into();
            let rigid = own.iter().filter(|mode| mode.angular_frequency == 0.0).count();
            let unit = |position: usize| (0..shapes.ncols()).map(|i| f64::from(u8::from(i == position))).collect();
            let block = Block {
                stiffness: block.stiffness.iter().map(project).collect(),
                mass: Mat::<f64>::identity(shapes.ncols(), shapes.ncols()).into(),
                rigid: (0..rigid).map(unit).collect(),
            };
            Ok((shapes, block))
        });
        let (shapes, blocks) = reduced.into_iter().collect::<Result<Vec<_>, ModelError>>()?.into_iter().unzip();
        let mut reduced = Self { whole, shapes, blocks, rows: vec![] };
        reduced.rows = rows_at(&reduced, places);
        Ok(reduced)
    }

    /// Its modes, as many as it has shapes: the rigid ones, then the flexible ones, rising.
    ///
    /// # Errors
    /// As [`ritz_modes`].
    pub fn modes(&self, values: &[f64]) -> Result<Vec<RitzMode>, ModelError> {
        let coefficients = checked_coefficients(self.whole.as_ref(), values)?;
        let mut modes = Vec::new();
        for (block, own) in self.blocks.iter().enumerate() {
            let (size, rigid) = (own.size(), own.rigid.len());
            let (omega2, vectors) =
                symmetric_eigen(&flexible_stiffness(own, &coefficients)).ok_or(ModelError::Eigenproblem)?;
            modes.extend(own.rigid.iter().map(|shape| RitzMode {
                angular_frequency: 0.0,
                block,
                coordinates: shape.clone(),
            }));
            modes.extend(omega2.iter().enumerate().map(|(k, omega2)| RitzMode {
                angular_frequency: omega2.max(0.0).sqrt(),
                block,
                coordinates: (0..size).map(|i| if i < rigid { 0.0 } else { vectors[(i - rigid, k)] }).collect(),
            }));
        }
        modes.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
        Ok(modes)
    }

    /// Natural frequencies \[Hz\] of its flexible modes, rising; to turn their shapes is most of what [`Self::modes`] does.
    ///
    /// # Errors
    /// As [`ritz_modes`].
    pub fn natural_frequencies(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let coefficients = checked_coefficients(self.whole.as_ref(), values)?;
        let mut frequencies = Vec::new();
        for own in &self.blocks {
            let omega2 = symmetric_eigenvalues(&flexible_stiffness(own, &coefficients));
            let omega2 = omega2.ok_or(ModelError::Eigenproblem)?;
            frequencies.extend(
                omega2.iter().filter(|omega2| **omega2 > 0.0).map(|omega2| omega2.sqrt() / std::f64::consts::TAU),
            );
        }
        frequencies.sort_by(f64::total_cmp);
        Ok(frequencies)
    }

    /// A mode of this structure in the coordinates of the whole one.
    pub fn in_whole(&self, mode: &RitzMode) -> RitzMode {
        let Some(shapes) = self.shapes.get(mode.block) else { return mode.clone() };
        let mut coordinates = vec![0.0; shapes.nrows()];
        for (shape, share) in shapes.col_iter().zip(&mode.coordinates) {
            coordinates.iter_mut().zip(shape.iter()).for_each(|(sum, value)| *sum += share * value);
        }
        RitzMode { coordinates, ..*mode }
    }
}

impl<S> ReducedStructure<S> {
    /// A row of the whole structure's coordinates in these.
    fn seen(&self, block: usize, row: &[f64]) -> Vec<f64> {
        let Some(shapes) = self.shapes.get(block) else { return vec![] };
        let value = |shape: faer::ColRef<'_, f64>| row.iter().zip(shape.iter()).map(|(row, shape)| row * shape).sum();
        shapes.col_iter().map(value).collect()
    }
}

/// $\sum_ic_iK_i$ between the flexible shapes of a block: its mass is one, and nothing couples the rigid ones, which come first.
fn flexible_stiffness(block: &Block, coefficients: &[f64]) -> Mat<f64> {
    let (size, rigid) = (block.size(), block.rigid.len());
    let entry = |i: usize, j: usize| -> f64 {
        block.stiffness.iter().zip(coefficients).map(|(matrix, c)| c * matrix[(rigid + i, rigid + j)]).sum()
    };
    Mat::from_fn(size - rigid, size - rigid, entry)
}

/// The modes of a block, rigid ones first, and the directions of their changes; orthonormal in the mass.
///
/// A change $v$ of a mode that is left out moves $\omega_n^2$ by $v^TKv$, so that changes are weighed by their energy beside that of the mode, which is
/// $\omega_n^2$: by its mass one of a low mode in shapes far above would seem small.
fn shapes(block: &Block, coefficients: &[f64], modes: &[&RitzMode], forces: Mat<f64>) -> Result<Mat<f64>, ModelError> {
    let own = Mat::from_fn(block.size(), modes.len(), |i, m| modes[m].coordinates[i]);
    let rigid = modes.iter().filter(|mode| mode.angular_frequency == 0.0).count();
    let flexible = own.subcols(rigid, modes.len() - rigid).to_owned();
    let images: Vec<Mat<f64>> = block.stiffness.iter().map(|stiffness| stiffness.times(&flexible)).collect();
    let count = flexible.ncols();
    let load = |i: usize, j: usize| {
        coefficients[j / count] * images[j / count][(i, j % count)] / modes[rigid + j % count].angular_frequency
    };
    let loads = Mat::from_fn(block.size(), count * images.len(), load);
    let pencil = BlockPencil::new(block, coefficients)?;
    let mut changes = pencil.solve(loads);
    let own_images = block.mass.times(&own);
    let without_modes = |vectors: &mut Mat<f64>| {
        for _ in 0..2 {
            let shares = product(own_images.transpose(), vectors.as_ref());
            *vectors -= product(own.as_ref(), shares.as_ref());
        }
    };
    without_modes(&mut changes);
    let stiffness = block.stiffness_at(coefficients);
    if forces.ncols() > 0 {
        let mut answers = pencil.solve(forces);
        without_modes(&mut answers);
        let mut again = pencil.solve(block.mass.times(&answers));
        without_modes(&mut again);
        [&mut answers, &mut again].into_iter().for_each(|vectors| to_unit_energy(vectors, &stiffness));
        changes = faer::concat![[changes, answers, again]];
    }
    // The principal directions of all changes together.
    let (sizes, directions) =
        symmetric_eigen(&between(&changes, &stiffness, &changes)).ok_or(ModelError::Eigenproblem)?;
    let kept: Vec<usize> = (0..changes.ncols()).filter(|&k| sizes[k] > SMALL_CHANGE.powi(2)).collect();
    let directions = Mat::from_fn(changes.ncols(), kept.len(), |i, k| directions[(i, kept[k])] / sizes[kept[k]].sqrt());
    let added = product(changes.as_ref(), directions.as_ref());
    // Of unit energy so far.
    let (masses, directions) =
        symmetric_eigen(&between(&added, &block.mass, &added)).ok_or(ModelError::Eigenproblem)?;
    let to_unit_mass = Mat::from_fn(kept.len(), kept.len(), |i, k| directions[(i, k)] / masses[k].sqrt());
    Ok(faer::concat![[own, product(added.as_ref(), to_unit_mass.as_ref())]])
}

/// Scales each column to $v^TKv = 1$.
fn to_unit_energy(vectors: &mut Mat<f64>, stiffness: &SymmetricMatrix) {
    let images = stiffness.times(vectors);
    for column in 0..vectors.ncols() {
        let square: f64 = (0..vectors.nrows()).map(|i| vectors[(i, column)] * images[(i, column)]).sum();
        let scale = if square > 0.0 { square.sqrt().recip() } else { 0.0 };
        vectors.col_as_slice_mut(column).iter_mut().for_each(|value| *value *= scale);
    }
}

/// $A^TMB$.
fn between(left: &Mat<f64>, matrix: &SymmetricMatrix, right: &Mat<f64>) -> Mat<f64> {
    product(left.transpose(), matrix.times(right).as_ref())
}

impl<S: Structure> Structure for ReducedStructure<S> {
    fn constants(&self) -> &'static [Constant] {
        self.whole.constants()
    }

    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        self.whole.coefficients(values)
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        self.whole.coefficient_derivatives(values)
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    fn shape_row(&self, block: usize, place: Place) -> Vec<f64> {
        self.seen(block, &self.whole.shape_row(block, place))
    }

    fn motion_row(&self, block: usize, motion: Motion, place: Place) -> Option<Vec<f64>> {
        let known = known_row(&self.rows, block, (motion, place));
        known.or_else(|| Some(self.seen(block, &self.whole.motion_row(block, motion, place)?)))
    }

    fn static_remainder(&self, values: &[f64], motions: [(Motion, Place); 2]) -> Option<f64> {
        self.whole.static_remainder(values, motions)
    }

    fn static_remainders(&self, values: &[f64], motions: [&[(Motion, Place)]; 2]) -> Option<Mat<f64>> {
        self.whole.static_remainders(values, motions)
    }

    fn inertial_remainders(&self, values: &[f64], motions: [&[(Motion, Place)]; 2]) -> Vec<Mat<f64>> {
        self.whole.inertial_remainders(values, motions)
    }

    /// All of its coordinates: most are modes.
    fn resolved_modes(&self) -> usize {
        self.blocks.iter().map(|block| block.size() - block.rigid.len()).sum()
    }
}
