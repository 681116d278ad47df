//! [`ModalStepper`] compiled for the vector registers that the running processor has.
//!
//! The library must run on every processor of its platform, yet AVX2 halves the time of a step. So each operation
//! that runs at every step exists twice, and the choice is made once, when an instance is made. Both give the same
//! bits: no operation is fused or reordered.
#![allow(unsafe_code)]

use std::ops::{Deref, DerefMut};

use orthopanel_model::{ModalModel, ModalStepper, ModelError};

/// A stepper and the instructions it may use.
#[derive(Debug, Clone)]
pub(crate) struct WideStepper {
    stepper: ModalStepper,
    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "one set of instructions on this platform"))]
    avx2: bool,
}

/// For all that does not run at every step.
impl Deref for WideStepper {
    type Target = ModalStepper;

    fn deref(&self) -> &ModalStepper {
        &self.stepper
    }
}

impl DerefMut for WideStepper {
    fn deref_mut(&mut self) -> &mut ModalStepper {
        &mut self.stepper
    }
}

/// Defines methods of [`ModalStepper`] in both versions; `[mut]` stands before those that change it.
macro_rules! both_versions {
    ($([$($mut:ident)?] $name:ident($($argument:ident: $kind:ty),+) -> $result:ty;)*) => {$(
        #[inline]
        pub(crate) fn $name(&$($mut)? self, $($argument: $kind),+) -> $result {
            #[cfg(target_arch = "x86_64")]
            if self.avx2 {
                #[target_feature(enable = "avx2")]
                fn with_avx2(stepper: &$($mut)? ModalStepper, $($argument: $kind),+) -> $result {
                    stepper.$name($($argument),+)
                }
                // SAFETY: `avx2` is set only where the processor said that it has AVX2.
                return unsafe { with_avx2(&$($mut)? self.stepper, $($argument),+) };
            }
            // Out of line, so that what calls this stays small where it is not taken.
            #[inline(never)]
            fn without(stepper: &$($mut)? ModalStepper, $($argument: $kind),+) -> $result {
                stepper.$name($($argument),+)
            }
            without(&$($mut)? self.stepper, $($argument),+)
        }
    )*};
}

impl WideStepper {
    pub(crate) fn new(model: &ModalModel) -> Self {
        #[cfg(target_arch = "x86_64")]
        let avx2 = std::arch::is_x86_feature_detected!("avx2");
        #[cfg(not(target_arch = "x86_64"))]
        let avx2 = false;
        Self { stepper: ModalStepper::new(model), avx2 }
    }

    both_versions! {
        [mut] set_forces(forces: &[f64]) -> Result<(), ModelError>;
        [mut] advance_held(step: f64) -> Result<(), ModelError>;
        [mut] advance_under_one(force: f64, step: f64) -> Result<(), ModelError>;
        [mut] advance_linear(step: f64, forces: &[f64]) -> Result<(), ModelError>;
        [] displacement(response: usize) -> Option<f64>;
        [] velocity(response: usize) -> Option<f64>;
        [] acceleration(response: usize) -> Option<f64>;
    }
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Mode;

    use super::*;

    fn of_one_force(mode: &Mode) -> Mode {
        Mode { at_forces: vec![1.0], ..mode.clone() }
    }

    #[test]
    fn val_both_versions_give_the_same_bits() {
        let modes = (0..13).map(|n| Mode {
            angular_frequency: 700.0 * f64::from(n),
            damping_ratio: 0.001 * f64::from(n),
            at_forces: vec![1.0 / f64::from(n + 1), 0.3],
            at_responses: vec![f64::from(n % 3) - 1.1],
        });
        let model = ModalModel::new(2, 1, modes.collect()).expect("a sound model");
        let mut wide = WideStepper::new(&model);
        let mut plain = ModalStepper::new(&model);
        for n in 0..50 {
            let (now, then) = ([f64::from(n % 7), -1.0], [f64::from(n % 5), 0.5]);
            wide.set_forces(&now).and_then(|()| wide.advance_held(1e-4)).expect("a step");
            plain.set_forces(&now).and_then(|()| plain.advance_held(1e-4)).expect("a step");
            wide.advance_linear(3e-5, &then).expect("a step");
            plain.advance_linear(3e-5, &then).expect("a step");
            assert_eq!(wide.state(), plain.state());
            let outputs = [wide.displacement(0), wide.velocity(0), wide.acceleration(0)];
            assert_eq!(outputs, [plain.displacement(0), plain.velocity(0), plain.acceleration(0)]);
        }
        let one = ModalModel::new(1, 1, model.modes().iter().map(of_one_force).collect()).expect("a sound model");
        let (mut wide, mut plain) = (WideStepper::new(&one), ModalStepper::new(&one));
        for n in 0..50 {
            wide.advance_under_one(f64::from(n % 7), 1e-4).expect("a step");
            plain.advance_under_one(f64::from(n % 7), 1e-4).expect("a step");
            assert_eq!(wide.state(), plain.state());
        }
    }
}
