//! Deflection of any [`Structure`](crate::Structure) under a force that stands still, on its basis.

use faer::Mat;

use crate::ModelError;
use crate::block_pencil::{Factor, shift};
use crate::dense::product;
use crate::structure::Block;

/// The stiffness of a block, ready to be solved. $Ku = f - MRR^Tf$ with $R$ the rigid modes and $R^TMu = 0$ is the deflection under a unit force that the
/// inertia of the rigid motion balances: the sum over **all** flexible modes of the basis, without solving for them.
#[derive(Debug)]
pub(crate) struct StaticSolution {
    factor: Factor,
    scale: Vec<f64>,
    rigid: Mat<f64>,
    /// $MR$.
    momentum: Mat<f64>,
}

impl StaticSolution {
    /// # Errors
    /// [`ModelError::Eigenproblem`] where the stiffness is not positive.
    pub(crate) fn new(block: &Block, coefficients: &[f64]) -> Result<Self, ModelError> {
        let size = block.size();
        let mut stiffness = block.stiffness_at(coefficients);
        let rigid = Mat::from_fn(size, block.rigid.len(), |i, n| block.rigid[n][i]);
        let momentum = block.mass.times(&rigid);
        // Springs that just hold the rigid motions: the loads do no work on these, so no spring yields.
        let held = shift(&stiffness, &block.mass);
        for coordinate in held_coordinates(block) {
            stiffness.add_to_diagonal(coordinate, held * block.mass[(coordinate, coordinate)]);
        }
        let scale: Vec<f64> = (0..size).map(|i| stiffness[(i, i)].sqrt().recip()).collect();
        let factor = Factor::new(&stiffness.scaled(&scale)).ok_or(ModelError::Eigenproblem)?;
        Ok(Self { factor, scale, rigid, momentum })
    }

    /// $u$, a column a force.
    pub(crate) fn of(&self, mut loads: Mat<f64>) -> Mat<f64> {
        let shares = product(self.rigid.transpose(), loads.as_ref());
        loads -= product(self.momentum.as_ref(), shares.as_ref());
        for force in 0..loads.ncols() {
            let load = loads.col_as_slice_mut(force);
            load.iter_mut().zip(&self.scale).for_each(|(value, scale)| *value *= scale);
            self.factor.solve_lower(load);
            self.factor.solve_upper(load);
            load.iter_mut().zip(&self.scale).for_each(|(value, scale)| *value *= scale);
        }
        let moved = product(self.momentum.transpose(), loads.as_ref());
        loads - product(self.rigid.as_ref(), moved.as_ref())
    }
}

/// As many coordinates as there are rigid motions, none of which they all leave free.
fn held_coordinates(block: &Block) -> Vec<usize> {
    let weight: Vec<f64> = (0..block.size()).map(|i| block.mass[(i, i)].sqrt()).collect();
    let mut motions = block.rigid.clone();
    let mut held = Vec::new();
    while let Some(motion) = motions.pop() {
        let part = |i: &usize| (motion[*i] * weight[*i]).abs();
        let Some(most) = (0..motion.len()).max_by(|a, b| part(a).total_cmp(&part(b))) else { break };
        held.push(most);
        // What the others do there this motion takes back.
        for other in &mut motions {
            let share = other[most] / motion[most];
            other.iter_mut().zip(&motion).for_each(|(value, own)| *value -= share * own);
        }
    }
    held
}

#[cfg(test)]
mod tests;
