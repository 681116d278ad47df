//! FMI 2.0, 2.1.8: FMU states.

use super::Pointer;
use crate::boundary::{array, array_mut, fmu_state_entries, place};

fmu_state_entries!(
    fmi2GetFMUstate,
    fmi2SetFMUstate,
    fmi2FreeFMUstate,
    fmi2SerializedFMUstateSize,
    fmi2SerializeFMUstate,
    fmi2DeSerializeFMUstate
);
