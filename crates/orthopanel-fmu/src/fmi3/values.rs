//! FMI 3.0, 2.2.7: getting and setting variables; all are scalars.

use super::{Boolean, Pointer, Reference, Text};
use crate::boundary::{self, Status, array, array_mut};

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    instance: Pointer,
    references: *const Reference,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    // SAFETY: a live instance and arrays of the lengths given, under the FMI contract.
    unsafe {
        boundary::call(instance, "fmi3GetFloat64", |instance| {
            let references = array(references, count, "valueReferences")?;
            instance.component.get_reals(references, array_mut(values, value_count, "values")?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    instance: Pointer,
    references: *const Reference,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    // SAFETY: a live instance and arrays of the lengths given, under the FMI contract.
    unsafe {
        boundary::call(instance, "fmi3SetFloat64", |instance| {
            let references = array(references, count, "valueReferences")?;
            instance.component.set_reals(references, array(values, value_count, "values")?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetBoolean(
    instance: Pointer,
    references: *const Reference,
    count: usize,
    values: *mut Boolean,
    value_count: usize,
) -> Status {
    // SAFETY: a live instance and arrays of the lengths given, under the FMI contract.
    unsafe {
        boundary::call(instance, "fmi3GetBoolean", |instance| {
            let references = array(references, count, "valueReferences")?;
            let values = array_mut(values, value_count, "values")?;
            let mut read = vec![false; values.len()];
            instance.component.get_booleans(references, &mut read)?;
            values.iter_mut().zip(read).for_each(|(value, read)| *value = Boolean::from(read));
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetBoolean(
    instance: Pointer,
    references: *const Reference,
    count: usize,
    values: *const Boolean,
    value_count: usize,
) -> Status {
    // SAFETY: a live instance and arrays of the lengths given, under the FMI contract.
    unsafe {
        boundary::call(instance, "fmi3SetBoolean", |instance| {
            let values: Vec<bool> = array(values, value_count, "values")?.iter().map(|&value| value != 0).collect();
            instance.component.set_booleans(array(references, count, "valueReferences")?, &values)
        })
    }
}

/// Defines getters and setters of types that no variable has: a call with no reference is done, any other refused.
macro_rules! absent_types {
    ($($name:ident($asked:literal, $($argument:ty),+);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            instance: Pointer,
            references: *const Reference,
            count: usize,
            $(_: $argument),+
        ) -> Status {
            // SAFETY: a live instance and `count` references, under the FMI contract.
            unsafe {
                boundary::call(instance, stringify!($name), |instance| {
                    instance.component.refuse_type(array(references, count, "valueReferences")?, $asked)
                })
            }
        }
    )*};
}

absent_types! {
    fmi3GetFloat32("Float32", *mut f32, usize);
    fmi3SetFloat32("Float32", *const f32, usize);
    fmi3GetInt8("Int8", *mut i8, usize);
    fmi3SetInt8("Int8", *const i8, usize);
    fmi3GetUInt8("UInt8", *mut u8, usize);
    fmi3SetUInt8("UInt8", *const u8, usize);
    fmi3GetInt16("Int16", *mut i16, usize);
    fmi3SetInt16("Int16", *const i16, usize);
    fmi3GetUInt16("UInt16", *mut u16, usize);
    fmi3SetUInt16("UInt16", *const u16, usize);
    fmi3GetInt32("Int32", *mut i32, usize);
    fmi3SetInt32("Int32", *const i32, usize);
    fmi3GetUInt32("UInt32", *mut u32, usize);
    fmi3SetUInt32("UInt32", *const u32, usize);
    fmi3GetInt64("Int64", *mut i64, usize);
    fmi3SetInt64("Int64", *const i64, usize);
    fmi3GetUInt64("UInt64", *mut u64, usize);
    fmi3SetUInt64("UInt64", *const u64, usize);
    fmi3GetString("String", *mut Text, usize);
    fmi3SetString("String", *const Text, usize);
    fmi3GetBinary("Binary", *mut usize, *mut *const u8, usize);
    fmi3SetBinary("Binary", *const usize, *const *const u8, usize);
    fmi3GetClock("Clock", *mut Boolean);
    fmi3SetClock("Clock", *const Boolean);
}
