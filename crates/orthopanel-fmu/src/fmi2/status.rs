//! FMI 2.0, 4.2.3: status of a step. Steps are synchronous, so only the last successful time and "not terminated"
//! have an answer; all else is discarded.

use std::ffi::c_int;

use super::{Boolean, Pointer, Text};
use crate::FmuError;
use crate::boundary::{self, DISCARD, OK, Status};

const LAST_SUCCESSFUL_TIME: c_int = 2;
const TERMINATED: c_int = 3;
const NO_ANSWER: &str = "canRunAsynchronuously = false: steps return when done, there is no such status";

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(c: Pointer, kind: c_int, value: *mut f64) -> Status {
    // SAFETY: a live instance and a place for the value, under the FMI contract.
    discarded(unsafe {
        boundary::call(c, "fmi2GetRealStatus", |instance| match (kind, value.as_mut()) {
            (_, None) => Err(FmuError::Null("value")),
            (LAST_SUCCESSFUL_TIME, Some(value)) => {
                *value = instance.component.time();
                Ok(())
            }
            _ => Err(FmuError::NotOffered(NO_ANSWER)),
        })
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBooleanStatus(c: Pointer, kind: c_int, value: *mut Boolean) -> Status {
    // SAFETY: a live instance and a place for the value, under the FMI contract.
    discarded(unsafe {
        boundary::call(c, "fmi2GetBooleanStatus", |_| match (kind, value.as_mut()) {
            (_, None) => Err(FmuError::Null("value")),
            (TERMINATED, Some(value)) => {
                *value = 0;
                Ok(())
            }
            _ => Err(FmuError::NotOffered(NO_ANSWER)),
        })
    })
}

/// Defines status calls that never have an answer.
macro_rules! no_answer {
    ($($name:ident($value:ty);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(c: Pointer, _kind: c_int, _value: $value) -> Status {
            // SAFETY: a live instance, under the FMI contract.
            discarded(unsafe { boundary::call(c, stringify!($name), |_| Err(FmuError::NotOffered(NO_ANSWER))) })
        }
    )*};
}

no_answer! {
    fmi2GetStatus(*mut c_int);
    fmi2GetIntegerStatus(*mut c_int);
    fmi2GetStringStatus(*mut Text);
}

/// The standard's status for a question that the FMU does not answer.
fn discarded(status: Status) -> Status {
    if status == OK { OK } else { DISCARD }
}
