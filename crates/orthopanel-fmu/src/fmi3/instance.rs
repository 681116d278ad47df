//! FMI 3.0, 2.3: life of an instance.

use super::{Boolean, LogMessage, Pointer, Reference, Text, Unused};
use crate::FmuError;
use crate::boundary::{self, Instantiation, Status, c_text};
use crate::logging::{Category, Sink};
use crate::resource_location::from_path;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: Text,
    token: Text,
    resources: Text,
    _visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    _early_return_allowed: Boolean,
    _intermediate: *const Reference,
    intermediate_count: usize,
    environment: Pointer,
    log_message: LogMessage,
    _intermediate_update: Unused,
) -> Pointer {
    let given = Instantiation {
        call: "fmi3InstantiateCoSimulation",
        token,
        location: resources,
        to_folder: from_path,
        logging_on: logging_on != 0,
    };
    let check = || {
        // SAFETY: null or a C string of the importer.
        unsafe { boundary::text(name, "instanceName") }?;
        if event_mode_used != 0 {
            return Err(FmuError::NotOffered("hasEventMode = false: pass eventModeUsed = false"));
        }
        if intermediate_count > 0 {
            return Err(FmuError::NotOffered("providesIntermediateUpdate = false: require no intermediate variables"));
        }
        Ok(())
    };
    // SAFETY: null or C strings of the importer.
    unsafe { boundary::instantiate(&given, sink(environment, log_message), check) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateModelExchange(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: Pointer,
    log_message: LogMessage,
) -> Pointer {
    not_instantiated(sink(environment, log_message), "fmi3InstantiateModelExchange")
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: Text,
    _token: Text,
    _resources: Text,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: Pointer,
    log_message: LogMessage,
    _clock_update: Unused,
    _lock_preemption: Unused,
    _unlock_preemption: Unused,
) -> Pointer {
    not_instantiated(sink(environment, log_message), "fmi3InstantiateScheduledExecution")
}

fn not_instantiated(sink: Sink, call: &str) -> Pointer {
    let error = FmuError::NotOffered("<CoSimulation> only: call fmi3InstantiateCoSimulation");
    sink(Category::Error, &format!("{call}: {error}"));
    std::ptr::null_mut()
}

fn sink(environment: Pointer, log_message: LogMessage) -> Sink {
    Box::new(move |category: Category, message: &str| {
        if let Some(log_message) = log_message {
            let (label, message) = (c_text(category.name()), c_text(message));
            // SAFETY: the importer's logger with the environment it gave; the texts live through the call.
            unsafe { log_message(environment, category.status(), label.as_ptr(), message.as_ptr()) }
        }
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(instance: Pointer) {
    // SAFETY: null or a live instance, under the FMI contract.
    unsafe { boundary::free(instance) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Pointer,
    on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: a live instance and `count` C strings, under the FMI contract.
    unsafe {
        boundary::call(instance, "fmi3SetDebugLogging", |instance| {
            boundary::set_logging(instance, on != 0, count, categories)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: Pointer,
    _tolerance_defined: Boolean,
    _tolerance: f64,
    start: f64,
    stop_defined: Boolean,
    stop: f64,
) -> Status {
    let stop = (stop_defined != 0).then_some(stop);
    // SAFETY: a live instance, under the FMI contract.
    unsafe {
        boundary::call(instance, "fmi3EnterInitializationMode", |instance| {
            instance.component.set_experiment(start, stop)?;
            instance.component.enter_initialization()?;
            instance.logger.log(Category::Events, "initialization begins");
            Ok(())
        })
    }
}

/// Defines calls that take the instance alone.
macro_rules! transitions {
    ($($name:ident: $method:ident, $event:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: Pointer) -> Status {
            // SAFETY: a live instance, under the FMI contract.
            unsafe {
                boundary::call(instance, stringify!($name), |instance| {
                    instance.component.$method()?;
                    instance.logger.log(Category::Events, $event);
                    Ok(())
                })
            }
        }
    )*};
}

transitions! {
    fmi3ExitInitializationMode: exit_initialization, "initialized";
    fmi3Terminate: terminate, "terminated";
    fmi3Reset: reset, "reset";
}
