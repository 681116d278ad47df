//! FMI 2.0, 4.2.3: status of a step. Steps are synchronous, so only the last successful time and "not terminated"
//! have an answer; all else is discarded.

use std::ffi::c_int;

use super::{Boolean, Pointer, Text};
use crate::FmuError;
use crate::boundary::{self, DISCARD, Instance, OK, Status, place};

const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;
const NO_ANSWER: &str = "canRunAsynchronuously = false: steps return when done, there is no such status";

/// Runs a status call: refused as any other for null pointers; a question that the FMU does not answer is discarded.
///
/// # Safety
/// `c` is null or a live instance that no other call is using, `value` null or a place for the answer.
unsafe fn answer<T>(c: Pointer, call: &str, value: *mut T, ask: impl FnOnce(&mut Instance) -> Option<T>) -> Status {
    let mut asked = false;
    // SAFETY: the caller passes a live instance and a place for the value, or null.
    let status = unsafe {
        boundary::call(c, call, |instance| {
            let value = place(value, "value")?;
            asked = true;
            *value = ask(instance).ok_or(FmuError::NotOffered(NO_ANSWER))?;
            Ok(())
        })
    };
    if status != OK && asked { DISCARD } else { status }
}

/// Defines status calls; what has no answer is `None`.
macro_rules! status_calls {
    ($($name:ident($value:ty) |$instance:pat_param, $kind:pat_param| $answer:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(c: Pointer, kind: c_int, value: *mut $value) -> Status {
            // SAFETY: a live instance and a place for the value, under the FMI contract.
            unsafe {
                answer(c, stringify!($name), value, |instance| {
                    let ($instance, $kind) = (instance, kind);
                    $answer
                })
            }
        }
    )*};
}

status_calls! {
    fmi2GetRealStatus(f64) |instance, kind| (kind == LAST_SUCCESSFUL_TIME).then(|| instance.component.time());
    fmi2GetBooleanStatus(Boolean) |_, kind| (kind == TERMINATED).then_some(0);
    fmi2GetStatus(c_int) |_, _| None;
    fmi2GetIntegerStatus(c_int) |_, _| None;
    fmi2GetStringStatus(Text) |_, _| None;
}
