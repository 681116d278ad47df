//! FMI 2.0 functions of capabilities that the FMU does not offer yet.

use std::ffi::{c_char, c_int};

use super::{Boolean, Pointer, Reference};
use crate::boundary::not_offered;

not_offered! {
    "canGetAndSetFMUstate = false":
        fmi2GetFMUstate(*mut Pointer);
        fmi2SetFMUstate(Pointer);
        fmi2FreeFMUstate(*mut Pointer);
    "canSerializeFMUstate = false":
        fmi2SerializedFMUstateSize(Pointer, *mut usize);
        fmi2SerializeFMUstate(Pointer, *mut c_char, usize);
        fmi2DeSerializeFMUstate(*const c_char, usize, *mut Pointer);
    "providesDirectionalDerivative = false":
        fmi2GetDirectionalDerivative(*const Reference, usize, *const Reference, usize, *const f64, *mut f64);
    "maxOutputDerivativeOrder = 0":
        fmi2GetRealOutputDerivatives(*const Reference, usize, *const c_int, *mut f64);
    "canRunAsynchronuously = false":
        fmi2CancelStep();
    "<CoSimulation> only, no <ModelExchange>":
        fmi2EnterEventMode();
        fmi2NewDiscreteStates(Pointer);
        fmi2EnterContinuousTimeMode();
        fmi2CompletedIntegratorStep(Boolean, *mut Boolean, *mut Boolean);
        fmi2SetTime(f64);
        fmi2SetContinuousStates(*const f64, usize);
        fmi2GetDerivatives(*mut f64, usize);
        fmi2GetEventIndicators(*mut f64, usize);
        fmi2GetContinuousStates(*mut f64, usize);
        fmi2GetNominalsOfContinuousStates(*mut f64, usize);
}
