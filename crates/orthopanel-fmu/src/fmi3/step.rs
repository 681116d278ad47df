//! FMI 3.0, 4.2: co-simulation steps.

use super::Boolean;
use crate::boundary::{entries, place};

entries! {
    #[frequent]
    fmi3DoStep(
        start: f64, step: f64, _no_state_before: Boolean, event_handling_needed: *mut Boolean,
        terminate_simulation: *mut Boolean, early_return: *mut Boolean, last_successful_time: *mut f64
    ) |instance| {
        let flags = [
            place(event_handling_needed, "eventHandlingNeeded")?,
            place(terminate_simulation, "terminateSimulation")?,
            place(early_return, "earlyReturn")?,
        ];
        let time = place(last_successful_time, "lastSuccessfulTime")?;
        let done = instance.component.do_step(start, step);
        flags.into_iter().for_each(|flag| *flag = 0);
        *time = instance.component.time();
        done
    };
}
