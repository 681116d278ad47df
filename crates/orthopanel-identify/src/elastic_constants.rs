//! Which constants a test holds, and when a value found is none.

use orthopanel_data::ImpactTest;
use orthopanel_model::{BEAM_CONSTANTS, Constant};

use crate::IdentifyError;

/// The values at which the test holds constants, in the structure's order; free ones are `None`.
pub(crate) fn held_constants(test: &ImpactTest) -> Result<[Option<f64>; 2], IdentifyError> {
    for name in test.constants.keys() {
        if BEAM_CONSTANTS.iter().all(|constant| constant.name != name) {
            let known = BEAM_CONSTANTS.map(|constant| constant.name).join(", ");
            return Err(IdentifyError::UnknownConstant { name: name.clone(), known });
        }
    }
    let held = BEAM_CONSTANTS.map(|constant| test.constants.get(constant.name).copied());
    for (constant, value) in BEAM_CONSTANTS.iter().zip(held) {
        value.map_or(Ok(()), |value| constant.check(value))?;
    }
    Ok(held)
}

/// Refuses a minimum that lies on a bound: such a value is the bound's, not the data's. `logs` begins with the
/// logarithms of the `free` constants.
pub(crate) fn refuse_bounds(constants: &[Constant], free: &[usize], logs: &[f64]) -> Result<(), IdentifyError> {
    for (log, &index) in logs.iter().zip(free) {
        let Constant { name, unit, low, high } = constants[index];
        if log - low.ln() < 1e-6 || high.ln() - log < 1e-6 {
            return Err(IdentifyError::OnBound { name, value: log.exp(), unit });
        }
    }
    Ok(())
}
