//! FMI 3.0, 3.2: model exchange.

use super::Boolean;
use crate::boundary::{array, array_mut, entries, model_exchange_entries, place, transitions};

transitions! {
    fmi3EnterEventMode: enter_event_mode, "event mode";
    fmi3EnterContinuousTimeMode: enter_continuous_time_mode, "continuous-time mode";
}

entries! {
    fmi3UpdateDiscreteStates(
        states_need_update: *mut Boolean, terminate: *mut Boolean, nominals_changed: *mut Boolean,
        values_changed: *mut Boolean, next_event_defined: *mut Boolean, next_event_time: *mut f64
    ) |instance| {
        let answers = [
            place(states_need_update, "discreteStatesNeedUpdate")?,
            place(terminate, "terminateSimulation")?,
            place(values_changed, "valuesOfContinuousStatesChanged")?,
            place(next_event_defined, "nextEventTimeDefined")?,
        ];
        let nominals_changed = place(nominals_changed, "nominalsOfContinuousStatesChanged")?;
        let next_event_time = place(next_event_time, "nextEventTime")?;
        *nominals_changed = Boolean::from(instance.component.update_discrete_states()?);
        answers.into_iter().for_each(|answer| *answer = 0);
        *next_event_time = 0.0;
        Ok(())
    };
    fmi3GetNumberOfEventIndicators(count: *mut usize) |instance| {
        *place(count, "nEventIndicators")? = instance.component.count_for_model_exchange(0)?;
        Ok(())
    };
    fmi3GetNumberOfContinuousStates(count: *mut usize) |instance| {
        *place(count, "nContinuousStates")? =
            instance.component.count_for_model_exchange(instance.component.state_count())?;
        Ok(())
    };
}

model_exchange_entries!(
    fmi3SetTime,
    fmi3SetContinuousStates,
    fmi3GetContinuousStates,
    fmi3GetContinuousStateDerivatives,
    fmi3GetNominalsOfContinuousStates once_instantiated false,
    fmi3GetEventIndicators,
    fmi3CompletedIntegratorStep
);
