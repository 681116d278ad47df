//! Deflection of any [`Structure`] under a force that stands still, on its basis.

use faer::Mat;

use crate::block_pencil::shift;
use crate::dense::{Cholesky, product};
use crate::ritz_modes::checked_coefficients;
use crate::structure::Block;
use crate::{ModelError, Place, Structure};

/// $\sum_m W_m(r)W_m(f)/\omega_m^2$ \[m/N\] over **all** flexible modes of the structure's basis, without solving for them: a
/// row a response, a column a force.
///
/// $Ku = f - MRR^Tf$ with $R$ the rigid modes and $R^TMu = 0$ is the deflection under a unit force that the inertia of the
/// rigid motion balances.
///
/// Converges with the basis, but for one place alone on a plate that shears: a point force there has no finite deflection,
/// and the sum grows with the logarithm of the number of terms.
///
/// # Errors
/// As [`crate::ritz_modes()`], but for the number of modes.
pub fn static_deflections(
    structure: &dyn Structure,
    values: &[f64],
    forces: &[Place],
    responses: &[Place],
) -> Result<Vec<Vec<f64>>, ModelError> {
    let coefficients = checked_coefficients(structure, values)?;
    let mut sum = Mat::<f64>::zeros(responses.len(), forces.len());
    for (index, block) in structure.blocks().iter().enumerate() {
        let rows = |places: &[Place]| {
            let rows: Vec<Vec<f64>> = places.iter().map(|&place| structure.shape_row(index, place)).collect();
            Mat::from_fn(block.size(), places.len(), |i, place| rows[place][i])
        };
        let deflected = deflected(block, &coefficients, rows(forces))?;
        sum += product(rows(responses).transpose(), deflected.as_ref());
    }
    Ok((0..responses.len()).map(|r| (0..forces.len()).map(|f| sum[(r, f)]).collect()).collect())
}

/// $u$ of one block, a column a force.
fn deflected(block: &Block, coefficients: &[f64], mut loads: Mat<f64>) -> Result<Mat<f64>, ModelError> {
    let size = block.size();
    let mut stiffness = Mat::<f64>::zeros(size, size);
    for (matrix, &coefficient) in block.stiffness.iter().zip(coefficients) {
        stiffness += faer::Scale(coefficient) * matrix;
    }
    let rigid = Mat::from_fn(size, block.rigid.len(), |i, n| block.rigid[n][i]);
    let momentum = product(block.mass.as_ref(), rigid.as_ref());
    let shares = product(rigid.transpose(), loads.as_ref());
    loads -= product(momentum.as_ref(), shares.as_ref());
    // A stiffness on the rigid motions alone: the loads do none of them, so it changes nothing but makes K regular.
    let held = shift(&stiffness, &block.mass);
    stiffness += faer::Scale(held) * product(momentum.as_ref(), momentum.transpose());
    let scale: Vec<f64> = (0..size).map(|i| stiffness[(i, i)].sqrt().recip()).collect();
    let scaled = Mat::from_fn(size, size, |i, j| scale[i] * stiffness[(i, j)] * scale[j]);
    let factor = Cholesky::new(&scaled).ok_or(ModelError::Eigenproblem)?;
    let mut deflected = Mat::from_fn(size, loads.ncols(), |i, f| scale[i] * loads[(i, f)]);
    factor.solve_lower(&mut deflected);
    factor.solve_upper(&mut deflected);
    Ok(Mat::from_fn(size, loads.ncols(), |i, f| scale[i] * deflected[(i, f)]))
}
