//! Rows: what moves, and where, by the coordinates of a structure.

use std::sync::Arc;

use faer::Mat;

use crate::structure::{Motion, Structure};
use crate::{ModelError, Place};

/// What moves, and where.
pub(super) type Row = (Motion, Place);

/// A structure that several may share.
pub(super) type SharedStructure = Arc<dyn Structure + Send + Sync>;

/// Values of a block's coordinates, `size` of them, in some rows.
///
/// # Errors
/// [`ModelError::Unsupported`] for a row that the structure does not have.
pub(super) fn coordinate_rows(
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
