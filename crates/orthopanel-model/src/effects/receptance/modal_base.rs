//! All modes of a structure's basis, with how stiffness and mass couple them when a parameter changes.

use std::sync::Arc;

use faer::Mat;

use super::moved_structure::Moved;
use super::view::SERIES_TERMS;
use crate::dense::product;
use crate::ritz_modes::all_ritz_modes;
use crate::structure::{Motion, Structure};
use crate::{ModelError, Place, SymmetricMatrix};

/// What moves, and where.
pub(in crate::effects) type Row = (Motion, Place);

/// Modes of one block, rigid ones first, and $\kappa = \Phi^T\partial K\,\Phi$, $\mu = \Phi^T\partial M\,\Phi$ for each
/// parameter of the structure.
pub(in crate::effects) struct BlockModes {
    /// $\omega^2$, zero for the rigid modes.
    pub lambda: Vec<f64>,
    /// Coordinates, a column a mode.
    pub vectors: Mat<f64>,
    /// $\kappa$ and $\mu$; an empty matrix where the parameter does not enter.
    pub couplings: Vec<[Mat<f64>; 2]>,
    /// The modes of this block that are summed: position in [`ModalBase::near`], and number in the block.
    pub near: Vec<(usize, usize)>,
    /// Numbers of the others.
    pub far: Vec<usize>,
    /// $\lambda^{-(k+1)}$ of the far modes, a column each $k$.
    pub powers: Mat<f64>,
    /// What each parameter does to the summed modes and to the series of the others.
    pub turns: Vec<Turn>,
}

/// What one parameter does to the modes of a block.
pub(in crate::effects) struct Turn {
    /// $d\lambda$ of the summed modes.
    pub lambda: Vec<f64>,
    /// Share of every mode of the block in the derivative of each summed one's shape.
    pub near: Mat<f64>,
    /// Share of each summed mode in the derivative of each far one's shape.
    pub far: Mat<f64>,
    /// $\kappa$ and $\mu$ between the far modes; empty where the parameter does not enter.
    pub between: [Mat<f64>; 2],
}

/// A structure that several modal bases may share.
pub(in crate::effects) type SharedStructure = Arc<dyn Structure + Send + Sync>;

/// The modes of a structure at some values of its constants.
pub(in crate::effects) struct ModalBase {
    pub structure: SharedStructure,
    pub values: Vec<f64>,
    pub blocks: Vec<BlockModes>,
    /// The modes that are summed at every line: block and number in it; rigid ones first, then rising.
    pub near: Vec<(usize, usize)>,
    /// How many of `near` are rigid.
    pub rigid: usize,
    /// Number of parameters: the constants, then the terms of the structure that were asked for.
    pub parameters: usize,
    /// Positions in [`Structure::term_derivatives`] of those terms.
    pub terms: Vec<usize>,
    /// Parameters with which the coordinates themselves move, by their number.
    pub moved: Vec<(usize, Moved)>,
}

impl ModalBase {
    /// With the rigid modes and `summed` flexible ones to be summed, and the structure's own terms of these numbers among
    /// the parameters.
    pub(in crate::effects) fn new(
        structure: &SharedStructure,
        values: &[f64],
        summed: usize,
        terms: &[usize],
        moved: &[Moved],
    ) -> Result<Self, ModelError> {
        let constants = values.len();
        let modes = all_ritz_modes(structure.as_ref(), values)?;
        let by_constants = structure.coefficient_derivatives(values)?;
        let derivatives = if terms.is_empty() { vec![] } else { structure.term_derivatives(values) };
        let coefficients = structure.coefficients(values)?;
        let mut blocks = Vec::new();
        let mut order = Vec::new();
        for (index, block) in structure.blocks().iter().enumerate() {
            let own: Vec<_> = modes.iter().filter(|mode| mode.block == index).collect();
            let lambda: Vec<f64> = own.iter().map(|mode| mode.angular_frequency.powi(2)).collect();
            let vectors = Mat::from_fn(block.size(), own.len(), |i, m| own[m].coordinates[i]);
            let in_modes =
                |matrix: &Mat<f64>| product(vectors.transpose(), product(matrix.as_ref(), vectors.as_ref()).as_ref());
            let projected = |matrix: &SymmetricMatrix| matrix.congruent(&vectors);
            let stiffness: Vec<Mat<f64>> = block.stiffness.iter().map(projected).collect();
            let of_constant = |j: usize| {
                let mut sum = Mat::zeros(own.len(), own.len());
                for (i, matrix) in stiffness.iter().enumerate() {
                    sum += faer::Scale(by_constants[(i, j)]) * matrix;
                }
                [sum, Mat::new()]
            };
            let mut couplings: Vec<[Mat<f64>; 2]> = (0..constants).map(of_constant).collect();
            for &term in terms {
                if let Some(change) = moved.iter().find(|change| change.term == term) {
                    couplings.push(change.matrices(index, &coefficients).map(|matrix| in_modes(&matrix)));
                    continue;
                }
                let Some(by) = derivatives.get(term) else { continue };
                couplings.push([&by.stiffness, &by.mass].map(|list| list.get(index).map_or(Mat::new(), in_modes)));
            }
            order.extend(lambda.iter().enumerate().map(|(number, &lambda)| (lambda, index, number)));
            let (near, far, powers, turns) = (vec![], vec![], Mat::new(), vec![]);
            blocks.push(BlockModes { lambda, vectors, couplings, near, far, powers, turns });
        }
        let rigid = order.iter().filter(|(lambda, ..)| *lambda == 0.0).count();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        if rigid + summed >= order.len() {
            return Err(ModelError::BasisTooSmall { asked: summed, available: (order.len() - rigid) / 2 });
        }
        let near: Vec<_> = order.iter().take(rigid + summed).map(|&(_, block, number)| (block, number)).collect();
        blocks.iter_mut().enumerate().for_each(|(index, block)| block.part(index, &near));
        let parameters = constants + terms.len();
        let numbered = |change: &Moved| {
            let position = terms.iter().position(|term| *term == change.term)?;
            Some((constants + position, change.clone()))
        };
        Ok(Self {
            structure: structure.clone(),
            values: values.to_vec(),
            blocks,
            near,
            rigid,
            parameters,
            terms: terms.to_vec(),
            moved: moved.iter().filter_map(numbered).collect(),
        })
    }

    /// The same selection of modes as another base of this structure, with the same signs.
    pub(in crate::effects) fn aligned_with(mut self, other: &Self) -> Self {
        self.near.clone_from(&other.near);
        for (index, block) in self.blocks.iter_mut().enumerate() {
            let (Some(own), Some(with)) = (self.structure.blocks().get(index), other.blocks.get(index)) else {
                continue;
            };
            let overlap = product(with.vectors.transpose(), own.mass.times(&block.vectors).as_ref());
            for m in 0..block.vectors.ncols().min(with.vectors.ncols()) {
                if overlap[(m, m)] >= 0.0 {
                    continue;
                }
                (0..block.vectors.nrows()).for_each(|i| block.vectors[(i, m)] *= -1.0);
                for matrix in block.couplings.iter_mut().flatten().filter(|matrix| matrix.nrows() > 0) {
                    for n in 0..matrix.nrows() {
                        matrix[(m, n)] *= -1.0;
                        matrix[(n, m)] *= -1.0;
                    }
                }
            }
            block.part(index, &self.near);
        }
        self
    }

    /// Values of the modes of a block in some rows: a row each, a column a mode.
    pub(in crate::effects) fn rows(&self, block: usize, rows: &[Row]) -> Result<Mat<f64>, ModelError> {
        let Some(modes) = self.blocks.get(block) else { return Ok(Mat::new()) };
        let matrix = coordinate_rows(self.structure.as_ref(), (block, modes.vectors.nrows()), rows)?;
        Ok(product(matrix.as_ref(), modes.vectors.as_ref()))
    }
}

/// Values of a block's coordinates, `size` of them, in some rows.
pub(in crate::effects) fn coordinate_rows(
    structure: &dyn Structure,
    (block, size): (usize, usize),
    rows: &[Row],
) -> Result<Mat<f64>, ModelError> {
    let mut matrix = Mat::zeros(rows.len(), size);
    for (i, &(motion, place)) in rows.iter().enumerate() {
        let row = structure.motion_row(block, motion, place).ok_or_else(|| {
            ModelError::Unsupported(format!("an effect on the {motion:?} of this structure").to_ascii_lowercase())
        })?;
        row.iter().enumerate().for_each(|(j, &value)| matrix[(i, j)] = value);
    }
    Ok(matrix)
}

impl BlockModes {
    /// Parts the modes into those of `near` that lie in this block, and the others.
    fn part(&mut self, index: usize, near: &[(usize, usize)]) {
        self.near =
            near.iter().enumerate().filter(|(_, (block, _))| *block == index).map(|(m, (_, n))| (m, *n)).collect();
        let is_near = |n: &usize| self.near.iter().any(|(_, near)| near == n);
        self.far = (0..self.lambda.len()).filter(|n| !is_near(n)).collect();
        self.powers = Mat::from_fn(self.far.len(), SERIES_TERMS, |i, k| self.lambda[self.far[i]].powi(-(k as i32 + 1)));
        self.turns = (0..self.couplings.len()).map(|p| self.turn(p)).collect();
    }

    fn turn(&self, p: usize) -> Turn {
        let (all, near, far) = (self.lambda.len(), self.near.len(), self.far.len());
        let between = |kind: usize| {
            let matrix = &self.couplings[p][kind];
            match self.far.first() {
                // The far modes are the upper ones of a block: one piece of the matrix.
                Some(&first) if matrix.nrows() > 0 && self.far[far - 1] == first + far - 1 => {
                    matrix.submatrix(first, first, far, far).to_owned()
                }
                _ => {
                    let size = if matrix.nrows() > 0 { far } else { 0 };
                    Mat::from_fn(size, size, |i, j| matrix[(self.far[i], self.far[j])])
                }
            }
        };
        Turn {
            lambda: self.near.iter().map(|&(_, n)| self.perturbation(p, n, n)).collect(),
            near: Mat::from_fn(all, near, |m, i| self.share(p, m, self.near[i].1)),
            far: Mat::from_fn(near, far, |i, j| self.share(p, self.near[i].1, self.far[j])),
            between: [between(0), between(1)],
        }
    }

    fn entry(&self, p: usize, kind: usize, m: usize, n: usize) -> f64 {
        let matrix = &self.couplings[p][kind];
        if matrix.nrows() > 0 { matrix[(m, n)] } else { 0.0 }
    }

    /// $\kappa_{mn} - \lambda_n\mu_{mn}$.
    fn perturbation(&self, p: usize, m: usize, n: usize) -> f64 {
        self.entry(p, 0, m, n) - self.lambda[n] * self.entry(p, 1, m, n)
    }

    /// The share of mode `m` in the derivative of mode `n`'s shape. Modes that coincide, as rigid ones do, only keep
    /// their norm and stay orthogonal.
    fn share(&self, p: usize, m: usize, n: usize) -> f64 {
        let gap = self.lambda[n] - self.lambda[m];
        if gap == 0.0 { -0.5 * self.entry(p, 1, m, n) } else { self.perturbation(p, m, n) / gap }
    }
}
