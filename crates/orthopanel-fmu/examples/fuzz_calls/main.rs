//! Random calls in random order on the C functions of both versions: `fuzz_calls SECONDS [SEED]`.
//!
//! No call may panic, crash or give an output that is not a number, nor take an instance where its outputs cannot be read;
//! a call that is refused must leave all that an FMU state holds and all values as they were, and tell the logger why. No
//! call may touch another instance. On a failure the seed of the sequence is printed, and `fuzz_calls 0 SEED` runs that
//! sequence alone. With `FUZZ_TELL` set each seed is printed before it runs, to find a call that does not return.
#![allow(clippy::print_stdout, clippy::print_stderr)]
#![expect(unsafe_code, reason = "an importer in Rust calls C functions")]

use std::ffi::{CStr, c_char, c_int};
use std::ptr::null_mut;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

#[path = "../../tests/c_functions/mod.rs"]
mod c_functions;

mod calls;
mod driven;
mod functions;
mod null_calls;
mod panels;
mod random;

use c_functions::{Pointer, fmi2Instantiate, fmi3InstantiateCoSimulation, fmi3InstantiateModelExchange};
use calls::{Made, one_call};
use driven::Driven;
use functions::Instance;
use panels::{Fmu, prepare};
use random::Random;

/// The status of a call that is refused; it goes with a message.
const ERROR: c_int = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let seconds: u64 = arguments.next().ok_or("usage: fuzz_calls SECONDS [SEED]")?.parse()?;
    let given: Option<u64> = arguments.next().map(|seed| seed.parse()).transpose()?;
    let folder = tempfile::tempdir()?;
    let fmus = prepare(folder.path())?;
    let end = Instant::now() + Duration::from_secs(seconds);
    let (mut seed, mut calls, messages) = (given.unwrap_or(1), 0_u64, AtomicU64::new(0));
    loop {
        if std::env::var_os("FUZZ_TELL").is_some() {
            eprintln!("seed {seed}");
        }
        // A seed of zero would stay zero.
        let random = &mut Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let panel = random.below(fmus.len() as u64) as usize;
        let fmu = fmus.get(panel).ok_or("no panel")?;
        calls +=
            sequence(fmu, random, &messages).map_err(|failure| format!("seed {seed}, panel {panel}: {failure}"))?;
        seed += 1;
        if Instant::now() >= end {
            let (sequences, told) = (seed - given.unwrap_or(1), messages.load(Ordering::Relaxed));
            println!("{calls} calls in {sequences} sequences, {told} messages");
            return Ok(());
        }
    }
}

/// Counts a message; the environment is the counter.
unsafe extern "C" fn count3(environment: Pointer, _status: c_int, category: *const c_char, message: *const c_char) {
    // SAFETY: the environment is the counter that outlives every instance, the texts are C strings.
    let (counter, texts) =
        unsafe { (&*environment.cast::<AtomicU64>(), [category, message].map(|t| CStr::from_ptr(t))) };
    if texts.iter().all(|text| text.to_str().is_ok_and(|text| !text.is_empty())) {
        counter.fetch_add(1, Ordering::Relaxed);
    }
}

/// As [`count3`]. The library gives no variable arguments, so this is called like any function.
unsafe extern "C" fn count2(
    environment: Pointer,
    _instance: *const c_char,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: as there.
    unsafe { count3(environment, status, category, message) }
}

fn instantiate(fmu: &Fmu, [three, exchange, logging]: [bool; 3], messages: &AtomicU64) -> Instance {
    let (token, path, name) = (fmu.token.as_ptr(), fmu.path.as_ptr(), c"fuzz".as_ptr());
    let environment = std::ptr::from_ref(messages).cast_mut().cast();
    let callbacks = [count2 as *mut std::ffi::c_void, null_mut(), null_mut(), null_mut(), environment];
    let (log, none, on) = (count3 as *mut std::ffi::c_void, null_mut(), u8::from(logging));
    // SAFETY: C strings and callbacks that live as long as the instance.
    let pointer = unsafe {
        match (three, exchange) {
            (true, true) => fmi3InstantiateModelExchange(name, token, path, 0, on, environment, log),
            (true, false) => {
                fmi3InstantiateCoSimulation(name, token, path, 0, on, 0, 0, std::ptr::null(), 0, environment, log, none)
            }
            (false, _) => {
                fmi2Instantiate(name, c_int::from(!exchange), token, fmu.uri.as_ptr(), &callbacks, 0, c_int::from(on))
            }
        }
    };
    Instance { pointer, three }
}

/// Two instances of one FMU, perhaps of different versions, from their making to their end; returns the number of calls.
fn sequence(fmu: &Fmu, random: &mut Random, messages: &AtomicU64) -> Result<u64, String> {
    let mut both = [(); 2].map(|()| {
        let chosen = [0; 3].map(|_| random.one_in(2));
        Driven::new(instantiate(fmu, chosen, messages))
    });
    if both.iter().any(|driven| driven.instance.pointer.is_null()) {
        return Err("not instantiated".into());
    }
    let mut written = vec![];
    let count = 1 + random.below(60);
    for _ in 0..count {
        let [one, other] = &mut both;
        let (driven, idle) = if random.one_in(4) { (other, one) } else { (one, other) };
        let before = (driven.bytes()?, driven.values(fmu));
        let idle_before = idle.bytes()?;
        let told = messages.load(Ordering::Relaxed);
        let Made { status, call, may_end_reading } = one_call(fmu, random, driven, &mut written)?;
        if status == ERROR && messages.load(Ordering::Relaxed) == told {
            return Err(format!("call {call} was refused without a message"));
        }
        if idle.bytes()? != idle_before {
            return Err(format!("call {call} changed another instance"));
        }
        let after = (driven.bytes()?, driven.values(fmu));
        if status != 0 && before != after {
            return Err(format!("call {call} was refused and changed the instance from {before:?} to {after:?}"));
        }
        let outputs = driven.outputs(fmu);
        if let Some(wrong) = outputs.iter().flatten().find(|value| !value.is_finite()) {
            return Err(format!("after call {call} an output is {wrong}, of {outputs:?}"));
        }
        if outputs.is_none() && before.1.is_some() && status == 0 && !may_end_reading {
            return Err(format!("after call {call} no output can be read any more"));
        }
    }
    both.into_iter().for_each(|driven| driven.instance.free());
    Ok(count)
}
