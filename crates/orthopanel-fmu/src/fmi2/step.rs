//! FMI 2.0, 4.2: co-simulation steps and input derivatives.

use std::ffi::c_int;

use super::{Boolean, Pointer, Reference};
use crate::boundary::{self, Status, array};

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DoStep(c: Pointer, start: f64, step: f64, _no_state_before: Boolean) -> Status {
    // SAFETY: a live instance, under the FMI contract.
    unsafe { boundary::call(c, "fmi2DoStep", |instance| instance.component.do_step(start, step)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: Pointer,
    references: *const Reference,
    count: usize,
    orders: *const c_int,
    values: *const f64,
) -> Status {
    // SAFETY: a live instance and arrays of `count` entries, under the FMI contract.
    unsafe {
        boundary::call(c, "fmi2SetRealInputDerivatives", |instance| {
            let references = array(references, count, "vr")?;
            let orders = array(orders, count, "order")?;
            instance.component.set_force_rates(references, orders, array(values, count, "value")?)
        })
    }
}
