//! FMI 3.0, 2.2.7: getting and setting variables.

use super::{Boolean, Reference, Text};
use crate::boundary::{absent_types, array, array_mut, entries};

entries! {
    #[frequent]
    fmi3GetFloat64(references: *const Reference, count: usize, values: *mut f64, value_count: usize) |instance| {
        let references = instance.component.elements(array(references, count, "valueReferences")?)?;
        instance.component.get_reals(&references, array_mut(values, value_count, "values")?)
    };
    #[frequent]
    fmi3SetFloat64(references: *const Reference, count: usize, values: *const f64, value_count: usize) |instance| {
        let references = instance.component.elements(array(references, count, "valueReferences")?)?;
        instance.component.set_reals(&references, array(values, value_count, "values")?)
    };
    fmi3GetBoolean(references: *const Reference, count: usize, values: *mut Boolean, value_count: usize) |instance| {
        let references = array(references, count, "valueReferences")?;
        instance.component.get_booleans(references, array_mut(values, value_count, "values")?)
    };
    fmi3SetBoolean(references: *const Reference, count: usize, values: *const Boolean, value_count: usize) |instance| {
        let references = array(references, count, "valueReferences")?;
        instance.component.set_booleans(references, array(values, value_count, "values")?)
    };
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
