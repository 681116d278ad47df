//! One random call, and what it may not do.

use std::ffi::c_int;

use crate::c_functions::{fmi2EnterInitializationMode, fmi3EnterInitializationMode};
use crate::driven::Driven;
use crate::functions::fmi2SetupExperiment;
use crate::null_calls::null_call;
use crate::panels::Fmu;
use crate::random::Random;

/// Bytes of a state as an instance wrote them, with one of them changed, cut short, or none of ours.
fn nearly_sound(written: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = written.to_vec();
    let at = usize::try_from(random.below(bytes.len().max(1) as u64)).unwrap_or(0);
    match (random.below(4), bytes.get_mut(at)) {
        (0, Some(byte)) => *byte ^= 1 << random.below(8),
        (1, Some(_)) => bytes.truncate(at),
        (2, Some(_)) => {}
        _ => bytes = vec![random.below(256) as u8; 40],
    }
    bytes
}

/// A value for a variable: any number, or as often one near its start, for a constant of 1e10 stands no other.
fn value_for(reference: u32, fmu: &Fmu, random: &mut Random) -> f64 {
    let start = fmu.starts.get((reference as usize).wrapping_sub(1)).copied().unwrap_or(0.0);
    if start != 0.0 && random.one_in(2) {
        start * (0.8 + 0.4e-6 * random.below(1_000_000) as f64)
    } else {
        random.number()
    }
}

/// What a call came to.
pub struct Made {
    pub status: c_int,
    /// Its number.
    pub call: u64,
    /// It may lead before initialization, where nothing is read, or set parameters that are wrong together.
    pub may_end_reading: bool,
}

/// Makes one call. `written` are the bytes of a state, perhaps of the other instance.
///
/// # Errors
/// A derivative that is no number.
pub fn one_call(fmu: &Fmu, random: &mut Random, driven: &mut Driven, written: &mut Vec<u8>) -> Result<Made, String> {
    let call = random.below(30);
    let (a, b) = (random.number(), random.number());
    let any = |random: &mut Random| random.below(u64::from(fmu.variables) + 2) as u32;
    let (reference, other) = (any(random), any(random));
    let mut states: Vec<f64> = (0..fmu.states).map(|_| random.number() * 1e-3).collect();
    let list: Vec<u32> = (0..2 + random.below(5)).map(|_| any(random)).collect();
    let (instance, mut found) = (driven.instance, 0.0);
    let (pointer, functions) = (instance.pointer, instance.functions());
    let mut may_end_tuning = false;
    // SAFETY: a live instance; arrays have the lengths given; states are handles that the library checks itself.
    let status = unsafe {
        match call {
            0 | 1 if instance.three => fmi3EnterInitializationMode(pointer, u8::from(call == 0), b, 0.0, 0, a),
            0 => fmi2EnterInitializationMode(pointer),
            1 => fmi2SetupExperiment(pointer, c_int::from(random.one_in(2)), b, a, 1, b),
            2 | 3 => (functions.exit)(pointer),
            4 => (functions.terminate)(pointer),
            5 => (functions.reset)(pointer),
            6 => (functions.event)(pointer),
            7 => (functions.continuous)(pointer),
            8 => (functions.time)(pointer, a),
            9 => (functions.set_states)(pointer, states.as_ptr(), states.len()),
            10 => (functions.derivatives)(pointer, states.as_mut_ptr(), states.len()),
            11 => (functions.get_state)(pointer, &mut driven.state),
            12 => (functions.set_state)(pointer, driven.state),
            13 => (functions.free_state)(pointer, &mut driven.state),
            14 => {
                *written = driven.bytes()?;
                0
            }
            15 => {
                let bytes = nearly_sound(written, random);
                (functions.read)(pointer, bytes.as_ptr(), bytes.len(), &mut driven.state)
            }
            16 | 17 => instance.set(&[reference], &[value_for(reference, fmu, random)]),
            18 | 19 => instance.derivative(call == 18, reference, other, a, &mut found),
            20 => instance.output_derivative(reference, random.below(3) as c_int, &mut found),
            21 => {
                let force = fmu.forces.get(random.below(3) as usize).copied().unwrap_or(reference);
                instance.force_rate(force, random.below(3) as c_int, a)
            }
            22 => {
                // Now and then of a variable that is no Boolean.
                let other = if random.one_in(4) { reference } else { fmu.force_linear };
                instance.set_boolean(other, random.one_in(2))
            }
            23 => {
                let values: Vec<f64> = list.iter().map(|&reference| value_for(reference, fmu, random)).collect();
                instance.set(&list, &values)
            }
            24 => null_call(driven, fmu, random),
            25 | 26 => {
                let tunable = random.below(fmu.tunable.len() as u64) as usize;
                let chosen = fmu.tunable.get(tunable).copied().unwrap_or(reference);
                // Sizes that were set before the start and places are judged together, later.
                may_end_tuning = !driven.has_started(fmu);
                let before = driven.states(fmu);
                let status = instance.set(&[chosen], &[value_for(chosen, fmu, random)]);
                let after = driven.states(fmu);
                if before.is_some() && after.is_some() && before != after {
                    return Err(format!("call {call} moved the states from {before:?} to {after:?}"));
                }
                status
            }
            _ => {
                let backwards = random.one_in(8);
                let step = 1e-3 * if backwards { -a.abs() } else { a.abs() };
                instance.step(driven.now(fmu), step)
            }
        }
    };
    if status == 0 && !found.is_finite() {
        return Err(format!("call {call} found a derivative of {found}"));
    }
    if status == 0 && call == 24 {
        return Err("a null pointer was taken".into());
    }
    let of_parameter = |reference: &u32| fmu.parameters.contains(reference);
    let may_end_reading = match call {
        5 | 12 => true,
        16 | 17 => of_parameter(&reference),
        25 | 26 => may_end_tuning,
        23 => list.iter().any(of_parameter),
        _ => false,
    };
    Ok(Made { status, call, may_end_reading })
}
