//! Tests.

use std::path::PathBuf;

use numpy::{Complex64, PyReadonlyArray1, PyReadonlyArray2};
use orthopanel::Analysis;
use orthopanel::data::{Measurement, MeasurementData, RecordedResponse};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

use crate::arrays::{list, place, rows};
use crate::error::{answered, guarded, input};
use crate::fit::Fit;
use crate::header::{Frequencies, Header, ReadAs};
use crate::settings::Words;
use crate::traced::Traced;
use crate::work;

/// A test; nothing changes it.
#[pyclass(frozen, module = "orthopanel._native")]
pub struct Test(pub orthopanel::Test);

/// What Python says, which it has checked: a fault here tells of a word that it passed on.
fn read<T: DeserializeOwned>(py: Python<'_>, json: &str) -> PyResult<T> {
    serde_json::from_str(json).map_err(|error| input(py, &error.to_string(), ""))
}

#[pymethods]
impl Test {
    /// A test without measurements.
    #[new]
    fn new(py: Python<'_>, header: &str) -> PyResult<Self> {
        let header: Header = read(py, header)?;
        answered(py, || orthopanel::Test::of(header.into_test())).map(Self)
    }

    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        answered(py, || orthopanel::Test::load(path)).map(Self)
    }

    #[staticmethod]
    fn from_toml(py: Python<'_>, text: &str, path: PathBuf) -> PyResult<Self> {
        answered(py, || orthopanel::Test::from_toml(text, path)).map(Self)
    }

    #[getter]
    fn path(&self) -> PathBuf {
        self.0.path().to_path_buf()
    }

    #[getter]
    fn pieces(&self) -> Vec<String> {
        self.0.content().pieces.iter().map(|piece| piece.name.clone()).collect()
    }

    /// Files that it names.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.0.content().files().map(PathBuf::from).collect()
    }

    #[getter]
    fn count(&self) -> usize {
        self.0.content().measurements.len()
    }

    #[allow(clippy::too_many_arguments, reason = "as Python calls it")]
    fn with_hits(
        &self,
        py: Python<'_>,
        piece: usize,
        force: PyReadonlyArray2<'_, f64>,
        response: PyReadonlyArray2<'_, f64>,
        sampling_rate: f64,
        places: [(f64, f64); 2],
        read_as: &str,
    ) -> PyResult<Self> {
        let channels = [rows(&force), rows(&response)];
        let records = answered(py, || Ok(RecordedResponse::of_hits(channels, sampling_rate, places.map(place))?))?;
        let records = read::<ReadAs>(py, read_as)?.on(records).map_err(|(told, key)| input(py, &told, key))?;
        self.with(py, Measurement { piece, data: MeasurementData::TimeHistory(records) })
    }

    #[allow(clippy::too_many_arguments, reason = "as Python calls it")]
    fn with_accelerance(
        &self,
        py: Python<'_>,
        piece: usize,
        frequency: PyReadonlyArray1<'_, f64>,
        value: PyReadonlyArray1<'_, Complex64>,
        coherence: Option<PyReadonlyArray1<'_, f64>>,
        places: [(f64, f64); 2],
        read_as: &str,
    ) -> PyResult<Self> {
        let lines = (list(&frequency), value.as_array().to_vec(), coherence.as_ref().map(list));
        let records = answered(py, || Ok(RecordedResponse::of_lines(lines.0, lines.1, lines.2, places.map(place))?))?;
        let records = read::<ReadAs>(py, read_as)?.on(records).map_err(|(told, key)| input(py, &told, key))?;
        self.with(py, Measurement { piece, data: MeasurementData::Accelerance(records) })
    }

    fn with_frequencies(&self, py: Python<'_>, piece: usize, frequencies: &str) -> PyResult<Self> {
        let list: Frequencies = read(py, frequencies)?;
        self.with(py, Measurement { piece, data: MeasurementData::NaturalFrequencies(list.into()) })
    }

    fn identify(&self, py: Python<'_>, words: &str, tell: Option<Bound<'_, PyAny>>) -> PyResult<Fit> {
        let settings = read::<Words>(py, words)?.settings().map_err(|(told, key)| input(py, &told, key))?;
        let test = self.0.clone();
        work::done(py, tell.as_ref(), move |observer| test.identify_with(settings, observer)).map(Fit)
    }

    fn trace(
        &self,
        py: Python<'_>,
        reference: Option<Bound<'_, Test>>,
        tell: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Traced> {
        let (test, reference) = (self.0.clone(), reference.map(|reference| reference.get().0.clone()));
        let of = test.clone();
        let traced = work::done(py, tell.as_ref(), move |observer| test.trace_with(reference.as_ref(), observer))?;
        Ok(Traced { test: of, traced })
    }

    /// The page of the test, as `orthopanel report` writes it.
    fn page(&self, py: Python<'_>, words: &str, tell: Option<Bound<'_, PyAny>>) -> PyResult<String> {
        let settings = read::<Words>(py, words)?.settings().map_err(|(told, key)| input(py, &told, key))?;
        let test = self.0.clone();
        work::done(py, tell.as_ref(), move |observer| Analysis::of(&test, None, settings, observer)?.page(observer))
    }
}

impl Test {
    fn with(&self, py: Python<'_>, measurement: Measurement) -> PyResult<Self> {
        let mut test = guarded(|| self.0.clone())?;
        answered(py, move || test.add(measurement).map(|()| test)).map(Self)
    }
}
