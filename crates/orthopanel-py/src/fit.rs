//! Identifications.

use pyo3::prelude::*;

use crate::error::guarded;
use crate::model::Model;
use crate::pair::{Pair, pair};
use crate::traced::Traced;
use crate::work::at_once;

/// What was identified.
#[pyclass(frozen, module = "orthopanel._native")]
pub struct Fit(pub orthopanel::Identified);

#[pymethods]
impl Fit {
    fn to_json(&self) -> PyResult<String> {
        guarded(|| self.0.to_json())
    }

    fn text(&self) -> PyResult<String> {
        guarded(|| self.0.text())
    }

    fn models(&self) -> PyResult<Vec<(String, Model)>> {
        let names = self.0.found().pieces.iter().map(|piece| piece.name.clone());
        guarded(|| names.zip(self.0.models().into_iter().map(Model)).collect())
    }

    fn accelerances<'py>(&self, py: Python<'py>) -> Vec<Pair<'py>> {
        self.0.found().accelerances.iter().map(|of| pair(py, of)).collect()
    }

    /// The page with what was traced.
    fn page(&self, py: Python<'_>, traced: Bound<'_, Traced>) -> PyResult<String> {
        // Records are read once more: seconds at most.
        let traced = &traced.get().traced;
        at_once(py, || self.0.page(Ok(traced), &orthopanel::Silent))
    }
}
