//! Tunable parameters through the C functions of both versions and interfaces: where they are taken, and where refused.
#![expect(unsafe_code, reason = "an importer in Rust calls C functions")]

use std::ffi::{CString, c_int};
use std::path::Path;
use std::ptr::null_mut;

use orthopanel_fmu::{Connections, Quantity, RESOURCE_FILE, Residual, Resource, content_token};
use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

use crate::c_functions::*;

const ERROR: c_int = 3;

unsafe extern "C" {
    fn fmi2EnterEventMode(instance: Pointer) -> c_int;
    fn fmi2EnterContinuousTimeMode(instance: Pointer) -> c_int;
    /// Five Booleans and a time.
    fn fmi2NewDiscreteStates(instance: Pointer, info: *mut [u64; 4]) -> c_int;
    fn fmi2Terminate(instance: Pointer) -> c_int;
    fn fmi3EnterEventMode(instance: Pointer) -> c_int;
    fn fmi3EnterContinuousTimeMode(instance: Pointer) -> c_int;
    fn fmi3UpdateDiscreteStates(
        instance: Pointer,
        update: *mut u8,
        terminate: *mut u8,
        nominals: *mut u8,
        values: *mut u8,
        next: *mut u8,
        time: *mut f64,
    ) -> c_int;
    fn fmi3Terminate(instance: Pointer) -> c_int;
}

/// An initialized instance of one version and interface.
struct Instance {
    three: bool,
    pointer: Pointer,
    /// References of a length, a damping ratio, a force's place and an acceleration.
    references: [u32; 4],
}

impl Instance {
    fn new(folder: &Path, three: bool, exchange: bool) -> Self {
        let panel = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
            "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
            "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#;
        let place = |x| vec![Place { x, y: 0.0 }];
        let ports = Ports { forces: place(-0.3), responses: place(0.1) };
        let panel = PanelModel::from_json(panel).expect("a sound model");
        let (resource, _) =
            Resource::of_panel(&panel, ModeRange::Count(3), ports, Residual::Attachment, Connections::default())
                .expect("a sound panel");
        let text = resource.to_json();
        std::fs::write(folder.join(RESOURCE_FILE), &text).expect("written");
        let path = folder.to_str().expect("UTF-8");
        let [token, path, uri] = [content_token(text.as_bytes()), path.into(), format!("file://{path}")]
            .map(|text| CString::new(text).expect("no NUL"));
        let table = resource.variables();
        let named = |name: &str| table.variables().iter().find(|v| v.name == name).expect("a variable");
        assert!(named("damping_ratio_1").tunable && !named("length").tunable);
        assert_eq!(named("acceleration_1").quantity, Quantity::Acceleration(0));
        let references = ["length", "damping_ratio_1", "force_1_x", "acceleration_1"].map(|name| named(name).reference);
        let (name, no): (_, Pointer) = (c"panel".as_ptr(), null_mut());
        // SAFETY: C strings and callbacks that live through the calls.
        let pointer = unsafe {
            let (token, path) = (token.as_ptr(), path.as_ptr());
            match (three, exchange) {
                (true, true) => fmi3InstantiateModelExchange(name, token, path, 0, 0, no, no),
                (true, false) => fmi3InstantiateCoSimulation(name, token, path, 0, 0, 0, 0, no.cast(), 0, no, no, no),
                (false, _) => fmi2Instantiate(name, c_int::from(!exchange), token, uri.as_ptr(), &[no; 5], 0, 0),
            }
        };
        assert!(!pointer.is_null());
        // SAFETY: a live instance.
        let done = unsafe {
            if three {
                fmi3EnterInitializationMode(pointer, 0, 0.0, 0.0, 0, 0.0) + fmi3ExitInitializationMode(pointer)
            } else {
                fmi2EnterInitializationMode(pointer) + fmi2ExitInitializationMode(pointer)
            }
        };
        assert_eq!(done, 0);
        Self { three, pointer, references }
    }

    /// Sets the variable of this place among [`Instance::references`].
    fn set(&self, index: usize, value: f64) -> c_int {
        let reference = &raw const self.references[index];
        // SAFETY: a live instance, one reference and one value.
        unsafe {
            if self.three {
                fmi3SetFloat64(self.pointer, reference, 1, &value, 1)
            } else {
                fmi2SetReal(self.pointer, reference, 1, &value)
            }
        }
    }

    fn get(&self, index: usize) -> f64 {
        let (reference, mut value) = (&raw const self.references[index], f64::NAN);
        // SAFETY: a live instance, one reference and a place for the value.
        let done = unsafe {
            if self.three {
                fmi3GetFloat64(self.pointer, reference, 1, &mut value, 1)
            } else {
                fmi2GetReal(self.pointer, reference, 1, &mut value)
            }
        };
        assert_eq!(done, 0);
        value
    }

    /// Whether the end of an event's turn tells that nominals have changed.
    fn nominals_changed(&self) -> bool {
        // SAFETY: a live instance, and places for all answers.
        unsafe {
            if self.three {
                let (mut flags, mut time) = ([9_u8; 5], 0.0);
                let [update, terminate, nominals, values, next] = &mut flags;
                let pointer = self.pointer;
                assert_eq!(fmi3UpdateDiscreteStates(pointer, update, terminate, nominals, values, next, &mut time), 0);
                assert_eq!([flags[0], flags[1], flags[3], flags[4]], [0; 4]);
                flags[2] == 1
            } else {
                let mut info = [u64::MAX; 4];
                assert_eq!(fmi2NewDiscreteStates(self.pointer, &mut info), 0);
                // Integers of 32 bits: the third stands in the low half of the second word.
                let flags: Vec<u32> = info.iter().flat_map(|word| [*word as u32, (*word >> 32) as u32]).collect();
                assert_eq!([flags[0], flags[1], flags[3], flags[4]], [0; 4]);
                flags[2] == 1
            }
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: a live instance, not used again.
        unsafe { if self.three { fmi3FreeInstance(self.pointer) } else { fmi2FreeInstance(self.pointer) } }
    }
}

const LENGTH: usize = 0;
const DAMPING: usize = 1;
const PLACE: usize = 2;
const ACCELERATION: usize = 3;

#[test]
fn co_simulation_takes_tunable_parameters_between_steps() {
    let folder = tempfile::tempdir().expect("a folder");
    for three in [false, true] {
        let (one, other) = (Instance::new(folder.path(), three, false), Instance::new(folder.path(), three, false));
        let step = |instance: &Instance, start| {
            let force = 3_u32;
            let (mut flags, mut time) = ([0_u8; 3], 0.0);
            let [event, end, early] = &mut flags;
            // SAFETY: a live instance, and places for the answers.
            let done = unsafe {
                if three {
                    fmi3SetFloat64(instance.pointer, &force, 1, &3.0, 1)
                        + fmi3DoStep(instance.pointer, start, 1e-4, 1, event, end, early, &mut time)
                } else {
                    fmi2SetReal(instance.pointer, &force, 1, &3.0) + fmi2DoStep(instance.pointer, start, 1e-4, 1)
                }
            };
            assert_eq!(done, 0);
        };
        step(&one, 0.0);
        step(&other, 0.0);
        assert_eq!(one.get(ACCELERATION), other.get(ACCELERATION));
        assert_eq!((one.set(DAMPING, 0.1), one.set(PLACE, -0.2)), (0, 0));
        assert_eq!((one.get(DAMPING), one.get(PLACE)), (0.1, -0.2));
        assert_ne!(one.get(ACCELERATION), other.get(ACCELERATION));
        assert_eq!([one.set(LENGTH, 0.9), one.set(DAMPING, 0.9), one.set(PLACE, 0.9)], [ERROR; 3]);
        assert_eq!((one.get(LENGTH), one.get(DAMPING), one.get(PLACE)), (0.8, 0.1, -0.2));
        step(&one, 1e-4);
        step(&other, 1e-4);
        assert_ne!(one.get(ACCELERATION), other.get(ACCELERATION), "the other instance keeps its own");
        assert_eq!(other.get(DAMPING), 0.003);
        // SAFETY: a live instance.
        assert_eq!(unsafe { if three { fmi3Terminate(one.pointer) } else { fmi2Terminate(one.pointer) } }, 0);
        assert_eq!(one.set(DAMPING, 0.2), ERROR);
    }
}

#[test]
fn model_exchange_takes_them_at_events() {
    let folder = tempfile::tempdir().expect("a folder");
    for three in [false, true] {
        let one = Instance::new(folder.path(), three, true);
        let enter = |events: bool| {
            // SAFETY: a live instance.
            let done = unsafe {
                match (three, events) {
                    (true, true) => fmi3EnterEventMode(one.pointer),
                    (true, false) => fmi3EnterContinuousTimeMode(one.pointer),
                    (false, true) => fmi2EnterEventMode(one.pointer),
                    (false, false) => fmi2EnterContinuousTimeMode(one.pointer),
                }
            };
            assert_eq!(done, 0);
        };
        assert!(!one.nominals_changed());
        assert_eq!(one.set(DAMPING, 0.1), 0);
        assert!(!one.nominals_changed(), "damping leaves the sizes of states");
        enter(false);
        assert_eq!([one.set(DAMPING, 0.2), one.set(PLACE, 0.1), one.set(LENGTH, 0.9)], [ERROR; 3]);
        assert_eq!((one.get(DAMPING), one.get(PLACE)), (0.1, -0.3));
        enter(true);
        // At the middle of a beam half of the modes have their node.
        assert_eq!((one.set(PLACE, 0.0), one.set(LENGTH, 0.9)), (0, ERROR));
        assert!(one.nominals_changed());
        assert!(!one.nominals_changed(), "told once");
    }
}
