//! FMI 3.0 functions of capabilities that the FMU does not offer.

use std::ffi::c_int;

use super::Reference;
use crate::boundary::not_offered;

not_offered! {
    "providesPerElementDependencies = false":
        fmi3GetNumberOfVariableDependencies(Reference, *mut usize);
        fmi3GetVariableDependencies(Reference, *mut usize, *mut Reference, *mut usize, *mut c_int, usize);
    "no structural parameter":
        fmi3EnterConfigurationMode();
        fmi3ExitConfigurationMode();
    "hasEventMode = false":
        fmi3EnterStepMode();
    "providesEvaluateDiscreteStates = false":
        fmi3EvaluateDiscreteStates();
    "no variable of type Clock":
        fmi3GetIntervalDecimal(*const Reference, usize, *mut f64, *mut c_int);
        fmi3GetIntervalFraction(*const Reference, usize, *mut u64, *mut u64, *mut c_int);
        fmi3GetShiftDecimal(*const Reference, usize, *mut f64);
        fmi3GetShiftFraction(*const Reference, usize, *mut u64, *mut u64);
        fmi3SetIntervalDecimal(*const Reference, usize, *const f64);
        fmi3SetIntervalFraction(*const Reference, usize, *const u64, *const u64);
        fmi3SetShiftDecimal(*const Reference, usize, *const f64);
        fmi3SetShiftFraction(*const Reference, usize, *const u64, *const u64);
    "<ModelExchange> and <CoSimulation> only, no <ScheduledExecution>":
        fmi3ActivateModelPartition(Reference, f64);
}
