//! The C functions that more than one test or example calls, as an importer in Rust declares them.
#![allow(unsafe_code, reason = "an importer in Rust calls C functions")]
#![allow(dead_code, reason = "no test calls all")]

use std::ffi::{c_char, c_int, c_void};

pub type Pointer = *mut c_void;

unsafe extern "C" {
    pub fn fmi2Instantiate(
        name: *const c_char,
        kind: c_int,
        guid: *const c_char,
        location: *const c_char,
        callbacks: *const [Pointer; 5],
        visible: c_int,
        logging: c_int,
    ) -> Pointer;
    pub fn fmi3InstantiateCoSimulation(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: u8,
        logging: u8,
        events: u8,
        early: u8,
        intermediate: *const u32,
        count: usize,
        environment: Pointer,
        log: Pointer,
        update: Pointer,
    ) -> Pointer;
    pub fn fmi3InstantiateModelExchange(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: u8,
        logging: u8,
        environment: Pointer,
        log: Pointer,
    ) -> Pointer;
    pub fn fmi2EnterInitializationMode(instance: Pointer) -> c_int;
    pub fn fmi2ExitInitializationMode(instance: Pointer) -> c_int;
    pub fn fmi2GetReal(instance: Pointer, references: *const u32, count: usize, values: *mut f64) -> c_int;
    pub fn fmi2SetReal(instance: Pointer, references: *const u32, count: usize, values: *const f64) -> c_int;
    pub fn fmi2GetDerivatives(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    pub fn fmi2DoStep(instance: Pointer, start: f64, step: f64, last: c_int) -> c_int;
    pub fn fmi2FreeInstance(instance: Pointer);
    pub fn fmi3EnterInitializationMode(i: Pointer, has: u8, tolerance: f64, start: f64, stops: u8, stop: f64) -> c_int;
    pub fn fmi3ExitInitializationMode(instance: Pointer) -> c_int;
    pub fn fmi3GetFloat64(i: Pointer, references: *const u32, count: usize, values: *mut f64, sizes: usize) -> c_int;
    pub fn fmi3SetFloat64(i: Pointer, references: *const u32, count: usize, values: *const f64, sizes: usize) -> c_int;
    pub fn fmi3GetContinuousStateDerivatives(instance: Pointer, values: *mut f64, count: usize) -> c_int;
    pub fn fmi3Reset(instance: Pointer) -> c_int;
    pub fn fmi3DoStep(
        instance: Pointer,
        start: f64,
        step: f64,
        no_state_before: u8,
        event: *mut u8,
        terminate: *mut u8,
        early: *mut u8,
        reached: *mut f64,
    ) -> c_int;
    pub fn fmi3FreeInstance(instance: Pointer);
}
