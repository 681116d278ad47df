//! The capability flags of each flavour: the XML is written from these, and a call that is not offered quotes them.

/// Attributes of FMI 2.0 `CoSimulation`.
pub const FMI2_CO_SIMULATION: &[(&str, &str)] = &[
    ("canHandleVariableCommunicationStepSize", "true"),
    ("canInterpolateInputs", "true"),
    ("maxOutputDerivativeOrder", "0"),
    ("canRunAsynchronuously", "false"),
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canNotUseMemoryManagementFunctions", "true"),
    ("canGetAndSetFMUstate", "false"),
    ("canSerializeFMUstate", "false"),
    ("providesDirectionalDerivative", "false"),
];

/// Attributes of FMI 3.0 `CoSimulation`.
pub const FMI3_CO_SIMULATION: &[(&str, &str)] = &[
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canGetAndSetFMUState", "false"),
    ("canSerializeFMUState", "false"),
    ("providesDirectionalDerivatives", "false"),
    ("providesAdjointDerivatives", "false"),
    ("providesPerElementDependencies", "false"),
    ("canHandleVariableCommunicationStepSize", "true"),
    ("maxOutputDerivativeOrder", "0"),
    ("providesIntermediateUpdate", "false"),
    ("mightReturnEarlyFromDoStep", "false"),
    ("canReturnEarlyAfterIntermediateUpdate", "false"),
    ("hasEventMode", "false"),
    ("providesEvaluateDiscreteStates", "false"),
];

/// Log categories with their descriptions, in both versions.
pub const LOG_CATEGORIES: [(&str, &str); 3] = [
    ("logEvents", "What the instance does: instantiated, initialized, reset, terminated"),
    ("logStatusError", "Calls that were refused, and why; always logged"),
    ("logAll", "Both of these"),
];

/// Name of the library, and with it the FMI model identifier.
pub const MODEL_IDENTIFIER: &str = "orthopanel";
