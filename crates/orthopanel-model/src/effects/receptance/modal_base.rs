//! All modes of a structure's basis, and which of them are summed.

use faer::Mat;

use crate::ModelError;
use crate::dense::product;
use crate::effects::row::{Row, SharedStructure, coordinate_rows};
use crate::ritz_modes::all_ritz_modes;

/// Modes of one block, rigid ones first.
pub(super) struct BlockModes {
    /// $\omega^2$, zero for the rigid modes.
    pub lambda: Vec<f64>,
    /// Coordinates, a column a mode.
    pub vectors: Mat<f64>,
}

/// The modes of a structure at some values of its constants.
pub(super) struct ModalBase {
    pub structure: SharedStructure,
    pub values: Vec<f64>,
    pub blocks: Vec<BlockModes>,
    /// The modes that are summed at every line: block and number in it; rigid ones first, then rising.
    pub near: Vec<(usize, usize)>,
    /// How many of `near` are rigid.
    pub rigid: usize,
}

impl ModalBase {
    /// With the rigid modes and `summed` flexible ones to be summed.
    pub(super) fn new(structure: &SharedStructure, values: &[f64], summed: usize) -> Result<Self, ModelError> {
        let modes = all_ritz_modes(structure.as_ref(), values)?;
        let mut blocks = Vec::new();
        let mut order = Vec::new();
        for (index, block) in structure.blocks().iter().enumerate() {
            let own: Vec<_> = modes.iter().filter(|mode| mode.block == index).collect();
            let lambda: Vec<f64> = own.iter().map(|mode| mode.angular_frequency.powi(2)).collect();
            let vectors = Mat::from_fn(block.size(), own.len(), |i, m| own[m].coordinates[i]);
            order.extend(lambda.iter().enumerate().map(|(number, &lambda)| (lambda, index, number)));
            blocks.push(BlockModes { lambda, vectors });
        }
        let rigid = order.iter().filter(|(lambda, ..)| *lambda == 0.0).count();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        if rigid + summed >= order.len() {
            return Err(ModelError::BasisTooSmall { asked: summed, available: (order.len() - rigid) / 2 });
        }
        let near = order.iter().take(rigid + summed).map(|&(_, block, number)| (block, number)).collect();
        Ok(Self { structure: structure.clone(), values: values.to_vec(), blocks, near, rigid })
    }

    /// The same selection of modes as another base of this structure, with the same signs.
    pub(super) fn aligned_with(mut self, other: &Self) -> Self {
        self.near.clone_from(&other.near);
        let matrices = self.structure.blocks();
        for ((block, with), matrices) in self.blocks.iter_mut().zip(&other.blocks).zip(matrices) {
            let overlap = product(with.vectors.transpose(), matrices.mass.times(&block.vectors).as_ref());
            for m in (0..block.vectors.ncols()).filter(|&m| overlap[(m, m)] < 0.0) {
                block.vectors.col_as_slice_mut(m).iter_mut().for_each(|value| *value = -*value);
            }
        }
        self
    }

    /// Values of the modes of a block in some rows: a row each, a column a mode.
    pub(super) fn rows(&self, block: usize, rows: &[Row]) -> Result<Mat<f64>, ModelError> {
        let Some(modes) = self.blocks.get(block) else { return Ok(Mat::new()) };
        let matrix = coordinate_rows(self.structure.as_ref(), (block, modes.vectors.nrows()), rows)?;
        Ok(product(matrix.as_ref(), modes.vectors.as_ref()))
    }
}
