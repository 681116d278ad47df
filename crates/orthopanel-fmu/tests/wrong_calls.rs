//! Calls that an instance must refuse, through the C functions of both versions.
#![expect(unsafe_code, reason = "an importer in Rust calls C functions")]

use std::ffi::{CStr, CString, c_char, c_int};
use std::path::Path;
use std::ptr::null_mut;
use std::sync::Mutex;

use orthopanel_fmu::{RESOURCE_FILE, Resource, content_token};
use orthopanel_model::{ModalModel, Mode, Place, Ports};

use crate::c_functions::*;

const DISCARD: c_int = 2;
const ERROR: c_int = 3;

unsafe extern "C" {
    fn fmi2GetRealStatus(instance: Pointer, kind: c_int, value: *mut f64) -> c_int;
    fn fmi2GetBooleanStatus(instance: Pointer, kind: c_int, value: *mut c_int) -> c_int;
    fn fmi2GetStatus(instance: Pointer, kind: c_int, value: *mut c_int) -> c_int;
    fn fmi2GetContinuousStates(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    fn fmi2GetNominalsOfContinuousStates(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    fn fmi2GetEventIndicators(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    fn fmi2SetDebugLogging(i: Pointer, on: c_int, count: usize, categories: *const *const c_char) -> c_int;
    fn fmi3GetContinuousStates(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    fn fmi3GetNominalsOfContinuousStates(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    fn fmi3GetEventIndicators(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    fn fmi3GetNumberOfContinuousStates(instance: Pointer, count: *mut usize) -> c_int;
    fn fmi3GetNumberOfEventIndicators(instance: Pointer, count: *mut usize) -> c_int;
    fn fmi3SetDebugLogging(i: Pointer, on: u8, count: usize, categories: *const *const c_char) -> c_int;
}

/// The last message of an FMI 3 instance whose environment is the mutex.
unsafe extern "C" fn log(environment: Pointer, _status: c_int, _category: *const c_char, message: *const c_char) {
    // SAFETY: the environment is the mutex that the test gave, the message a C string.
    let (last, message) = unsafe { (&*environment.cast::<Mutex<String>>(), CStr::from_ptr(message)) };
    if let Ok(mut last) = last.lock() {
        *last = message.to_string_lossy().into_owned();
    }
}

/// Writes a panel of one mode; its token, path and URI.
fn write(folder: &Path) -> [CString; 3] {
    let mode = Mode { angular_frequency: 900.0, damping_ratio: 0.01, at_forces: vec![1.0], at_responses: vec![1.0] };
    let places = || vec![Place { x: 0.1, y: 0.0 }];
    let model = ModalModel::new(1, 1, vec![mode]).expect("a sound model");
    let resource =
        Resource::new(model, Ports { forces: places(), responses: places() }).expect("as many places as ports");
    let text = resource.to_json();
    std::fs::write(folder.join(RESOURCE_FILE), &text).expect("written");
    let path = folder.to_str().expect("UTF-8");
    [content_token(text.as_bytes()), path.into(), format!("file://{path}")]
        .map(|text| CString::new(text).expect("no NUL"))
}

/// An instance of FMI 2.0; `kind` is 0 for model exchange and 1 for co-simulation.
fn of_fmi2([token, _, uri]: &[CString; 3], kind: c_int) -> Pointer {
    // SAFETY: C strings and callbacks that live through the call.
    let pointer =
        unsafe { fmi2Instantiate(c"panel".as_ptr(), kind, token.as_ptr(), uri.as_ptr(), &[null_mut(); 5], 0, 0) };
    assert!(!pointer.is_null());
    pointer
}

#[test]
fn regress_null_pointers_in_status_calls_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let instance = of_fmi2(&write(folder.path()), 1);
    let (mut real, mut whole) = (1.0, 1);
    // SAFETY: null, or a live instance and places for the answers.
    unsafe {
        assert_eq!(fmi2GetRealStatus(instance, 2, null_mut()), ERROR);
        assert_eq!(fmi2GetBooleanStatus(instance, 3, null_mut()), ERROR);
        assert_eq!(fmi2GetStatus(instance, 0, null_mut()), ERROR);
        assert_eq!(fmi2GetRealStatus(null_mut(), 2, null_mut()), ERROR);
        assert_eq!(fmi2GetRealStatus(null_mut(), 2, &mut real), ERROR);
        assert_eq!(fmi2GetRealStatus(instance, 1, &mut real), DISCARD);
        assert_eq!(fmi2GetStatus(instance, 0, &mut whole), DISCARD);
        assert_eq!(fmi2GetRealStatus(instance, 2, &mut real), 0);
        assert_eq!(fmi2GetBooleanStatus(instance, 3, &mut whole), 0);
        fmi2FreeInstance(instance);
    }
    assert_eq!((real, whole), (0.0, 0));
}

/// An initialized instance of FMI 3.0 for co-simulation that logs to `last`, which outlives it.
fn of_fmi3([token, path, _]: &[CString; 3], last: &Mutex<String>) -> Pointer {
    let (environment, logger) = ((&raw const *last).cast_mut().cast(), log as *mut std::ffi::c_void);
    let (name, no): (_, Pointer) = (c"panel".as_ptr(), null_mut());
    // SAFETY: C strings that live through the calls, and an environment that outlives the instance.
    unsafe {
        let (token, path) = (token.as_ptr(), path.as_ptr());
        let instance =
            fmi3InstantiateCoSimulation(name, token, path, 0, 0, 0, 0, no.cast(), 0, environment, logger, no);
        assert!(!instance.is_null());
        assert_eq!(fmi3EnterInitializationMode(instance, 0, 0.0, 0.0, 0, 0.0), 0);
        assert_eq!(fmi3ExitInitializationMode(instance), 0);
        instance
    }
}

/// Reference of `force_1` in every panel of one force: behind `time` and `force_linear`.
static FORCE: u32 = 3;

#[test]
fn regress_null_lists_of_variables_and_values_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = write(folder.path());
    let last = Mutex::new(String::new());
    let (two, three) = (of_fmi2(&fmu, 1), of_fmi3(&fmu, &last));
    let said = || std::mem::take(&mut *last.lock().expect("sound"));
    let (force, mut value) = (&raw const FORCE, 3.0);
    let (no_references, nowhere): (*const u32, *mut f64) = (std::ptr::null(), null_mut());
    // SAFETY: null, or live instances with lists of one entry.
    unsafe {
        assert_eq!(fmi2EnterInitializationMode(two), 0);
        assert_eq!(fmi2ExitInitializationMode(two), 0);
        assert_eq!(fmi2SetReal(two, force, 1, &value), 0);
        assert_eq!(fmi3SetFloat64(three, force, 1, &value, 1), 0);
        value = 7.0;
        assert_eq!(fmi2GetReal(two, no_references, 1, &mut value), ERROR);
        assert_eq!(fmi2GetReal(two, force, 1, nowhere), ERROR);
        assert_eq!(fmi2SetReal(two, no_references, 1, &value), ERROR);
        assert_eq!(fmi2SetReal(two, force, 1, nowhere), ERROR);
        assert_eq!(fmi2GetReal(null_mut(), force, 1, &mut value), ERROR);
        assert_eq!(fmi2SetReal(null_mut(), force, 1, &value), ERROR);
        assert_eq!(fmi3GetFloat64(three, no_references, 1, &mut value, 1), ERROR);
        assert!(said().contains("fmi3GetFloat64: valueReferences is a null pointer"));
        assert_eq!(fmi3GetFloat64(three, force, 1, nowhere, 1), ERROR);
        assert!(said().contains("fmi3GetFloat64: values is a null pointer"));
        assert_eq!(fmi3SetFloat64(three, no_references, 1, &value, 1), ERROR);
        assert!(said().contains("fmi3SetFloat64: valueReferences is a null pointer"));
        assert_eq!(fmi3SetFloat64(three, force, 1, nowhere, 1), ERROR);
        assert!(said().contains("fmi3SetFloat64: values is a null pointer"));
        assert_eq!(fmi3GetFloat64(null_mut(), force, 1, &mut value, 1), ERROR);
        assert_eq!(fmi3SetFloat64(null_mut(), force, 1, &value, 1), ERROR);
        // A refused call writes nothing; a list of nothing need not be there.
        assert_eq!(value, 7.0);
        assert_eq!(fmi2GetReal(two, no_references, 0, nowhere), 0);
        assert_eq!(fmi2SetReal(two, no_references, 0, nowhere), 0);
        assert_eq!(fmi3GetFloat64(three, no_references, 0, nowhere, 0), 0);
        assert_eq!(fmi3SetFloat64(three, no_references, 0, nowhere, 0), 0);
        assert_eq!(fmi2GetReal(two, force, 1, &mut value), 0);
        assert_eq!(value, 3.0, "the force as it was set first");
        value = 7.0;
        assert_eq!(fmi3GetFloat64(three, force, 1, &mut value, 1), 0);
        assert_eq!(value, 3.0, "the force as it was set first");
        fmi2FreeInstance(two);
        fmi3FreeInstance(three);
    }
}

#[test]
fn regress_a_step_with_a_null_place_for_an_answer_is_not_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    let last = Mutex::new(String::new());
    let instance = of_fmi3(&write(folder.path()), &last);
    let (mut flags, mut reached) = ([9_u8; 3], -1.0);
    let [event, terminate, early] = flags.each_mut().map(std::ptr::from_mut);
    let (no, end): (*mut u8, _) = (null_mut(), &raw mut reached);
    let names = ["eventHandlingNeeded", "terminateSimulation", "earlyReturn", "lastSuccessfulTime"];
    let places = [
        (no, terminate, early, end),
        (event, no, early, end),
        (event, terminate, no, end),
        (event, terminate, early, null_mut()),
    ];
    // SAFETY: a live instance, and null or places for the answers.
    unsafe {
        for (name, (event, terminate, early, end)) in names.into_iter().zip(places) {
            assert_eq!(fmi3DoStep(instance, 0.0, 1e-3, 0, event, terminate, early, end), ERROR);
            let said = last.lock().expect("sound").clone();
            assert!(said.contains(&format!("{name} is a null pointer")), "{said}");
        }
        assert_eq!(*end, -1.0);
        // It still stands at its start, so the same step is taken now.
        assert_eq!(fmi3DoStep(instance, 0.0, 1e-3, 0, event, terminate, early, end), 0);
        fmi3FreeInstance(instance);
    }
    assert_eq!((flags, reached), ([0; 3], 1e-3));
}

#[test]
fn regress_unknown_and_null_log_categories_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = write(folder.path());
    let last = Mutex::new(String::new());
    let (two, three) = (of_fmi2(&fmu, 1), of_fmi3(&fmu, &last));
    let said = || std::mem::take(&mut *last.lock().expect("sound"));
    let lists = [
        ([c"logEvents".as_ptr(), c"logNothing".as_ptr()], "log category \"logNothing\": there are logEvents"),
        ([c"logEvents".as_ptr(), std::ptr::null()], "category is a null pointer"),
        ([c"logEvents".as_ptr(), c"\xff".as_ptr()], "category is not UTF-8 text"),
    ];
    // SAFETY: null, or live instances with lists of as many C strings or null as said.
    unsafe {
        for (list, message) in lists {
            assert_eq!(fmi2SetDebugLogging(two, 1, 2, list.as_ptr()), ERROR);
            assert_eq!(fmi3SetDebugLogging(three, 1, 2, list.as_ptr()), ERROR);
            let said = said();
            assert!(said.contains("fmi3SetDebugLogging") && said.contains(message), "{said}");
        }
        assert_eq!(fmi2SetDebugLogging(two, 1, 1, std::ptr::null()), ERROR);
        assert_eq!(fmi3SetDebugLogging(three, 1, 1, std::ptr::null()), ERROR);
        assert!(said().contains("categories is a null pointer"));
        assert_eq!(fmi2SetDebugLogging(null_mut(), 1, 0, std::ptr::null()), ERROR);
        assert_eq!(fmi3SetDebugLogging(null_mut(), 1, 0, std::ptr::null()), ERROR);
        // None of these switched events on; no list at all means every category, and does.
        assert_eq!(fmi3Reset(three), 0);
        assert_eq!(said(), "");
        assert_eq!(fmi2SetDebugLogging(two, 1, 0, std::ptr::null()), 0);
        assert_eq!(fmi3SetDebugLogging(three, 1, 0, std::ptr::null()), 0);
        assert_eq!(fmi3Reset(three), 0);
        assert_eq!(said(), "reset");
        fmi2FreeInstance(two);
        fmi3FreeInstance(three);
    }
}

/// Status of states, derivatives, nominals and indicators, asked one after the other.
fn fmi2_answers(instance: Pointer) -> [c_int; 4] {
    let mut values = [0.0; 2];
    // SAFETY: a live instance and as many places as said.
    unsafe {
        [
            fmi2GetContinuousStates(instance, values.as_mut_ptr(), 2),
            fmi2GetDerivatives(instance, values.as_mut_ptr(), 2),
            fmi2GetNominalsOfContinuousStates(instance, values.as_mut_ptr(), 2),
            fmi2GetEventIndicators(instance, values.as_mut_ptr(), 0),
        ]
    }
}

/// The same, then the numbers of states and indicators.
fn fmi3_answers(instance: Pointer) -> [c_int; 6] {
    let (mut values, mut count) = ([0.0; 2], 0);
    // SAFETY: a live instance and as many places as said.
    unsafe {
        [
            fmi3GetContinuousStates(instance, values.as_mut_ptr(), 2),
            fmi3GetContinuousStateDerivatives(instance, values.as_mut_ptr(), 2),
            fmi3GetNominalsOfContinuousStates(instance, values.as_mut_ptr(), 2),
            fmi3GetEventIndicators(instance, values.as_mut_ptr(), 0),
            fmi3GetNumberOfContinuousStates(instance, &mut count),
            fmi3GetNumberOfEventIndicators(instance, &mut count),
        ]
    }
}

#[test]
fn regress_fmi2_model_exchange_calls_are_refused_in_co_simulation() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = write(folder.path());
    for kind in [0, 1] {
        let instance = of_fmi2(&fmu, kind);
        let done = |answers: [c_int; 4]| assert_eq!(answers, if kind == 0 { [0; 4] } else { [ERROR; 4] });
        // Nominals alone are there once instantiated.
        let early = if kind == 0 { 0 } else { ERROR };
        assert_eq!(fmi2_answers(instance), [ERROR, ERROR, early, ERROR]);
        // SAFETY: a live instance.
        unsafe {
            assert_eq!(fmi2EnterInitializationMode(instance), 0);
            done(fmi2_answers(instance));
            assert_eq!(fmi2ExitInitializationMode(instance), 0);
            done(fmi2_answers(instance));
            fmi2FreeInstance(instance);
        }
    }
}

#[test]
fn regress_fmi3_model_exchange_calls_are_refused_in_co_simulation() {
    let folder = tempfile::tempdir().expect("a folder");
    let [token, path, _] = write(folder.path());
    let (name, no): (_, Pointer) = (c"panel".as_ptr(), null_mut());
    let last = Mutex::new(String::new());
    let (environment, logger) = ((&raw const last).cast_mut().cast(), log as *mut std::ffi::c_void);
    for co_simulation in [false, true] {
        // SAFETY: C strings that live through the calls, a live instance, and an environment that outlives it.
        unsafe {
            let (token, path) = (token.as_ptr(), path.as_ptr());
            let instance = if co_simulation {
                fmi3InstantiateCoSimulation(name, token, path, 0, 0, 0, 0, no.cast(), 0, environment, logger, no)
            } else {
                fmi3InstantiateModelExchange(name, token, path, 0, 0, environment, logger)
            };
            assert!(!instance.is_null());
            let done = |answers: [c_int; 6]| assert_eq!(answers, if co_simulation { [ERROR; 6] } else { [0; 6] });
            let counts = if co_simulation { ERROR } else { 0 };
            assert_eq!(fmi3_answers(instance), [ERROR, ERROR, ERROR, ERROR, counts, counts]);
            assert_eq!(fmi3EnterInitializationMode(instance, 0, 0.0, 0.0, 0, 0.0), 0);
            done(fmi3_answers(instance));
            assert_eq!(fmi3ExitInitializationMode(instance), 0);
            done(fmi3_answers(instance));
            fmi3FreeInstance(instance);
        }
    }
    let said = last.lock().expect("sound").clone();
    assert!(said.contains("is of <ModelExchange>: this instance is co-simulation"), "{said}");
}
