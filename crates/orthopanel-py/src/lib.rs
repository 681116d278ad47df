#![doc = include_str!("../README.md")]

mod arrays;
mod error;
mod fit;
mod fork;
mod header;
mod model;
mod pair;
mod settings;
mod test;
mod traced;
mod work;

use std::ffi::OsString;

use pyo3::prelude::*;

/// The command with these words, the first of which is the program's name; gives its exit status.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<OsString>) -> PyResult<u8> {
    error::guarded(|| py.detach(|| orthopanel_cli::main(words)))
}

/// Computes on no more threads than these, unless the process computes already, on those that it has; how many there are.
#[pyfunction]
fn limit_threads(count: usize) -> usize {
    fork::limit(count)
}

/// What the package is made of; users import `orthopanel`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    fork::born();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<test::Test>()?;
    module.add_class::<fit::Fit>()?;
    module.add_class::<traced::Traced>()?;
    module.add_class::<model::Model>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(limit_threads, module)?)
}
