//! Modes of a [`Structure`] at places, and how they follow the coefficients of the stiffness.

use faer::Mat;

use crate::ritz_modes::all_ritz_modes;
use crate::structure::RitzMode;
use crate::{ModelError, Place, Structure};

/// One flexible mode seen at some places, with exact derivatives by the coefficients $c_i$ of the stiffness:
/// $$\frac{\partial\omega_m^2}{\partial c_i} = \phi_m^TK_i\phi_m,\qquad
/// \frac{\partial\phi_m}{\partial c_i} = \sum_{n\ne m}\phi_n\frac{\phi_n^TK_i\phi_m}{\omega_m^2-\omega_n^2}.$$
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSensitivity {
    /// $\omega_m^2$ \[1/s²\].
    pub omega2: f64,
    /// $\partial\omega_m^2/\partial c_i$.
    pub omega2_by: Vec<f64>,
    /// Deflection at each place \[kg^-1/2\].
    pub shape: Vec<f64>,
    /// Derivative of the deflection at each place, a list a coefficient.
    pub shape_by: Vec<Vec<f64>>,
}

/// Modes of a structure as seen at some places.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitiveModes {
    /// Deflection of each rigid mode at each place.
    pub rigid: Vec<Vec<f64>>,
    /// The flexible modes that were asked for with derivatives, rising.
    pub flexible: Vec<ModeSensitivity>,
    /// $\omega^2$ and deflection at each place of all higher modes of the basis.
    pub higher: Vec<(f64, Vec<f64>)>,
}

/// The modes at these values of the constants: `count` flexible ones with derivatives, the others without.
///
/// Two modes of one block that coincide have no derivative of their own shapes, only of the pair; the sum then leaves
/// the other out.
///
/// # Errors
/// As [`crate::ritz_modes()`].
pub fn sensitive_modes(
    structure: &dyn Structure,
    values: &[f64],
    count: usize,
    places: &[Place],
) -> Result<SensitiveModes, ModelError> {
    // A shape's derivative moves in the whole basis, so all of its modes are needed.
    let modes = all_ritz_modes(structure, values)?;
    let is_rigid = |mode: &&RitzMode| mode.angular_frequency == 0.0;
    // A row of the basis costs far more than a mode's sum over it, and serves every mode of its block.
    let rows: Vec<Vec<Vec<f64>>> = (0..structure.blocks().len())
        .map(|block| places.iter().map(|&place| structure.shape_row(block, place)).collect())
        .collect();
    let at_places = |mode: &RitzMode| -> Vec<f64> {
        let row_sum = |row: &Vec<f64>| row.iter().zip(&mode.coordinates).map(|(value, by)| value * by).sum();
        rows[mode.block].iter().map(row_sum).collect()
    };
    let flexible: Vec<&RitzMode> = modes.iter().filter(|mode| !is_rigid(mode)).collect();
    let shapes: Vec<Vec<f64>> = flexible.iter().map(|mode| at_places(mode)).collect();
    let couplings: Vec<Vec<Mat<f64>>> =
        (0..structure.blocks().len()).map(|block| block_couplings(structure, block, &flexible, count)).collect();
    let position = positions_in_block(&flexible);
    let sensitive = flexible.iter().enumerate().take(count).map(|(m, mode)| {
        let omega2 = mode.angular_frequency.powi(2);
        let by = &couplings[mode.block];
        let omega2_by = by.iter().map(|coupling| coupling[(position[m], position[m])]).collect();
        let shape_by = by.iter().map(|coupling| {
            let mut derivative = vec![0.0; places.len()];
            for (n, other) in flexible.iter().enumerate().filter(|(n, other)| *n != m && other.block == mode.block) {
                let gap = omega2 - other.angular_frequency.powi(2);
                if gap != 0.0 {
                    let share = coupling[(position[n], position[m])] / gap;
                    for (total, value) in derivative.iter_mut().zip(&shapes[n]) {
                        *total += share * value;
                    }
                }
            }
            derivative
        });
        ModeSensitivity { omega2, omega2_by, shape: shapes[m].clone(), shape_by: shape_by.collect() }
    });
    Ok(SensitiveModes {
        rigid: modes.iter().filter(is_rigid).map(at_places).collect(),
        flexible: sensitive.collect(),
        higher: flexible
            .iter()
            .zip(&shapes)
            .skip(count)
            .map(|(mode, shape)| (mode.angular_frequency.powi(2), shape.clone()))
            .collect(),
    })
}

/// Number of each mode among those of its own block.
fn positions_in_block(modes: &[&RitzMode]) -> Vec<usize> {
    let mut next: Vec<usize> = Vec::new();
    let number = |mode: &&RitzMode| {
        if next.len() <= mode.block {
            next.resize(mode.block + 1, 0);
        }
        next[mode.block] += 1;
        next[mode.block] - 1
    };
    modes.iter().map(number).collect()
}

/// $\phi_n^TK_i\phi_m$ of the modes of one block: a row each mode, a column each of those asked for.
fn block_couplings(structure: &dyn Structure, block: usize, modes: &[&RitzMode], count: usize) -> Vec<Mat<f64>> {
    let own: Vec<&&RitzMode> = modes.iter().filter(|mode| mode.block == block).collect();
    let asked = modes.iter().take(count).filter(|mode| mode.block == block).count();
    let Some(matrices) = structure.blocks().get(block) else { return Vec::new() };
    let vectors = Mat::from_fn(matrices.size(), own.len(), |i, n| own[n].coordinates[i]);
    let moved = vectors.subcols(0, asked).to_owned();
    matrices.stiffness.iter().map(|stiffness| vectors.transpose() * stiffness.times(&moved)).collect()
}
