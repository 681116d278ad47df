//! The C functions that make instances, as an importer in Rust declares them.
#![allow(dead_code, reason = "no test makes instances of every kind")]

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
}
