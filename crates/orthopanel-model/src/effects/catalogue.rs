//! All effects by their ids: a new one is a file beside this and a line below.

use super::{
    Effect, channel_delay, cubic_stiffness, edge_mass, exponential_window, gain, hammer_offset, high_pass, local_mass,
    position_error, record_gain, resonator, rotary_inertia, sensor_mass, sensor_resonance, size_error, stiffness_loss,
    support_compliance, suspension, viscoelastic_core, width_coupling,
};
use crate::ModelError;

static CATALOGUE: [&dyn Effect; 20] = [
    &sensor_mass::SensorMass,
    &suspension::Suspension,
    &local_mass::LocalMass,
    &edge_mass::EdgeMass,
    &stiffness_loss::StiffnessLoss,
    &resonator::Resonator,
    &rotary_inertia::RotaryInertia,
    &viscoelastic_core::ViscoelasticCore,
    &width_coupling::WidthCoupling,
    &cubic_stiffness::CubicStiffness,
    &channel_delay::ChannelDelay,
    &sensor_resonance::SensorResonance,
    &high_pass::HighPass,
    &exponential_window::ExponentialWindow,
    &gain::Gain,
    &record_gain::RecordGain,
    &hammer_offset::HammerOffset,
    &support_compliance::SupportCompliance,
    &position_error::PositionError,
    &size_error::SizeError,
];

/// All effects.
pub fn catalogue() -> &'static [&'static dyn Effect] {
    &CATALOGUE
}

/// The effect with this id.
///
/// # Errors
/// [`ModelError::UnknownEffect`] lists the known ones.
pub fn effect(id: &str) -> Result<&'static dyn Effect, ModelError> {
    CATALOGUE.iter().copied().find(|effect| effect.id() == id).ok_or_else(|| ModelError::UnknownEffect {
        id: id.into(),
        known: CATALOGUE.iter().map(|effect| effect.id()).collect::<Vec<_>>().join(", "),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_is_found_by_its_id_and_no_other() {
        for known in catalogue() {
            assert_eq!(effect(known.id()).expect("known").id(), known.id());
        }
        let said = effect("glue").err().expect("unknown").to_string();
        assert!(
            said.starts_with("effect \"glue\" is not in the catalogue: take one of sensor-mass, suspension"),
            "{said}"
        );
    }

    #[test]
    fn starting_values_lie_inside_the_bounds() {
        let piece = crate::Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        for effect in catalogue() {
            for parameter in effect.parameters() {
                let (low, high) = parameter.range(&piece);
                let starts = parameter.starts(&piece);
                assert!(!starts.is_empty() && low < high, "{} {}", effect.id(), parameter.name);
                assert!(starts.iter().all(|start| (low..=high).contains(start)), "{} {}", effect.id(), parameter.name);
            }
        }
    }
}
