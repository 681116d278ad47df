//! FMI 3.0, 2.3: life of an instance.

use super::{Boolean, LogMessage, Pointer, Reference, Text, Unused};
use crate::FmuError;
use crate::boundary::{self, Instantiation, c_text, entries, transitions};
use crate::component::Interface;
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
        interface: Interface::CoSimulation,
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
    name: Text,
    token: Text,
    resources: Text,
    _visible: Boolean,
    logging_on: Boolean,
    environment: Pointer,
    log_message: LogMessage,
) -> Pointer {
    let given = Instantiation {
        call: "fmi3InstantiateModelExchange",
        interface: Interface::ModelExchange,
        token,
        location: resources,
        to_folder: from_path,
        logging_on: logging_on != 0,
    };
    // SAFETY: null or C strings of the importer, here and in the check.
    let check = || unsafe { boundary::text(name, "instanceName") }.map(drop);
    unsafe { boundary::instantiate(&given, sink(environment, log_message), check) }
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
    let error = FmuError::NotOffered("<ModelExchange> and <CoSimulation> only: call the function of one of these");
    sink(environment, log_message)(Category::Error, &format!("fmi3InstantiateScheduledExecution: {error}"));
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

entries! {
    fmi3SetDebugLogging(on: Boolean, count: usize, categories: *const Text) |instance| {
        boundary::set_logging(instance, on != 0, count, categories)
    };
    fmi3EnterInitializationMode(
        tolerance_defined: Boolean, tolerance: f64, start: f64, stop_defined: Boolean, stop: f64
    ) |instance| {
        let tolerance = (tolerance_defined != 0).then_some(tolerance);
        instance.component.set_experiment(tolerance, start, (stop_defined != 0).then_some(stop))?;
        instance.component.enter_initialization()?;
        instance.logger.log(Category::Events, "initialization begins");
        Ok(())
    };
}

transitions! {
    fmi3ExitInitializationMode: exit_initialization, "initialized";
    fmi3Terminate: terminate, "terminated";
    fmi3Reset: reset, "reset";
}
