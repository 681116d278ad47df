//! FMI 3.0, 2.2.11 and 4.2.4: partial derivatives, and derivatives of outputs by time.

use super::Reference;
use crate::boundary::{array, array_mut, entries};

entries! {
    fmi3GetDirectionalDerivative(
        unknowns: *const Reference, unknown_count: usize, knowns: *const Reference, known_count: usize,
        seed: *const f64, seed_count: usize, sensitivity: *mut f64, sensitivity_count: usize
    ) |instance| {
        instance.component.directional_derivative(
            array(unknowns, unknown_count, "unknowns")?,
            array(knowns, known_count, "knowns")?,
            array(seed, seed_count, "seed")?,
            array_mut(sensitivity, sensitivity_count, "sensitivity")?,
        )
    };

    fmi3GetAdjointDerivative(
        unknowns: *const Reference, unknown_count: usize, knowns: *const Reference, known_count: usize,
        seed: *const f64, seed_count: usize, sensitivity: *mut f64, sensitivity_count: usize
    ) |instance| {
        instance.component.adjoint_derivative(
            array(unknowns, unknown_count, "unknowns")?,
            array(knowns, known_count, "knowns")?,
            array(seed, seed_count, "seed")?,
            array_mut(sensitivity, sensitivity_count, "sensitivity")?,
        )
    };

    fmi3GetOutputDerivatives(
        references: *const Reference, count: usize, orders: *const i32, values: *mut f64, value_count: usize
    ) |instance| {
        instance.component.output_derivatives(
            array(references, count, "valueReferences")?,
            array(orders, count, "orders")?,
            array_mut(values, value_count, "values")?,
        )
    };
}
