//! Calls with a null pointer where an answer or a list should be: each must be refused.

use std::ffi::c_int;
use std::ptr::{null, null_mut};

use crate::c_functions::{fmi2GetReal, fmi2SetReal, fmi3DoStep, fmi3GetFloat64, fmi3SetFloat64};
use crate::driven::Driven;
use crate::functions::{fmi3GetAdjointDerivative, fmi3GetDirectionalDerivative};
use crate::panels::Fmu;
use crate::random::Random;

/// One such call on a live instance; its status.
pub fn null_call(driven: &Driven, fmu: &Fmu, random: &mut Random) -> c_int {
    let (pointer, functions) = (driven.instance.pointer, driven.instance.functions());
    let (reference, value, mut answer) = (2_u32, 0.5, 0.0);
    let (mut flag, mut size) = (0_u8, 0_usize);
    let (list, empty): (*const u32, *const u32) = (&reference, null());
    // SAFETY: a live instance; each pointer is null or one entry, as the call says.
    unsafe {
        match (random.below(10), driven.instance.three) {
            (0, false) => fmi2GetReal(pointer, empty, 1, &mut answer),
            (0, true) => fmi3GetFloat64(pointer, empty, 1, &mut answer, 1),
            (1, false) => fmi2GetReal(pointer, list, 1, null_mut()),
            (1, true) => fmi3GetFloat64(pointer, list, 1, null_mut(), 1),
            (2, false) => fmi2SetReal(pointer, list, 1, null()),
            (2, true) => fmi3SetFloat64(pointer, list, 1, null(), 1),
            (3, false) => fmi2SetReal(pointer, empty, 1, &value),
            (3, true) => fmi3DoStep(pointer, driven.now(fmu), 1e-3, 0, &mut flag, null_mut(), &mut flag, &mut answer),
            (4, true) => fmi3GetDirectionalDerivative(pointer, list, 1, empty, 1, &value, 1, &mut answer, 1),
            (5, true) => fmi3GetAdjointDerivative(pointer, list, 1, list, 1, null(), 1, &mut answer, 1),
            (4 | 5, false) => (functions.derivatives)(pointer, null_mut(), 2),
            (6, _) => (functions.get_state)(pointer, null_mut()),
            (7, _) => (functions.size)(pointer, driven.state, null_mut()),
            (8, _) => (functions.read)(pointer, null(), 40, &mut null_mut()),
            // No state is kept under null.
            _ if random.one_in(2) => (functions.size)(pointer, null_mut(), &mut size),
            _ => (functions.set_state)(pointer, null_mut()),
        }
    }
}
