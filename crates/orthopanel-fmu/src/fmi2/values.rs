//! FMI 2.0, 2.1.7: getting and setting variables.

use std::ffi::c_int;

use super::{Boolean, Reference, Text};
use crate::boundary::{absent_types, array, array_mut, entries};

entries! {
    #[frequent]
    fmi2GetReal(references: *const Reference, count: usize, values: *mut f64) |instance| {
        instance.component.get_reals(array(references, count, "vr")?, array_mut(values, count, "value")?)
    };
    #[frequent]
    fmi2SetReal(references: *const Reference, count: usize, values: *const f64) |instance| {
        instance.component.set_reals(array(references, count, "vr")?, array(values, count, "value")?)
    };
    fmi2GetBoolean(references: *const Reference, count: usize, values: *mut Boolean) |instance| {
        let references = array(references, count, "vr")?;
        instance.component.get_booleans(references, array_mut(values, count, "value")?)
    };
    fmi2SetBoolean(references: *const Reference, count: usize, values: *const Boolean) |instance| {
        instance.component.set_booleans(array(references, count, "vr")?, array(values, count, "value")?)
    };
}

absent_types! {
    fmi2GetInteger("Integer", *mut c_int);
    fmi2SetInteger("Integer", *const c_int);
    fmi2GetString("String", *mut Text);
    fmi2SetString("String", *const Text);
}
