//! Entry points of FMI 2.0: 44 functions, one file for each part of the standard.
//!
//! Every entry is unsafe for the same reason: pointers come from the importer, which keeps the FMI contract (see
//! `boundary`). A capability moves from `not_offered` to a file of its own once it is offered.
#![allow(unsafe_code, non_snake_case)]

mod derivatives;
mod fmu_state;
mod instance;
mod model_exchange;
mod not_offered;
mod status;
mod step;
mod values;

use std::ffi::{c_char, c_int, c_uint, c_void};

/// `fmi2Component`, `fmi2FMUstate`, `fmi2ComponentEnvironment`.
type Pointer = *mut c_void;
/// `fmi2ValueReference`.
type Reference = c_uint;
/// `fmi2Boolean`: zero is false.
type Boolean = c_int;
/// `fmi2String`.
type Text = *const c_char;

/// `fmi2CallbackLogger`.
type LoggerCallback = Option<unsafe extern "C" fn(Pointer, Text, c_int, Text, Text, ...)>;

/// `fmi2CallbackFunctions`; only the logger is used: memory comes from Rust's allocator, and steps are synchronous.
#[repr(C)]
#[derive(Clone, Copy)]
struct Callbacks {
    logger: LoggerCallback,
    allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> Pointer>,
    free_memory: Option<unsafe extern "C" fn(Pointer)>,
    step_finished: Option<unsafe extern "C" fn(Pointer, c_int)>,
    environment: Pointer,
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}
