//! FMI 3.0, 4.2: co-simulation steps.

use super::{Boolean, Pointer};
use crate::FmuError;
use crate::boundary::{self, Status};

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: Pointer,
    start: f64,
    step: f64,
    _no_state_before: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_time: *mut f64,
) -> Status {
    // SAFETY: a live instance and four places for answers, under the FMI contract; null is refused.
    unsafe {
        boundary::call(instance, "fmi3DoStep", |instance| {
            let flags = [
                event_handling_needed.as_mut().ok_or(FmuError::Null("eventHandlingNeeded"))?,
                terminate_simulation.as_mut().ok_or(FmuError::Null("terminateSimulation"))?,
                early_return.as_mut().ok_or(FmuError::Null("earlyReturn"))?,
            ];
            let time = last_successful_time.as_mut().ok_or(FmuError::Null("lastSuccessfulTime"))?;
            let done = instance.component.do_step(start, step);
            flags.into_iter().for_each(|flag| *flag = 0);
            *time = instance.component.time();
            done
        })
    }
}
