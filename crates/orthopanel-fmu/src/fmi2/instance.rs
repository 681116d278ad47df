//! FMI 2.0, 2.1: life of an instance.

use std::ffi::c_int;

use super::{Boolean, Callbacks, Pointer, Text};
use crate::FmuError;
use crate::boundary::{self, Instantiation, c_text, entries, transitions};
use crate::component::Interface;
use crate::logging::{Category, Sink};
use crate::resource_location::from_uri;

const MODEL_EXCHANGE: c_int = 0;
const CO_SIMULATION: c_int = 1;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    name: Text,
    kind: c_int,
    guid: Text,
    location: Text,
    functions: *const Callbacks,
    _visible: Boolean,
    logging_on: Boolean,
) -> Pointer {
    // SAFETY: null, or the importer's callbacks.
    let Some(&callbacks) = (unsafe { functions.as_ref() }) else {
        return std::ptr::null_mut();
    };
    // SAFETY: null or a C string. Without a name the logger is given an empty one, and the call is refused below.
    let instance_name = unsafe { boundary::text(name, "instanceName") };
    let given = Instantiation {
        call: "fmi2Instantiate",
        interface: if kind == MODEL_EXCHANGE { Interface::ModelExchange } else { Interface::CoSimulation },
        token: guid,
        location,
        to_folder: from_uri,
        logging_on: logging_on != 0,
    };
    let sink = sink(callbacks, instance_name.as_ref().copied().unwrap_or_default());
    let check = || match kind {
        MODEL_EXCHANGE | CO_SIMULATION => instance_name.map(drop),
        _ => Err(FmuError::NotOffered("<ModelExchange> and <CoSimulation>: pass one of these as fmuType")),
    };
    // SAFETY: null or C strings of the importer.
    unsafe { boundary::instantiate(&given, sink, check) }
}

fn sink(callbacks: Callbacks, name: &str) -> Sink {
    let name = c_text(name);
    Box::new(move |category: Category, message: &str| {
        if let Some(logger) = callbacks.logger {
            // The logger takes a printf format: a per cent sign of ours must not start a conversion.
            let (label, message) = (c_text(category.name()), c_text(&message.replace('%', "%%")));
            // SAFETY: the importer's logger with the environment it gave; the texts live through the call.
            unsafe {
                logger(callbacks.environment, name.as_ptr(), category.status(), label.as_ptr(), message.as_ptr());
            }
        }
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeInstance(c: Pointer) {
    // SAFETY: null or a live instance, under the FMI contract.
    unsafe { boundary::free(c) }
}

entries! {
    fmi2SetDebugLogging(on: Boolean, count: usize, categories: *const Text) |instance| {
        boundary::set_logging(instance, on != 0, count, categories)
    };
    fmi2SetupExperiment(
        tolerance_defined: Boolean, tolerance: f64, start: f64, stop_defined: Boolean, stop: f64
    ) |instance| {
        let tolerance = (tolerance_defined != 0).then_some(tolerance);
        instance.component.set_experiment(tolerance, start, (stop_defined != 0).then_some(stop))
    };
}

transitions! {
    fmi2EnterInitializationMode: enter_initialization, "initialization begins";
    fmi2ExitInitializationMode: exit_initialization, "initialized";
    fmi2Terminate: terminate, "terminated";
    fmi2Reset: reset, "reset";
}
