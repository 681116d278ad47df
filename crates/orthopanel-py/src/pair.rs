//! A record measured and calculated.

use numpy::{Complex64, PyArray1};
use orthopanel_identify::AcceleranceFit;
use pyo3::prelude::*;

/// A record measured and calculated: piece, places of force and response, frequency, measured, model.
pub type Pair<'py> = (
    usize,
    [(f64, f64); 2],
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<Complex64>>,
    Bound<'py, PyArray1<Complex64>>,
);

pub fn pair<'py>(py: Python<'py>, of: &AcceleranceFit) -> Pair<'py> {
    (
        of.piece,
        [of.force_at, of.response_at].map(|place| (place.x, place.y)),
        PyArray1::from_slice(py, &of.frequency),
        PyArray1::from_slice(py, &of.measured),
        PyArray1::from_slice(py, &of.model),
    )
}
