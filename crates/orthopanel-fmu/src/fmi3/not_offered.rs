//! FMI 3.0 functions of capabilities that the FMU does not offer yet.

use std::ffi::c_int;

use super::{Boolean, Pointer, Reference};
use crate::boundary::not_offered;

not_offered! {
    "canGetAndSetFMUState = false":
        fmi3GetFMUState(*mut Pointer);
        fmi3SetFMUState(Pointer);
        fmi3FreeFMUState(*mut Pointer);
    "canSerializeFMUState = false":
        fmi3SerializedFMUStateSize(Pointer, *mut usize);
        fmi3SerializeFMUState(Pointer, *mut u8, usize);
        fmi3DeserializeFMUState(*const u8, usize, *mut Pointer);
    "providesDirectionalDerivatives = false":
        fmi3GetDirectionalDerivative(*const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64,
            usize);
    "providesAdjointDerivatives = false":
        fmi3GetAdjointDerivative(*const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize);
    "providesPerElementDependencies = false":
        fmi3GetNumberOfVariableDependencies(Reference, *mut usize);
        fmi3GetVariableDependencies(Reference, *mut usize, *mut Reference, *mut usize, *mut c_int, usize);
    "maxOutputDerivativeOrder = 0":
        fmi3GetOutputDerivatives(*const Reference, usize, *const i32, *mut f64, usize);
    "no structural parameter":
        fmi3EnterConfigurationMode();
        fmi3ExitConfigurationMode();
    "hasEventMode = false":
        fmi3EnterEventMode();
        fmi3EnterStepMode();
        fmi3UpdateDiscreteStates(*mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64);
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
    "<CoSimulation> only, no <ModelExchange>":
        fmi3EnterContinuousTimeMode();
        fmi3CompletedIntegratorStep(Boolean, *mut Boolean, *mut Boolean);
        fmi3SetTime(f64);
        fmi3SetContinuousStates(*const f64, usize);
        fmi3GetContinuousStateDerivatives(*mut f64, usize);
        fmi3GetEventIndicators(*mut f64, usize);
        fmi3GetContinuousStates(*mut f64, usize);
        fmi3GetNominalsOfContinuousStates(*mut f64, usize);
        fmi3GetNumberOfEventIndicators(*mut usize);
        fmi3GetNumberOfContinuousStates(*mut usize);
    "<CoSimulation> only, no <ScheduledExecution>":
        fmi3ActivateModelPartition(Reference, f64);
}
