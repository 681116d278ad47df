//! Random calls in random order on the C functions of both versions: `fuzz_calls SECONDS [SEED]`.
//!
//! No call may panic, crash or give an output that is not a number; a call that is refused must leave outputs as they
//! were. On a failure the seed of the sequence is printed, and `fuzz_calls 0 SEED` runs that sequence alone.
//! With `FUZZ_TELL` set each seed is printed before it runs, to find a call that does not return.
#![expect(unsafe_code, reason = "an importer in Rust calls C functions")]

use std::ffi::{CString, c_int};
use std::ptr::null_mut;
use std::time::{Duration, Instant};

use orthopanel_fmu::{RESOURCE_FILE, Resource, content_token};
use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

#[path = "../tests/instantiation/mod.rs"]
mod instantiation;

use instantiation::{Pointer, fmi2Instantiate, fmi3InstantiateCoSimulation, fmi3InstantiateModelExchange};

/// Declares the functions that both versions have with the same arguments, and a table of them for each version.
macro_rules! both {
    ($($field:ident $two:ident $three:ident ($($kind:ty),*);)*) => {
        unsafe extern "C" { $(
            fn $two(instance: Pointer, $(_: $kind),*) -> c_int;
            fn $three(instance: Pointer, $(_: $kind),*) -> c_int;
        )* }
        struct Functions { $($field: unsafe extern "C" fn(Pointer, $($kind),*) -> c_int,)* }
        const TWO: Functions = Functions { $($field: $two,)* };
        const THREE: Functions = Functions { $($field: $three,)* };
    };
}

both! {
    exit fmi2ExitInitializationMode fmi3ExitInitializationMode();
    terminate fmi2Terminate fmi3Terminate();
    reset fmi2Reset fmi3Reset();
    event fmi2EnterEventMode fmi3EnterEventMode();
    continuous fmi2EnterContinuousTimeMode fmi3EnterContinuousTimeMode();
    time fmi2SetTime fmi3SetTime(f64);
    set_states fmi2SetContinuousStates fmi3SetContinuousStates(*const f64, usize);
    derivatives fmi2GetDerivatives fmi3GetContinuousStateDerivatives(*mut f64, usize);
    get_state fmi2GetFMUstate fmi3GetFMUState(*mut Pointer);
    set_state fmi2SetFMUstate fmi3SetFMUState(Pointer);
    free_state fmi2FreeFMUstate fmi3FreeFMUState(*mut Pointer);
    size fmi2SerializedFMUstateSize fmi3SerializedFMUStateSize(Pointer, *mut usize);
    write fmi2SerializeFMUstate fmi3SerializeFMUState(Pointer, *mut u8, usize);
    read fmi2DeSerializeFMUstate fmi3DeserializeFMUState(*const u8, usize, *mut Pointer);
}

unsafe extern "C" {
    fn fmi2EnterInitializationMode(instance: Pointer) -> c_int;
    fn fmi2SetupExperiment(instance: Pointer, has: c_int, tolerance: f64, start: f64, stops: c_int, stop: f64)
    -> c_int;
    fn fmi2GetReal(instance: Pointer, references: *const u32, count: usize, values: *mut f64) -> c_int;
    fn fmi2SetReal(instance: Pointer, references: *const u32, count: usize, values: *const f64) -> c_int;
    fn fmi2DoStep(instance: Pointer, start: f64, step: f64, last: c_int) -> c_int;
    fn fmi2FreeInstance(instance: Pointer);
    fn fmi3EnterInitializationMode(i: Pointer, has: u8, tolerance: f64, start: f64, stops: u8, stop: f64) -> c_int;
    fn fmi3GetFloat64(instance: Pointer, references: *const u32, count: usize, values: *mut f64, n: usize) -> c_int;
    fn fmi3SetFloat64(instance: Pointer, references: *const u32, count: usize, values: *const f64, n: usize) -> c_int;
    fn fmi3DoStep(
        i: Pointer,
        start: f64,
        step: f64,
        last: u8,
        event: *mut u8,
        end: *mut u8,
        early: *mut u8,
        time: *mut f64,
    ) -> c_int;
    fn fmi3FreeInstance(instance: Pointer);
}

/// Marsaglia's xorshift: a sequence that a seed brings back.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % limit
    }

    /// Mostly a small number, now and then one that no call should take.
    fn number(&mut self) -> f64 {
        match self.below(16) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::from_bits(self.below(u64::MAX)),
            3 => 0.0,
            _ => self.below(2_000_001) as f64 * 1e-6 - 1.0,
        }
    }
}

/// The panel on disk, and what an importer knows of it.
struct Fmu {
    token: CString,
    path: CString,
    uri: CString,
    variables: u32,
    outputs: Vec<u32>,
    states: usize,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let seconds: u64 = arguments.next().ok_or("usage: fuzz_calls SECONDS [SEED]")?.parse()?;
    let given: Option<u64> = arguments.next().map(|seed| seed.parse()).transpose()?;
    let folder = tempfile::tempdir()?;
    let fmu = prepare(folder.path())?;
    let end = Instant::now() + Duration::from_secs(seconds);
    let (mut seed, mut calls) = (given.unwrap_or(1), 0_u64);
    loop {
        if std::env::var_os("FUZZ_TELL").is_some() {
            eprintln!("seed {seed}");
        }
        // A seed of zero would stay zero.
        calls += sequence(&fmu, &mut Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1))
            .map_err(|failure| format!("seed {seed}: {failure}"))?;
        seed += 1;
        if Instant::now() >= end {
            println!("{calls} calls in {} sequences", seed - given.unwrap_or(1));
            return Ok(());
        }
    }
}

fn prepare(folder: &std::path::Path) -> Result<Fmu, Box<dyn std::error::Error>> {
    let text = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
        "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
        "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#;
    let place = |x| Place { x, y: 0.0 };
    let ports = Ports { forces: vec![place(-0.3), place(0.1)], responses: vec![place(0.3)] };
    let (resource, _) = Resource::of_panel(&PanelModel::from_json(text)?, ModeRange::Count(5), ports)?;
    let text = resource.to_json();
    std::fs::write(folder.join(RESOURCE_FILE), &text)?;
    let path = folder.to_str().ok_or("the temporary folder's name is not UTF-8")?;
    let table = resource.variables();
    let all = table.variables();
    Ok(Fmu {
        token: CString::new(content_token(text.as_bytes()))?,
        path: CString::new(path)?,
        uri: CString::new(format!("file://{path}"))?,
        variables: u32::try_from(all.len())?,
        outputs: all.iter().filter(|v| v.quantity.causality() == "output").map(|v| v.reference).collect(),
        states: 2 * resource.model().modes().len(),
    })
}

/// One instance from its making to its end; returns the number of calls.
fn sequence(fmu: &Fmu, random: &mut Random) -> Result<u64, String> {
    let (three, exchange) = (random.below(2) == 1, random.below(2) == 1);
    let functions = if three { &THREE } else { &TWO };
    let (token, name) = (fmu.token.as_ptr(), c"fuzz".as_ptr());
    let callbacks = [null_mut(); 5];
    // SAFETY: C strings that live through the call; callbacks are null, which the library allows.
    let instance = unsafe {
        match (three, exchange) {
            (true, true) => fmi3InstantiateModelExchange(name, token, fmu.path.as_ptr(), 0, 0, null_mut(), null_mut()),
            (true, false) => fmi3InstantiateCoSimulation(
                name,
                token,
                fmu.path.as_ptr(),
                0,
                0,
                0,
                0,
                null_mut(),
                0,
                null_mut(),
                null_mut(),
                null_mut(),
            ),
            (false, _) => fmi2Instantiate(name, c_int::from(!exchange), token, fmu.uri.as_ptr(), &callbacks, 0, 0),
        }
    };
    if instance.is_null() {
        return Err("not instantiated".into());
    }
    let read = |references: &[u32], values: &mut [f64]| {
        // SAFETY: a live instance and arrays of equal length.
        unsafe {
            if three {
                fmi3GetFloat64(instance, references.as_ptr(), references.len(), values.as_mut_ptr(), values.len())
            } else {
                fmi2GetReal(instance, references.as_ptr(), references.len(), values.as_mut_ptr())
            }
        }
    };
    let outputs = || {
        let mut values = vec![0.0; fmu.outputs.len()];
        (read(&fmu.outputs, &mut values) == 0).then_some(values)
    };
    let mut kept: Pointer = null_mut();
    let mut now = 0.0;
    let count = 1 + random.below(60);
    for _ in 0..count {
        let before = outputs();
        let (status, call) = one_call(fmu, functions, random, instance, three, &mut kept, &mut now);
        let after = outputs();
        if let (true, Some(before), Some(after)) = (status != 0, &before, &after)
            && before != after
        {
            return Err(format!("call {call} was refused and changed the outputs from {before:?} to {after:?}"));
        }
        if let Some(wrong) = after.iter().flatten().find(|value| !value.is_finite()) {
            return Err(format!("after call {call} an output is {wrong}, of {after:?}"));
        }
    }
    // SAFETY: a live instance, not used again.
    unsafe { if three { fmi3FreeInstance(instance) } else { fmi2FreeInstance(instance) } }
    Ok(count)
}

/// One random call; returns its status and its number.
fn one_call(
    fmu: &Fmu,
    functions: &Functions,
    random: &mut Random,
    instance: Pointer,
    three: bool,
    kept: &mut Pointer,
    now: &mut f64,
) -> (c_int, u64) {
    let call = random.below(20);
    let (a, b) = (random.number(), random.number());
    let reference = random.below(u64::from(fmu.variables) + 2) as u32;
    let mut bytes = vec![random.below(256) as u8; 40];
    let mut states: Vec<f64> = (0..fmu.states).map(|_| random.number() * 1e-3).collect();
    // SAFETY: a live instance; arrays have the lengths given; states are handles that the library checks itself.
    let status = unsafe {
        match call {
            0 | 1 if three => fmi3EnterInitializationMode(instance, 0, 0.0, 0.0, u8::from(call == 1), a),
            0 => fmi2EnterInitializationMode(instance),
            1 => fmi2SetupExperiment(instance, 0, 0.0, a, 1, b),
            2 | 3 => (functions.exit)(instance),
            4 => (functions.terminate)(instance),
            5 => {
                *now = 0.0;
                (functions.reset)(instance)
            }
            6 => (functions.event)(instance),
            7 => (functions.continuous)(instance),
            8 => (functions.time)(instance, a),
            9 => (functions.set_states)(instance, states.as_ptr(), states.len()),
            10 => (functions.derivatives)(instance, states.as_mut_ptr(), states.len()),
            11 => (functions.get_state)(instance, kept),
            12 => (functions.set_state)(instance, *kept),
            13 => (functions.free_state)(instance, kept),
            14 => {
                let mut size = 0;
                let status = (functions.size)(instance, *kept, &mut size);
                bytes.resize(size, 0);
                if status != 0 { status } else { (functions.write)(instance, *kept, bytes.as_mut_ptr(), bytes.len()) }
            }
            15 => (functions.read)(instance, bytes.as_ptr(), bytes.len(), kept),
            16 | 17 if three => fmi3SetFloat64(instance, &reference, 1, &a, 1),
            16 | 17 => fmi2SetReal(instance, &reference, 1, &a),
            _ => {
                let step = a.abs() * 1e-3;
                let status = if three {
                    let (mut flags, mut time) = ([0_u8; 3], 0.0);
                    let [event, end, early] = &mut flags;
                    fmi3DoStep(instance, *now, step, 0, event, end, early, &mut time)
                } else {
                    fmi2DoStep(instance, *now, step, 0)
                };
                if status == 0 {
                    *now += step;
                }
                status
            }
        }
    };
    (status, call)
}
