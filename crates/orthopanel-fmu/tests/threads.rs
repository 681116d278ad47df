//! Several instances in several threads, through the C functions of both versions: each runs as if it were alone.
#![expect(unsafe_code, reason = "an importer in Rust calls C functions")]

use std::ffi::CString;
use std::path::Path;
use std::ptr::null_mut;
use std::sync::Barrier;

use orthopanel_fmu::{Connections, RESOURCE_FILE, Residual, Resource, content_token};
use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

use crate::c_functions::*;

/// The panel on disk, and the references that the test needs.
struct Fmu {
    token: CString,
    path: CString,
    uri: CString,
    force: u32,
    length: u32,
    outputs: [u32; 3],
}

impl Fmu {
    fn write(folder: &Path, text: &str) -> Self {
        let place = |x| Place { x, y: 0.02 };
        let ports = Ports { forces: vec![place(-0.3)], responses: vec![place(0.1)] };
        let panel = PanelModel::from_json(text).expect("a sound model");
        let (resource, _) =
            Resource::of_panel(&panel, ModeRange::Count(5), ports, Residual::Attachment, Connections::default())
                .expect("a sound panel");
        let text = resource.to_json();
        std::fs::write(folder.join(RESOURCE_FILE), &text).expect("written");
        let path = folder.to_str().expect("UTF-8");
        let table = resource.variables();
        let reference = |name: &str| table.variables().iter().find(|v| v.name == name).expect("there").reference;
        Self {
            token: CString::new(content_token(text.as_bytes())).expect("no NUL"),
            path: CString::new(path).expect("no NUL"),
            uri: CString::new(format!("file://{path}")).expect("no NUL"),
            force: reference("force_1"),
            length: reference("length"),
            outputs: ["acceleration_1", "velocity_1", "displacement_1"].map(reference),
        }
    }
}

/// One instance; its pointer is used by one thread at a time, as FMI asks.
struct Instance<'a> {
    fmu: &'a Fmu,
    three: bool,
    pointer: Pointer,
}

impl<'a> Instance<'a> {
    /// With a length of its own, so that it solves its own modes.
    fn start(fmu: &'a Fmu, three: bool, length: f64) -> Self {
        let (name, token, callbacks) = (c"panel".as_ptr(), fmu.token.as_ptr(), [null_mut(); 5]);
        // SAFETY: C strings that live through the call, and a live instance afterwards; arrays have one entry.
        unsafe {
            let pointer = if three {
                let (path, no): (_, Pointer) = (fmu.path.as_ptr(), null_mut());
                fmi3InstantiateCoSimulation(name, token, path, 0, 0, 0, 0, no.cast(), 0, no, no, no)
            } else {
                fmi2Instantiate(name, 1, token, fmu.uri.as_ptr(), &callbacks, 0, 0)
            };
            assert!(!pointer.is_null());
            let done = if three {
                fmi3SetFloat64(pointer, &fmu.length, 1, &length, 1)
                    + fmi3EnterInitializationMode(pointer, 0, 0.0, 0.0, 0, 0.0)
                    + fmi3ExitInitializationMode(pointer)
            } else {
                fmi2SetReal(pointer, &fmu.length, 1, &length)
                    + fmi2EnterInitializationMode(pointer)
                    + fmi2ExitInitializationMode(pointer)
            };
            assert_eq!(done, 0);
            Self { fmu, three, pointer }
        }
    }

    /// Step `n`, and the outputs after it.
    fn step(&self, n: u32) -> [f64; 3] {
        let (force, start, step) = (f64::from(n * 7 % 5) - 1.5, f64::from(n) * 1e-4, 1e-4);
        let mut outputs = [0.0; 3];
        // SAFETY: a live instance of this thread; arrays have the lengths given.
        let done = unsafe {
            if self.three {
                let (mut flags, mut time) = ([0_u8; 3], 0.0);
                let [event, end, early] = &mut flags;
                fmi3SetFloat64(self.pointer, &self.fmu.force, 1, &force, 1)
                    + fmi3DoStep(self.pointer, start, step, 1, event, end, early, &mut time)
                    + fmi3GetFloat64(self.pointer, self.fmu.outputs.as_ptr(), 3, outputs.as_mut_ptr(), 3)
            } else {
                fmi2SetReal(self.pointer, &self.fmu.force, 1, &force)
                    + fmi2DoStep(self.pointer, start, step, 1)
                    + fmi2GetReal(self.pointer, self.fmu.outputs.as_ptr(), 3, outputs.as_mut_ptr())
            }
        };
        assert_eq!(done, 0, "step {n}");
        outputs
    }
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        // SAFETY: a live instance, not used again.
        unsafe { if self.three { fmi3FreeInstance(self.pointer) } else { fmi2FreeInstance(self.pointer) } }
    }
}

const STEPS: u32 = 300;

fn alone(fmu: &Fmu, three: bool, length: f64) -> Vec<[f64; 3]> {
    let instance = Instance::start(fmu, three, length);
    (0..STEPS).map(|n| instance.step(n)).collect()
}

fn run_side_by_side(text: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = Fmu::write(folder.path(), text);
    let threads = 8;
    let length = |number: usize| 0.8 + 0.01 * number as f64;
    let expected: Vec<_> = (0..3 * threads).map(|number| alone(&fmu, number % 2 == 1, length(number))).collect();
    assert!(expected.windows(2).all(|pair| pair[0][200] != pair[1][200]), "each panel has a motion of its own");
    let barrier = Barrier::new(threads);
    std::thread::scope(|scope| {
        for thread in 0..threads {
            let (fmu, expected, barrier) = (&fmu, &expected, &barrier);
            scope.spawn(move || {
                // All threads at once, also where modes are solved; three instances take turns in each.
                barrier.wait();
                let numbers: Vec<usize> = (0..3).map(|n| 3 * thread + n).collect();
                let instances = numbers.iter().map(|&number| Instance::start(fmu, number % 2 == 1, length(number)));
                let instances: Vec<_> = instances.collect();
                for n in 0..STEPS {
                    for (instance, &number) in instances.iter().zip(&numbers) {
                        assert_eq!(instance.step(n), expected[number][n as usize], "instance {number}, step {n}");
                    }
                }
            });
        }
    });
}

#[test]
fn beams_in_threads_run_as_if_alone() {
    run_side_by_side(
        r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
        "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
        "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#,
    );
}

#[test]
fn plates_in_threads_run_as_if_alone() {
    run_side_by_side(
        r#"{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
        "piece": {"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88},
        "constants": {"e_x": 1.067e10, "e_y": 0.9e10, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 4e8, "g_zx": 5.304e8},
        "damping": {"beyond": 0.003}}"#,
    );
}
