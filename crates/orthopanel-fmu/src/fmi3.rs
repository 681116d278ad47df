//! Entry points of FMI 3.0: 75 functions, one file for each part of the standard.
//!
//! Every entry is unsafe for the same reason: pointers come from the importer, which keeps the FMI contract (see
//! `boundary`). A capability moves from `not_offered` to a file of its own once it is offered.
#![allow(unsafe_code, non_snake_case)]

mod derivatives;
mod fmu_state;
mod instance;
mod model_exchange;
mod not_offered;
mod step;
mod values;

use std::ffi::{c_char, c_int, c_void};

/// `fmi3Instance`, `fmi3FMUState`, `fmi3InstanceEnvironment`.
type Pointer = *mut c_void;
/// `fmi3ValueReference`.
type Reference = u32;
/// `fmi3Boolean`, C's `bool`: read as a byte, since a Rust `bool` of any byte but 0 and 1 is undefined behaviour.
type Boolean = u8;
/// `fmi3String`.
type Text = *const c_char;

/// `fmi3LogMessageCallback`.
type LogMessage = Option<unsafe extern "C" fn(Pointer, c_int, Text, Text)>;
/// Callbacks that are never called.
type Unused = *const c_void;

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}
