//! The law of the plate: from six elastic constants to six plate stiffnesses.

use faer::Mat;

use crate::{Constant, ModelError, SHEAR_COEFFICIENT};

/// The constants of the plate, in the order in which every list of them stands.
pub const PLATE_CONSTANTS: [Constant; 6] = [
    Constant { name: "e_x", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "e_y", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "nu_xy", unit: "1", low: 0.0, high: 0.95 },
    Constant { name: "g_xy", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "g_yz", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "g_zx", unit: "Pa", low: 1e3, high: 1e15 },
];

/// $D_{11}, D_{22}, D_{12}, D_{66}$ \[N m\], $A_{55}, A_{44}$ \[N/m\] of a plate of this thickness.
///
/// # Errors
/// [`ModelError::ConstantCount`], and [`ModelError::IndefiniteLaw`] where $\nu_{xy}^2E_y \ge E_x$.
pub(super) fn plate_stiffnesses(thickness: f64, values: &[f64]) -> Result<[f64; 6], ModelError> {
    let [e_x, e_y, nu_xy, g_xy, g_yz, g_zx] = six(values)?;
    let per_modulus = thickness.powi(3) / 12.0;
    let rest = definite_rest(e_x, e_y, nu_xy)?;
    let shear = SHEAR_COEFFICIENT * thickness;
    Ok([
        per_modulus * e_x / rest,
        per_modulus * e_y / rest,
        per_modulus * nu_xy * e_y / rest,
        per_modulus * g_xy,
        shear * g_zx,
        shear * g_yz,
    ])
}

/// Derivatives of [`plate_stiffnesses`]: a row a stiffness, a column a constant.
///
/// # Errors
/// As [`plate_stiffnesses`].
pub(super) fn plate_stiffness_derivatives(thickness: f64, values: &[f64]) -> Result<Mat<f64>, ModelError> {
    let [e_x, e_y, nu_xy, ..] = six(values)?;
    let per_modulus = thickness.powi(3) / 12.0;
    let rest = definite_rest(e_x, e_y, nu_xy)?;
    let q = 1.0 - rest;
    let ratio = e_y / e_x;
    let scale = per_modulus / (rest * rest);
    let by_nu = 2.0 * nu_xy * e_y * scale;
    let d_11 = [(1.0 - 2.0 * q) * scale, nu_xy * nu_xy * scale, by_nu];
    let d_22 = [-q * ratio * scale, scale, by_nu * ratio];
    let d_12 = [nu_xy * d_22[0], nu_xy * d_22[1], nu_xy * d_22[2] + per_modulus * e_y / rest];
    let mut derivatives = Mat::zeros(6, 6);
    for (row, bending) in [d_11, d_22, d_12].into_iter().enumerate() {
        for (column, value) in bending.into_iter().enumerate() {
            derivatives[(row, column)] = value;
        }
    }
    derivatives[(3, 3)] = per_modulus;
    derivatives[(4, 5)] = SHEAR_COEFFICIENT * thickness;
    derivatives[(5, 4)] = SHEAR_COEFFICIENT * thickness;
    Ok(derivatives)
}

fn six(values: &[f64]) -> Result<[f64; 6], ModelError> {
    values.try_into().map_err(|_| ModelError::ConstantCount { found: values.len(), expected: 6 })
}

/// $1 - \nu_{xy}\nu_{yx}$ with $\nu_{yx} = \nu_{xy}E_y/E_x$.
fn definite_rest(e_x: f64, e_y: f64, nu_xy: f64) -> Result<f64, ModelError> {
    let rest = 1.0 - nu_xy * nu_xy * e_y / e_x;
    if rest > 0.0 { Ok(rest) } else { Err(ModelError::IndefiniteLaw { e_x, e_y, nu_xy, limit: (e_x / e_y).sqrt() }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HONEYCOMB: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];

    #[test]
    fn val_isotropic_plate_has_the_textbook_stiffness() {
        let (e, nu, t) = (7e10, 0.3, 0.01);
        let g = e / (2.0 * (1.0 + nu));
        let [d_11, d_22, d_12, d_66, a_55, a_44] =
            plate_stiffnesses(t, &[e, e, nu, g, g, g]).expect("an isotropic plate");
        let d = e * t.powi(3) / (12.0 * (1.0 - nu * nu));
        for (found, expected) in [
            (d_11, d),
            (d_22, d),
            (d_12, nu * d),
            (d_66, 0.5 * (1.0 - nu) * d),
            (a_55, g * t / 1.5),
            (a_44, g * t / 1.5),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn val_derivatives_are_those_of_differences() {
        let exact = plate_stiffness_derivatives(0.03, &HONEYCOMB).expect("a definite law");
        for (column, &value) in HONEYCOMB.iter().enumerate() {
            let at = |factor: f64| {
                let mut values = HONEYCOMB;
                values[column] = value * factor;
                plate_stiffnesses(0.03, &values).expect("a definite law")
            };
            let (low, high) = (at(1.0 - 1e-5), at(1.0 + 1e-5));
            for row in 0..6 {
                let quotient = (high[row] - low[row]) / 2e-5;
                let own = exact[(row, column)] * value;
                assert!((quotient - own).abs() < 1e-8 * high[row], "{row} {column}: {quotient} {own}");
            }
        }
    }

    #[test]
    fn an_indefinite_law_is_refused_with_its_limit() {
        let error = plate_stiffnesses(0.03, &[1e9, 4e9, 0.5, 1e9, 1e9, 1e9]).expect_err("indefinite");
        assert_eq!(
            error.to_string(),
            "nu_xy = 0.5 with e_x = 1e9 Pa and e_y = 4e9 Pa has no definite law: nu_xy must lie below \
             sqrt(e_x / e_y) = 0.5000"
        );
    }
}
