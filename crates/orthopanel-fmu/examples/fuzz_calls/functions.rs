//! The C functions, as an importer in Rust declares them.

use std::ffi::c_int;

use crate::c_functions::*;

/// A table for each version of the functions that both have with the same arguments. Those under `here` are declared too.
macro_rules! both {
    (
        elsewhere { $($field:ident $two:ident $three:ident ($($kind:ty),*);)* }
        here { $($own:ident $own_two:ident $own_three:ident ($($own_kind:ty),*);)* }
    ) => {
        unsafe extern "C" { $(
            fn $own_two(instance: Pointer, $(_: $own_kind),*) -> c_int;
            fn $own_three(instance: Pointer, $(_: $own_kind),*) -> c_int;
        )* }
        pub struct Functions {
            $(pub $field: unsafe extern "C" fn(Pointer, $($kind),*) -> c_int,)*
            $(pub $own: unsafe extern "C" fn(Pointer, $($own_kind),*) -> c_int,)*
        }
        pub const TWO: Functions = Functions { $($field: $two,)* $($own: $own_two,)* };
        pub const THREE: Functions = Functions { $($field: $three,)* $($own: $own_three,)* };
    };
}

both! {
    elsewhere {
        exit fmi2ExitInitializationMode fmi3ExitInitializationMode();
        reset fmi2Reset fmi3Reset();
        derivatives fmi2GetDerivatives fmi3GetContinuousStateDerivatives(*mut f64, usize);
    }
    here {
        terminate fmi2Terminate fmi3Terminate();
        event fmi2EnterEventMode fmi3EnterEventMode();
        continuous fmi2EnterContinuousTimeMode fmi3EnterContinuousTimeMode();
        time fmi2SetTime fmi3SetTime(f64);
        set_states fmi2SetContinuousStates fmi3SetContinuousStates(*const f64, usize);
        get_state fmi2GetFMUstate fmi3GetFMUState(*mut Pointer);
        set_state fmi2SetFMUstate fmi3SetFMUState(Pointer);
        free_state fmi2FreeFMUstate fmi3FreeFMUState(*mut Pointer);
        size fmi2SerializedFMUstateSize fmi3SerializedFMUStateSize(Pointer, *mut usize);
        write fmi2SerializeFMUstate fmi3SerializeFMUState(Pointer, *mut u8, usize);
        read fmi2DeSerializeFMUstate fmi3DeserializeFMUState(*const u8, usize, *mut Pointer);
    }
}

/// Declares functions of FMI 3.0 that multiply a seed by partial derivatives, forwards or backwards.
macro_rules! partial_derivatives {
    ($($name:ident)*) => {
        unsafe extern "C" { $(pub fn $name(
            i: Pointer,
            unknowns: *const u32,
            unknown_count: usize,
            knowns: *const u32,
            known_count: usize,
            seed: *const f64,
            seeds: usize,
            found: *mut f64,
            sensitivities: usize,
        ) -> c_int;)* }
    };
}

partial_derivatives! { fmi3GetDirectionalDerivative fmi3GetAdjointDerivative }

/// References and their count.
type List<'a> = &'a [u32];

unsafe extern "C" {
    fn fmi2Reset(instance: Pointer) -> c_int;
    pub fn fmi2SetupExperiment(i: Pointer, has: c_int, tolerance: f64, start: f64, stops: c_int, stop: f64) -> c_int;
    fn fmi2GetDirectionalDerivative(
        i: Pointer,
        unknowns: *const u32,
        unknown_count: usize,
        knowns: *const u32,
        known_count: usize,
        seed: *const f64,
        found: *mut f64,
    ) -> c_int;
    fn fmi2SetBoolean(i: Pointer, list: *const u32, n: usize, values: *const c_int) -> c_int;
    fn fmi3SetBoolean(i: Pointer, list: *const u32, n: usize, values: *const u8, count: usize) -> c_int;
    fn fmi2SetRealInputDerivatives(
        i: Pointer,
        list: *const u32,
        n: usize,
        orders: *const c_int,
        v: *const f64,
    ) -> c_int;
    fn fmi2GetRealOutputDerivatives(i: Pointer, list: *const u32, n: usize, orders: *const c_int, v: *mut f64)
    -> c_int;
    fn fmi3GetOutputDerivatives(
        i: Pointer,
        list: *const u32,
        n: usize,
        orders: *const c_int,
        values: *mut f64,
        count: usize,
    ) -> c_int;
}

fn done(status: c_int, what: &str) -> Result<(), String> {
    if status == 0 { Ok(()) } else { Err(format!("it was refused {what}")) }
}

/// A live instance of one version.
#[derive(Clone, Copy)]
pub struct Instance {
    pub pointer: Pointer,
    pub three: bool,
}

impl Instance {
    pub fn functions(self) -> &'static Functions {
        if self.three { &THREE } else { &TWO }
    }

    pub fn get(self, list: List<'_>, values: &mut [f64]) -> c_int {
        let (pointer, n) = (self.pointer, list.len().min(values.len()));
        // SAFETY: a live instance, and arrays of at least this length.
        unsafe {
            if self.three {
                fmi3GetFloat64(pointer, list.as_ptr(), n, values.as_mut_ptr(), n)
            } else {
                fmi2GetReal(pointer, list.as_ptr(), n, values.as_mut_ptr())
            }
        }
    }

    pub fn set(self, list: List<'_>, values: &[f64]) -> c_int {
        let (pointer, n) = (self.pointer, list.len().min(values.len()));
        // SAFETY: a live instance, and arrays of at least this length.
        unsafe {
            if self.three {
                fmi3SetFloat64(pointer, list.as_ptr(), n, values.as_ptr(), n)
            } else {
                fmi2SetReal(pointer, list.as_ptr(), n, values.as_ptr())
            }
        }
    }

    pub fn set_boolean(self, reference: u32, value: bool) -> c_int {
        // SAFETY: a live instance, one reference and one value.
        unsafe {
            if self.three {
                fmi3SetBoolean(self.pointer, &reference, 1, &u8::from(value), 1)
            } else {
                fmi2SetBoolean(self.pointer, &reference, 1, &c_int::from(value))
            }
        }
    }

    /// Keeps where the instance stands; where `state` holds a state of it, in its place.
    pub fn get_state(self, state: &mut Pointer) -> Result<(), String> {
        // SAFETY: a live instance and a place for the handle.
        done(unsafe { (self.functions().get_state)(self.pointer, state) }, "to keep a state")
    }

    pub fn free_state(self, state: &mut Pointer) -> Result<(), String> {
        // SAFETY: a live instance and a handle.
        done(unsafe { (self.functions().free_state)(self.pointer, state) }, "to free a state")
    }

    pub fn serialize(self, state: Pointer) -> Result<Vec<u8>, String> {
        let (mut size, functions) = (0, self.functions());
        // SAFETY: a live instance; the handle is checked by the library; the buffer is as long as said.
        unsafe {
            done((functions.size)(self.pointer, state, &mut size), "to tell a state's size")?;
            let mut bytes = vec![0; size];
            done((functions.write)(self.pointer, state, bytes.as_mut_ptr(), size), "to write a state")?;
            Ok(bytes)
        }
    }

    pub fn step(self, from: f64, step: f64) -> c_int {
        let (mut flags, mut time) = ([0_u8; 3], 0.0);
        let [event, end, early] = &mut flags;
        // SAFETY: a live instance and places for the answers.
        unsafe {
            if self.three {
                fmi3DoStep(self.pointer, from, step, 0, event, end, early, &mut time)
            } else {
                fmi2DoStep(self.pointer, from, step, 0)
            }
        }
    }

    /// Of FMI 3.0 backwards where `adjoint`.
    pub fn derivative(self, adjoint: bool, unknown: u32, known: u32, seed: f64, found: &mut f64) -> c_int {
        // SAFETY: a live instance, one reference and one number of each.
        unsafe {
            match (self.three, adjoint) {
                (true, true) => fmi3GetAdjointDerivative(self.pointer, &unknown, 1, &known, 1, &seed, 1, found, 1),
                (true, false) => fmi3GetDirectionalDerivative(self.pointer, &unknown, 1, &known, 1, &seed, 1, found, 1),
                (false, _) => fmi2GetDirectionalDerivative(self.pointer, &unknown, 1, &known, 1, &seed, found),
            }
        }
    }

    pub fn output_derivative(self, reference: u32, order: c_int, found: &mut f64) -> c_int {
        // SAFETY: a live instance, one reference, order and number.
        unsafe {
            if self.three {
                fmi3GetOutputDerivatives(self.pointer, &reference, 1, &order, found, 1)
            } else {
                fmi2GetRealOutputDerivatives(self.pointer, &reference, 1, &order, found)
            }
        }
    }

    /// Which FMI 2.0 alone has; nothing is done in FMI 3.0.
    pub fn force_rate(self, reference: u32, order: c_int, rate: f64) -> c_int {
        if self.three {
            return 0;
        }
        // SAFETY: a live instance, one reference, order and number.
        unsafe { fmi2SetRealInputDerivatives(self.pointer, &reference, 1, &order, &rate) }
    }

    pub fn free(self) {
        // SAFETY: a live instance, not used again.
        unsafe { if self.three { fmi3FreeInstance(self.pointer) } else { fmi2FreeInstance(self.pointer) } }
    }
}
