//! FMI 3.0, 2.2.11 and 4.2.4: partial derivatives, and derivatives of outputs by time.

use super::Reference;
use crate::boundary::{array, array_mut, entries};

entries! {
    fmi3GetDirectionalDerivative(
        unknowns: *const Reference, unknown_count: usize, knowns: *const Reference, known_count: usize,
        seed: *const f64, seed_count: usize, sensitivity: *mut f64, sensitivity_count: usize
    ) |instance| {
        let unknowns = instance.component.elements(array(unknowns, unknown_count, "unknowns")?)?;
        let knowns = instance.component.elements(array(knowns, known_count, "knowns")?)?;
        instance.component.directional_derivative(
            &unknowns,
            &knowns,
            array(seed, seed_count, "seed")?,
            array_mut(sensitivity, sensitivity_count, "sensitivity")?,
        )
    };

    fmi3GetAdjointDerivative(
        unknowns: *const Reference, unknown_count: usize, knowns: *const Reference, known_count: usize,
        seed: *const f64, seed_count: usize, sensitivity: *mut f64, sensitivity_count: usize
    ) |instance| {
        let unknowns = instance.component.elements(array(unknowns, unknown_count, "unknowns")?)?;
        let knowns = instance.component.elements(array(knowns, known_count, "knowns")?)?;
        instance.component.adjoint_derivative(
            &unknowns,
            &knowns,
            array(seed, seed_count, "seed")?,
            array_mut(sensitivity, sensitivity_count, "sensitivity")?,
        )
    };

    fmi3GetOutputDerivatives(
        references: *const Reference, count: usize, orders: *const i32, values: *mut f64, value_count: usize
    ) |instance| {
        let references = array(references, count, "valueReferences")?;
        let orders = instance.component.for_elements(references, array(orders, count, "orders")?)?;
        let elements = instance.component.elements(references)?;
        instance.component.output_derivatives(&elements, &orders, array_mut(values, value_count, "values")?)
    };
}
