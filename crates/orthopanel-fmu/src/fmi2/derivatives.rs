//! FMI 2.0, 2.1.9 and 4.2.1: partial derivatives, and derivatives of inputs and outputs by time.

use std::ffi::c_int;

use super::Reference;
use crate::boundary::{array, array_mut, entries};

entries! {
    fmi2GetDirectionalDerivative(
        unknowns: *const Reference, unknown_count: usize, knowns: *const Reference, known_count: usize,
        seed: *const f64, sensitivity: *mut f64
    ) |instance| {
        instance.component.directional_derivative(
            array(unknowns, unknown_count, "vUnknown_ref")?,
            array(knowns, known_count, "vKnown_ref")?,
            array(seed, known_count, "dvKnown")?,
            array_mut(sensitivity, unknown_count, "dvUnknown")?,
        )
    };

    fmi2SetRealInputDerivatives(
        references: *const Reference, count: usize, orders: *const c_int, values: *const f64
    ) |instance| {
        let references = array(references, count, "vr")?;
        instance.component.set_force_rates(references, array(orders, count, "order")?, array(values, count, "value")?)
    };

    fmi2GetRealOutputDerivatives(
        references: *const Reference, count: usize, orders: *const c_int, values: *mut f64
    ) |instance| {
        instance.component.output_derivatives(
            array(references, count, "vr")?,
            array(orders, count, "order")?,
            array_mut(values, count, "value")?,
        )
    };
}
