//! FMI 3.0, 2.2.10: FMU states.

use super::Pointer;
use crate::boundary::{array, array_mut, fmu_state_entries, place};

fmu_state_entries!(
    fmi3GetFMUState,
    fmi3SetFMUState,
    fmi3FreeFMUState,
    fmi3SerializedFMUStateSize,
    fmi3SerializeFMUState,
    fmi3DeserializeFMUState
);
