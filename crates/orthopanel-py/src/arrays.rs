//! Arrays as the facade takes them.

use numpy::ndarray::Array2;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use orthopanel::Place;

/// A row a list, of an array in any order of memory.
pub fn rows(array: &PyReadonlyArray2<'_, f64>) -> Vec<Vec<f64>> {
    array.as_array().rows().into_iter().map(|row| row.to_vec()).collect()
}

pub fn list(array: &PyReadonlyArray1<'_, f64>) -> Vec<f64> {
    array.as_array().to_vec()
}

pub fn place((x, y): (f64, f64)) -> Place {
    Place { x, y }
}

/// Rows of one length as an array; `columns` where there is no row.
pub fn matrix(rows: &[Vec<f64>], columns: usize) -> Array2<f64> {
    let columns = rows.first().map_or(columns, Vec::len);
    let value = |(row, column): (usize, usize)| rows.get(row).and_then(|row| row.get(column)).copied().unwrap_or(0.0);
    Array2::from_shape_fn((rows.len(), columns), value)
}
