//! The capability flags of each flavour: the XML is written from these, and a call that is not offered quotes them.

/// Attributes of FMI 2.0 `ModelExchange`.
pub const FMI2_MODEL_EXCHANGE: &[(&str, &str)] = &[
    ("completedIntegratorStepNotNeeded", "true"),
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canNotUseMemoryManagementFunctions", "true"),
    ("canGetAndSetFMUstate", "true"),
    ("canSerializeFMUstate", "true"),
    ("providesDirectionalDerivative", "true"),
];

/// Attributes of FMI 2.0 `CoSimulation`.
pub const FMI2_CO_SIMULATION: &[(&str, &str)] = &[
    ("canHandleVariableCommunicationStepSize", "true"),
    ("canInterpolateInputs", "true"),
    ("maxOutputDerivativeOrder", "1"),
    ("canRunAsynchronuously", "false"),
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canNotUseMemoryManagementFunctions", "true"),
    ("canGetAndSetFMUstate", "true"),
    ("canSerializeFMUstate", "true"),
    ("providesDirectionalDerivative", "true"),
];

/// Attributes of FMI 3.0 `ModelExchange`.
pub const FMI3_MODEL_EXCHANGE: &[(&str, &str)] = &[
    ("needsCompletedIntegratorStep", "false"),
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canGetAndSetFMUState", "true"),
    ("canSerializeFMUState", "true"),
    ("providesDirectionalDerivatives", "true"),
    ("providesAdjointDerivatives", "true"),
    ("providesPerElementDependencies", "false"),
    ("providesEvaluateDiscreteStates", "false"),
];

/// Attributes of FMI 3.0 `CoSimulation`.
pub const FMI3_CO_SIMULATION: &[(&str, &str)] = &[
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canGetAndSetFMUState", "true"),
    ("canSerializeFMUState", "true"),
    ("providesDirectionalDerivatives", "true"),
    ("providesAdjointDerivatives", "true"),
    ("providesPerElementDependencies", "false"),
    ("canHandleVariableCommunicationStepSize", "true"),
    ("maxOutputDerivativeOrder", "1"),
    ("providesIntermediateUpdate", "false"),
    ("mightReturnEarlyFromDoStep", "false"),
    ("canReturnEarlyAfterIntermediateUpdate", "false"),
    ("hasEventMode", "false"),
    ("providesEvaluateDiscreteStates", "false"),
];

/// Log categories with their descriptions, in both versions.
pub const LOG_CATEGORIES: [(&str, &str); 3] = [
    ("logEvents", "What the instance does: instantiated, initialized, changed mode, reset, terminated"),
    ("logStatusError", "Calls that were refused, and why; always logged"),
    ("logAll", "Both of these"),
];
