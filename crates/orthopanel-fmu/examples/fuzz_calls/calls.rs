//! One random call, and what it may not do.

use std::ffi::c_int;
use std::ptr::null_mut;

use crate::c_functions::{Pointer, fmi2EnterInitializationMode, fmi3EnterInitializationMode};
use crate::functions::{Instance, fmi2SetupExperiment};
use crate::panels::Fmu;

/// Marsaglia's xorshift: a sequence that a seed brings back.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, limit: u64) -> u64 {
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

/// What an importer keeps between calls.
pub struct Kept {
    state: Pointer,
    /// A state as the FMU wrote it.
    bytes: Vec<u8>,
    now: f64,
}

impl Default for Kept {
    fn default() -> Self {
        Self { state: null_mut(), bytes: vec![], now: 0.0 }
    }
}

impl Kept {
    /// The bytes as written, with one of them changed, cut short, or none of ours.
    fn nearly_sound(&self, random: &mut Random) -> Vec<u8> {
        let mut bytes = self.bytes.clone();
        let at = usize::try_from(random.below(bytes.len().max(1) as u64)).unwrap_or(0);
        match (random.below(4), bytes.get_mut(at)) {
            (0, Some(byte)) => *byte ^= 1 << random.below(8),
            (1, Some(_)) => bytes.truncate(at),
            (2, Some(_)) => {}
            _ => bytes = vec![random.below(256) as u8; 40],
        }
        bytes
    }
}

/// Makes one call; its status and its number.
///
/// # Errors
/// A derivative that is no number.
pub fn one_call(fmu: &Fmu, random: &mut Random, instance: Instance, kept: &mut Kept) -> Result<(c_int, u64), String> {
    let call = random.below(25);
    let (a, b) = (random.number(), random.number());
    let any = |random: &mut Random| random.below(u64::from(fmu.variables) + 2) as u32;
    let (reference, other) = (any(random), any(random));
    let mut states: Vec<f64> = (0..fmu.states).map(|_| random.number() * 1e-3).collect();
    let (pointer, functions, mut found) = (instance.pointer, instance.functions(), 0.0);
    // SAFETY: a live instance; arrays have the lengths given; states are handles that the library checks itself.
    let status = unsafe {
        match call {
            0 | 1 if instance.three => fmi3EnterInitializationMode(pointer, 0, 0.0, 0.0, u8::from(call == 1), a),
            0 => fmi2EnterInitializationMode(pointer),
            1 => fmi2SetupExperiment(pointer, 0, 0.0, a, 1, b),
            2 | 3 => (functions.exit)(pointer),
            4 => (functions.terminate)(pointer),
            5 => {
                kept.now = 0.0;
                (functions.reset)(pointer)
            }
            6 => (functions.event)(pointer),
            7 => (functions.continuous)(pointer),
            8 => (functions.time)(pointer, a),
            9 => (functions.set_states)(pointer, states.as_ptr(), states.len()),
            10 => (functions.derivatives)(pointer, states.as_mut_ptr(), states.len()),
            11 => (functions.get_state)(pointer, &mut kept.state),
            12 => (functions.set_state)(pointer, kept.state),
            13 => (functions.free_state)(pointer, &mut kept.state),
            14 => {
                let mut size = 0;
                let status = (functions.size)(pointer, kept.state, &mut size);
                let mut bytes = vec![0; size];
                let status =
                    if status == 0 { (functions.write)(pointer, kept.state, bytes.as_mut_ptr(), size) } else { status };
                if status == 0 {
                    kept.bytes = bytes;
                }
                status
            }
            15 => {
                let bytes = kept.nearly_sound(random);
                (functions.read)(pointer, bytes.as_ptr(), bytes.len(), &mut kept.state)
            }
            16 | 17 => instance.set(reference, a),
            18 | 19 => instance.derivative(call == 18, reference, other, a, &mut found),
            20 => instance.output_derivative(reference, random.below(3) as c_int, &mut found),
            21 => {
                let force = fmu.forces.get(random.below(3) as usize).copied().unwrap_or(reference);
                instance.force_rate(force, random.below(3) as c_int, a)
            }
            _ => {
                let backwards = random.below(8) == 0;
                let step = 1e-3 * if backwards { -a.abs() } else { a.abs() };
                let status = instance.step(kept.now, step);
                if status == 0 {
                    kept.now += step;
                }
                status
            }
        }
    };
    // A seed past a million may bring any number past the largest.
    if status == 0 && (a.abs() < 1e6 || call == 20) && !found.is_finite() {
        return Err(format!("call {call} found a derivative of {found}"));
    }
    Ok((status, call))
}
