//! Refusals as Python exceptions, which `orthopanel._errors` makes.

use std::io::ErrorKind;
use std::panic::{AssertUnwindSafe, catch_unwind};

use orthopanel::Error;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The name by which `orthopanel._errors` knows a kind of refusal.
fn kind(refused: &Error) -> &'static str {
    match refused {
        Error::Unreadable { source, .. } if source.kind() == ErrorKind::NotFound => "missing",
        Error::Data(orthopanel::data::DataError::Unreadable { source, .. })
        | Error::Identify {
            source: orthopanel_identify::IdentifyError::Data(orthopanel::data::DataError::Unreadable { source, .. }),
            ..
        } => {
            if source.kind() == ErrorKind::NotFound {
                "missing"
            } else {
                "file"
            }
        }
        Error::Unreadable { .. }
        | Error::Unwritable { .. }
        | Error::NotPutBack { .. }
        | Error::OutputIsInput { .. }
        | Error::Changed { .. } => "file",
        Error::Interrupted => "interrupted",
        refused if refused.says_no() => "refused",
        _ => "input",
    }
}

/// The exception for a refusal.
pub fn raised(py: Python<'_>, refused: &Error) -> PyErr {
    let made = || {
        let about = PyDict::new(py);
        about.set_item("file", refused.path())?;
        about.set_item("line", refused.line())?;
        about.set_item("key", refused.key())?;
        about.set_item("way_out", refused.way_out())?;
        let of = py.import("orthopanel._errors")?.getattr("of")?;
        of.call((kind(refused), refused.to_string()), Some(&about))
    };
    match made() {
        Ok(exception) => PyErr::from_value(exception),
        // As where the package is half installed.
        Err(broken) => broken,
    }
}

/// The exception for a fault in an argument.
pub fn input(py: Python<'_>, message: &str, key: &str) -> PyErr {
    let made = || {
        let about = PyDict::new(py);
        about.set_item("key", key)?;
        py.import("orthopanel._errors")?.getattr("of")?.call(("input", message), Some(&about))
    };
    made().map_or_else(|broken| broken, PyErr::from_value)
}

/// What a panic leaves: a fault of this package, which its user can do nothing about, and no crash.
pub fn fault() -> PyErr {
    PyRuntimeError::new_err("orthopanel: a fault of the package itself: please report it with what you called")
}

/// What `work` gives.
///
/// # Errors
/// `RuntimeError` where it panics.
pub fn guarded<T>(work: impl FnOnce() -> T) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|_| fault())
}

/// As [`guarded`], of work that may be refused.
pub fn answered<T>(py: Python<'_>, work: impl FnOnce() -> Result<T, Error>) -> PyResult<T> {
    guarded(work)?.map_err(|refused| raised(py, &refused))
}
