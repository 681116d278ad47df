//! A plate at one set of constants: for what is asked of these alone.

use faer::Mat;

use super::assembly::Products;
use super::{MindlinPlate, PLATE_CONSTANTS, PlateTerms};
use crate::structure::{Block, Structure};
use crate::{Boundary, Constant, ModelError, Piece, Place};

/// An even plate whose stiffness stands as one matrix: of the wide bases that static answers want, six would be most of the work.
///
/// Its one coefficient is 1, and it knows no constants but those that it was made with.
pub(crate) struct FixedPlate {
    plate: MindlinPlate,
    values: Vec<f64>,
}

impl FixedPlate {
    /// On the basis of [`MindlinPlate::with_basis_for`].
    ///
    /// # Errors
    /// As there.
    pub(crate) fn with_basis_for(
        piece: &Piece,
        boundary: Boundary,
        values: &[f64],
        count: usize,
    ) -> Result<Self, ModelError> {
        let terms = MindlinPlate::terms_for_basis(piece, boundary, values, count)?;
        let stiffnesses = super::law::plate_stiffnesses(piece.thickness, values)?;
        let even = PlateTerms::default();
        let plate = MindlinPlate::uneven(piece, boundary, terms, Products::All, &even, Some(stiffnesses))?;
        plate.check_thickness(stiffnesses)?;
        Ok(Self { plate, values: values.to_vec() })
    }
}

impl Structure for FixedPlate {
    fn constants(&self) -> &'static [Constant] {
        &PLATE_CONSTANTS
    }

    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        if values == self.values {
            return Ok(vec![1.0]);
        }
        Err(ModelError::Unsupported("other constants than those that a plate was fixed at".into()))
    }

    fn coefficient_derivatives(&self, _values: &[f64]) -> Result<Mat<f64>, ModelError> {
        Err(ModelError::Unsupported("derivatives of a plate that was fixed at some constants".into()))
    }

    fn blocks(&self) -> &[Block] {
        &self.plate.blocks
    }

    fn shape_row(&self, block: usize, place: Place) -> Vec<f64> {
        self.plate.shape_row(block, place)
    }
}

#[cfg(test)]
mod tests {
    use super::FixedPlate;
    use crate::static_deflection::static_deflections;
    use crate::{Boundary, MindlinPlate, Piece, Place, Structure};

    /// One matrix in place of a sum of six gives the same answers, to rounding.
    #[test]
    fn val_a_fixed_plate_is_the_plate() {
        let piece = Piece { length: 0.8, width: 0.45, thickness: 0.03, mass_per_area: 6.88 };
        let values = [1.067e10, 0.9e10, 0.3, 4.1e9, 3.0e8, 5.304e8];
        let fixed = FixedPlate::with_basis_for(&piece, Boundary::default(), &values, 20).unwrap();
        let plate = MindlinPlate::with_basis_for(&piece, Boundary::default(), &values, 20).unwrap();
        let place = |x, y| Place { x, y };
        let (forces, responses) = ([place(-0.3, 0.1), place(0.2, 0.0)], [place(0.31, -0.2), place(0.0, 0.0)]);
        let one = static_deflections(&fixed, &values, &forces, &responses).unwrap();
        let six = static_deflections(&plate, &values, &forces, &responses).unwrap();
        let largest = six.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
        for (one, six) in one.iter().flatten().zip(six.iter().flatten()) {
            assert!((one - six).abs() < 1e-12 * largest, "{one:e} {six:e}");
        }
        assert!(fixed.coefficients(&values.map(|value| 1.01 * value)).is_err());
    }
}
