//! Models.

use std::path::PathBuf;

use numpy::ndarray::Array2;
use numpy::{Complex64, IntoPyArray as _, PyArray1, PyArray2, PyReadonlyArray1};
use orthopanel::{FmiVersion, FmuOptions, ModeRange, Place, Ports};
use orthopanel_export::{PortNames, Residual};
use orthopanel_model::VISCOELASTIC_CORE;
use pyo3::prelude::*;

use crate::arrays::{list, matrix, place};
use crate::error::{answered, guarded, input};
use crate::work::at_once;

/// A model; nothing changes it.
#[pyclass(frozen, module = "orthopanel._native")]
pub struct Model(pub orthopanel::Model);

/// A row a mode: number, frequency \[Hz\], nodal lines along x and y, kind, damping ratio.
type ModeRow = (usize, f64, usize, usize, Option<&'static str>, f64);

/// A, B, C and D.
type Matrices<'py> = [Bound<'py, PyArray2<f64>>; 4];

fn range(modes: Option<usize>, up_to: Option<f64>) -> ModeRange {
    match (modes, up_to) {
        (_, Some(frequency)) => ModeRange::UpTo(frequency),
        (Some(count), None) => ModeRange::Count(count),
        (None, None) => orthopanel::USUAL_MODES,
    }
}

/// Places as Python gives them, with names where they have any.
type NamedPlaces = Vec<(Option<String>, (f64, f64))>;

impl Model {
    /// The places given, else the model's own.
    fn ports(
        &self,
        py: Python<'_>,
        forces: Option<&NamedPlaces>,
        responses: Option<&NamedPlaces>,
    ) -> PyResult<(Ports, PortNames)> {
        let own = &self.0.panel().ports;
        let places = |given: Option<&NamedPlaces>, own: &Vec<Place>| match given {
            Some(given) => given.iter().map(|(_, at)| place(*at)).collect(),
            None => own.clone(),
        };
        let names = |given: Option<&NamedPlaces>| match given {
            Some(given) if given.iter().any(|(name, _)| name.is_some()) => {
                given.iter().map(|(name, _)| name.clone()).collect()
            }
            _ => vec![],
        };
        let ports = Ports { forces: places(forces, &own.forces), responses: places(responses, &own.responses) };
        for (places, key) in [(&ports.forces, "forces"), (&ports.responses, "responses")] {
            if places.is_empty() {
                return Err(input(
                    py,
                    &format!("{key}: no place: give one as (x, y) in m, for the model has none"),
                    key,
                ));
            }
            for at in places {
                let told = |refused| input(py, &format!("{key}: {refused}"), key);
                self.0.panel().piece.contains(*at).map_err(told)?;
            }
        }
        Ok((ports, PortNames { forces: names(forces), responses: names(responses) }))
    }
}

#[pymethods]
impl Model {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        answered(py, || orthopanel::Model::load(path)).map(Self)
    }

    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str, name: PathBuf) -> PyResult<Self> {
        answered(py, || orthopanel::Model::from_json(text, name)).map(Self)
    }

    fn to_json(&self) -> PyResult<String> {
        guarded(|| self.0.to_json())
    }

    #[getter]
    fn name(&self) -> PathBuf {
        self.0.name().to_path_buf()
    }

    fn accelerance<'py>(
        &self,
        py: Python<'py>,
        frequency: PyReadonlyArray1<'py, f64>,
        places: [(f64, f64); 2],
        modes: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let frequency = list(&frequency);
        let (model, modes) = (&self.0, modes.map(ModeRange::Count));
        let values = at_once(py, || model.accelerance_of_modes(&frequency, places.map(place), modes))?;
        Ok(values.into_pyarray(py))
    }

    fn modes(&self, py: Python<'_>, count: usize) -> PyResult<Vec<ModeRow>> {
        let model = &self.0;
        let modes = at_once(py, || model.modes(ModeRange::Count(count)))?;
        let row = |(number, mode): (usize, &orthopanel_model::PanelMode)| {
            let [along_x, along_y] = mode.nodes();
            let zeta = mode.own_damping_ratio().unwrap_or_else(|| model.panel().damping.ratio(number));
            (number, mode.frequency(), along_x, along_y, mode.name().map(|name| name.kind.name()), zeta)
        };
        Ok((1..).zip(modes.iter().filter(|mode| !mode.is_rigid())).map(row).collect())
    }

    fn mode_shape<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let places: Vec<Place> = list(&x).into_iter().zip(list(&y)).map(place).collect();
        let model = &self.0;
        let shape = at_once(py, || model.mode_shape(number, &places))?;
        Ok(shape.into_pyarray(py))
    }

    fn state_space<'py>(
        &self,
        py: Python<'py>,
        modes: Option<usize>,
        up_to: Option<f64>,
        forces: Option<NamedPlaces>,
        responses: Option<NamedPlaces>,
    ) -> PyResult<Matrices<'py>> {
        if self.0.panel().effects.iter().any(|effect| effect.id == VISCOELASTIC_CORE) {
            return Err(input(py, "state_space: a viscoelastic core has no such matrices: export an FMU", "effects"));
        }
        let (ports, _) = self.ports(py, forces.as_ref(), responses.as_ref())?;
        let model = &self.0;
        let found = at_once(py, || model.state_space(range(modes, up_to), &ports))?;
        let states = found.a.len();
        let columns = [states, ports.forces.len(), states, ports.forces.len()];
        let parts = [&found.a, &found.b, &found.c, &found.d];
        let array = |index: usize| -> Array2<f64> { matrix(parts[index], columns[index]) };
        Ok([0, 1, 2, 3].map(|index| array(index).into_pyarray(py)))
    }

    fn sample(&self, py: Python<'_>, count: usize, seed: u64) -> PyResult<Vec<Self>> {
        let model = &self.0;
        let drawn = at_once(py, || model.sample(count, seed))?;
        Ok(drawn.into_iter().map(Self).collect())
    }

    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let model = &self.0;
        at_once(py, || model.save(path))
    }

    #[allow(clippy::too_many_arguments, reason = "as Python calls it")]
    fn export(
        &self,
        py: Python<'_>,
        path: PathBuf,
        fmi: u8,
        modes: Option<usize>,
        up_to: Option<f64>,
        forces: Option<NamedPlaces>,
        responses: Option<NamedPlaces>,
        residual: bool,
        name: Option<String>,
    ) -> PyResult<()> {
        let version = match fmi {
            2 => FmiVersion::Fmi2,
            3 => FmiVersion::Fmi3,
            other => return Err(input(py, &format!("fmi = {other}: must be 2 or 3"), "fmi")),
        };
        let (ports, names) = self.ports(py, forces.as_ref(), responses.as_ref())?;
        let usual = FmuOptions::default();
        let name = name.or_else(|| self.0.panel().name.clone()).unwrap_or(usual.name);
        let residual = if residual { usual.residual } else { Residual::None };
        let options = FmuOptions { name, version, names, residual, ..FmuOptions::default() };
        let model = &self.0;
        at_once(py, || model.export_with(path, range(modes, up_to), &ports, &options))
    }
}
