//! FMI 2.0, 2.1.7: getting and setting variables.

use std::ffi::{c_int, c_uint};

use super::{Boolean, Pointer, Reference, Text};
use crate::boundary::{self, Status, array, array_mut};

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetReal(c: Pointer, references: *const Reference, count: usize, values: *mut f64) -> Status {
    // SAFETY: a live instance and arrays of `count` entries, under the FMI contract.
    unsafe {
        boundary::call(c, "fmi2GetReal", |instance| {
            let references = array(references, count, "vr")?;
            instance.component.get_reals(references, array_mut(values, count, "value")?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetReal(c: Pointer, references: *const Reference, count: usize, values: *const f64) -> Status {
    // SAFETY: a live instance and arrays of `count` entries, under the FMI contract.
    unsafe {
        boundary::call(c, "fmi2SetReal", |instance| {
            instance.component.set_reals(array(references, count, "vr")?, array(values, count, "value")?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBoolean(
    c: Pointer,
    references: *const Reference,
    count: usize,
    values: *mut Boolean,
) -> Status {
    // SAFETY: a live instance and arrays of `count` entries, under the FMI contract.
    unsafe {
        boundary::call(c, "fmi2GetBoolean", |instance| {
            let references = array(references, count, "vr")?;
            let values = array_mut(values, count, "value")?;
            let mut read = vec![false; references.len()];
            instance.component.get_booleans(references, &mut read)?;
            values.iter_mut().zip(read).for_each(|(value, read)| *value = Boolean::from(read));
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetBoolean(
    c: Pointer,
    references: *const Reference,
    count: usize,
    values: *const Boolean,
) -> Status {
    // SAFETY: a live instance and arrays of `count` entries, under the FMI contract.
    unsafe {
        boundary::call(c, "fmi2SetBoolean", |instance| {
            let values: Vec<bool> = array(values, count, "value")?.iter().map(|&value| value != 0).collect();
            instance.component.set_booleans(array(references, count, "vr")?, &values)
        })
    }
}

/// Defines getters and setters of types that no variable has: a call with no reference is done, any other refused.
macro_rules! absent_types {
    ($($name:ident($asked:literal, $values:ty);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(c: Pointer, references: *const c_uint, count: usize, _: $values) -> Status {
            // SAFETY: a live instance and `count` references, under the FMI contract.
            unsafe {
                boundary::call(c, stringify!($name), |instance| {
                    instance.component.refuse_type(array(references, count, "vr")?, $asked)
                })
            }
        }
    )*};
}

absent_types! {
    fmi2GetInteger("Integer", *mut c_int);
    fmi2SetInteger("Integer", *const c_int);
    fmi2GetString("String", *mut Text);
    fmi2SetString("String", *const Text);
}
