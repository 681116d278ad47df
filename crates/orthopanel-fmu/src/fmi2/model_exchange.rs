//! FMI 2.0, 3.2: model exchange.

use super::Boolean;
use crate::boundary::{array, array_mut, entries, model_exchange_entries, place, transitions};

/// `fmi2EventInfo`.
#[repr(C)]
struct EventInfo {
    new_discrete_states_needed: Boolean,
    terminate_simulation: Boolean,
    nominals_of_continuous_states_changed: Boolean,
    values_of_continuous_states_changed: Boolean,
    next_event_time_defined: Boolean,
    next_event_time: f64,
}

transitions! {
    fmi2EnterEventMode: enter_event_mode, "event mode";
    fmi2EnterContinuousTimeMode: enter_continuous_time_mode, "continuous-time mode";
}

entries! {
    fmi2NewDiscreteStates(info: *mut EventInfo) |instance| {
        let info = place(info, "eventInfo")?;
        let nominals_changed = instance.component.update_discrete_states()?;
        *info = EventInfo {
            new_discrete_states_needed: 0,
            terminate_simulation: 0,
            nominals_of_continuous_states_changed: Boolean::from(nominals_changed),
            values_of_continuous_states_changed: 0,
            next_event_time_defined: 0,
            next_event_time: 0.0,
        };
        Ok(())
    };
}

model_exchange_entries!(
    fmi2SetTime,
    fmi2SetContinuousStates,
    fmi2GetContinuousStates,
    fmi2GetDerivatives,
    fmi2GetNominalsOfContinuousStates once_instantiated true,
    fmi2GetEventIndicators,
    fmi2CompletedIntegratorStep
);
