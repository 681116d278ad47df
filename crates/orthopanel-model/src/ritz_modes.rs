//! Modes of any [`Structure`]: one symmetric eigenproblem a block.

use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par, Side};

use crate::structure::{Block, RitzMode, Structure};
use crate::symmetric_eigen::symmetric_eigen;
use crate::{Constant, ModelError};

/// The rigid modes, then the first `count` flexible ones in rising order, at these values of the constants.
///
/// Each block is solved as $\theta$ of $L^{-1}ML^{-T}$ with $LL^T = K + \sigma M$ and $\omega^2 = 1/\theta - \sigma$:
/// the lowest modes are then the largest eigenvalues and come out to rounding, however stiff the highest are.
///
/// # Errors
/// [`ModelError::Constant`] for a value outside its bounds, what [`Structure::coefficients`] refuses,
/// [`ModelError::BasisTooSmall`] where `count` is more than the basis resolves,
/// [`ModelError::Eigenproblem`] where the stiffness is not positive.
pub fn ritz_modes(structure: &dyn Structure, values: &[f64], count: usize) -> Result<Vec<RitzMode>, ModelError> {
    let available = structure.resolved_modes();
    if count > available {
        return Err(ModelError::BasisTooSmall { asked: count, available });
    }
    let mut modes = all_ritz_modes(structure, values)?;
    let rigid: usize = structure.blocks().iter().map(|block| block.rigid.len()).sum();
    modes.truncate(rigid + count);
    Ok(modes)
}

/// The rigid modes, then as many flexible ones as the basis has coordinates left, rising.
pub(crate) fn all_ritz_modes(structure: &dyn Structure, values: &[f64]) -> Result<Vec<RitzMode>, ModelError> {
    check_constants(structure.constants(), values)?;
    let coefficients = structure.coefficients(values)?;
    let mut rigid = Vec::new();
    let mut flexible = Vec::new();
    for (index, block) in structure.blocks().iter().enumerate() {
        for coordinates in &block.rigid {
            rigid.push(RitzMode { angular_frequency: 0.0, block: index, coordinates: coordinates.clone() });
        }
        flexible.extend(flexible_modes(block, index, &coefficients)?);
    }
    flexible.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
    rigid.append(&mut flexible);
    Ok(rigid)
}

fn check_constants(constants: &[Constant], values: &[f64]) -> Result<(), ModelError> {
    if constants.len() != values.len() {
        return Err(ModelError::ConstantCount { found: values.len(), expected: constants.len() });
    }
    constants.iter().zip(values).try_for_each(|(constant, &value)| constant.check(value))
}

fn flexible_modes(block: &Block, index: usize, coefficients: &[f64]) -> Result<Vec<RitzMode>, ModelError> {
    let size = block.size();
    let mut shifted = Mat::<f64>::zeros(size, size);
    for (matrix, &coefficient) in block.stiffness.iter().zip(coefficients) {
        shifted += faer::Scale(coefficient) * matrix;
    }
    let sigma = shift(&shifted, &block.mass);
    shifted += faer::Scale(sigma) * &block.mass;

    // Unit diagonal first: Cholesky then keeps the digits of soft and stiff coordinates alike.
    let scale: Vec<f64> = (0..size).map(|i| shifted[(i, i)].sqrt().recip()).collect();
    if scale.iter().any(|value| !value.is_finite()) {
        return Err(ModelError::Eigenproblem);
    }
    let scaled = |matrix: &Mat<f64>| Mat::from_fn(size, size, |i, j| scale[i] * matrix[(i, j)] * scale[j]);
    let factor = scaled(&shifted).llt(Side::Lower).map_err(|_| ModelError::Eigenproblem)?;
    let lower = factor.L();
    let mut flexibility = scaled(&block.mass);
    solve_lower_triangular_in_place(lower, flexibility.as_mut(), Par::Seq);
    let mut flexibility = flexibility.transpose().to_owned();
    solve_lower_triangular_in_place(lower, flexibility.as_mut(), Par::Seq);
    let symmetric = Mat::from_fn(size, size, |i, j| 0.5 * (flexibility[(i, j)] + flexibility[(j, i)]));

    let (thetas, mut vectors) = symmetric_eigen(&symmetric).ok_or(ModelError::Eigenproblem)?;
    solve_upper_triangular_in_place(lower.transpose(), vectors.as_mut(), Par::Seq);
    // Largest θ first; the rigid modes are the very largest and are replaced by their exact shapes.
    let modes = (0..size).rev().skip(block.rigid.len()).map(|column| {
        let theta = thetas[column];
        let norm = theta.sqrt().recip();
        RitzMode {
            angular_frequency: (1.0 / theta - sigma).max(0.0).sqrt(),
            block: index,
            coordinates: (0..size).map(|row| norm * scale[row] * vectors[(row, column)]).collect(),
        }
    });
    Ok(modes.filter(|mode| mode.angular_frequency.is_finite()).collect())
}

/// A shift of the size of the lowest $\omega^2$: the least Rayleigh quotient of a single coordinate that has stiffness.
fn shift(stiffness: &Mat<f64>, mass: &Mat<f64>) -> f64 {
    let quotients = (0..mass.nrows()).map(|i| stiffness[(i, i)] / mass[(i, i)]);
    let greatest = quotients.clone().fold(0.0, f64::max);
    quotients.filter(|&quotient| quotient > 1e-14 * greatest).fold(greatest, f64::min)
}
