//! Traces.

use pyo3::prelude::*;

use crate::error::guarded;
use crate::model::Model;
use crate::pair::{Pair, pair};
use crate::work;

/// What the model of a test lacks.
#[pyclass(frozen, module = "orthopanel._native")]
pub struct Traced {
    pub test: orthopanel::Test,
    pub traced: orthopanel::Traced,
}

#[pymethods]
impl Traced {
    fn to_json(&self) -> PyResult<String> {
        guarded(|| self.traced.to_json())
    }

    fn text(&self) -> PyResult<String> {
        guarded(|| self.traced.text())
    }

    fn sentence(&self) -> PyResult<String> {
        guarded(|| self.traced.verdict())
    }

    /// The models after tracing, by the pieces' names.
    fn models(slf: &Bound<'_, Self>, tell: Option<Bound<'_, PyAny>>) -> PyResult<Vec<(String, Model)>> {
        let own: Py<Self> = slf.clone().unbind();
        let models = work::done(slf.py(), tell.as_ref(), move |observer| {
            let Self { test, traced } = own.get();
            traced.models_with(test, observer)
        })?;
        let names = slf.get().test.content().pieces.iter().map(|piece| piece.name.clone());
        Ok(names.zip(models.into_iter().map(Model)).collect())
    }

    /// Each record with the base model, and with the model after tracing.
    fn accelerances<'py>(&self, py: Python<'py>) -> [Vec<Pair<'py>>; 2] {
        let tracing = self.traced.tracing();
        [&tracing.base_accelerances, &tracing.accelerances].map(|pairs| pairs.iter().map(|of| pair(py, of)).collect())
    }
}
