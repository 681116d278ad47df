//! Sizes of the modal states to be expected, by which an integrator scales its error.

use orthopanel_model::ModalModel;

/// Nominal $a_m$ and $\dot a_m$: $W/\omega_m^2$ and $W/\omega_m$, what a standing force of 1 N and its release give,
/// with $W$ the largest shape value at one of the force ports, which come first. A rigid mode takes the lowest frequency that is not zero.
///
/// The importer's tolerance is relative to these. An integrator that is not told takes 1, which is a million times
/// the motion of a panel, and then integrates nothing at all.
pub(crate) fn of(model: &ModalModel, forces: usize) -> Vec<[f64; 2]> {
    let lowest = model.modes().iter().map(|mode| mode.angular_frequency).find(|&omega| omega > 0.0).unwrap_or(1.0);
    let sizes = model.modes().iter().map(|mode| {
        let largest = mode.at_forces.iter().take(forces).fold(0.0_f64, |most, value| most.max(value.abs()));
        let omega = if mode.angular_frequency > 0.0 { mode.angular_frequency } else { lowest };
        // A mode that no force moves stays at rest: any size will do.
        let shape = if largest > 0.0 { largest } else { 1.0 };
        [positive(shape / (omega * omega)), positive(shape / omega)]
    });
    sizes.collect()
}

/// Nominals must be above zero, whatever the frequency. Two digits are plenty for a size, and the same on every machine.
fn positive(size: f64) -> f64 {
    // By what reads the resource: the standard library's own reading of numbers would bring 20 KB into every FMU.
    let rounded: f64 = serde_json::from_slice(format!("{size:.1e}").as_bytes()).unwrap_or(size);
    rounded.clamp(f64::MIN_POSITIVE, f64::MAX)
}
