//! All effects by their ids: a new one is a file beside this and a line below.

use super::{
    Effect, EffectState, channel_delay, cubic_stiffness, edge_mass, exponential_window, gain, hammer_offset, high_pass,
    local_mass, position_error, record_gain, resonator, rotary_inertia, sensor_mass, sensor_resonance, size_error,
    stiffness_loss, support_compliance, suspension, viscoelastic_core, width_coupling,
};
use crate::{EffectEntry, ModelError};

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

impl EffectState {
    /// From an entry of a model file; a parameter that the file leaves out keeps the value it is held at.
    ///
    /// # Errors
    /// [`ModelError::UnknownEffect`], [`ModelError::EffectText`] for a wrong owner or a parameter that is missing or unknown.
    pub fn from_entry(entry: &EffectEntry) -> Result<Self, ModelError> {
        let effect = effect(&entry.id)?;
        let wrong = |what: String| Err(ModelError::EffectText { effect: effect.id(), what });
        if entry.owner != effect.owner().name() {
            return wrong(format!("owner = {:?}, it belongs to the {}", entry.owner, effect.owner().name()));
        }
        let known = effect.parameters();
        if let Some(name) = entry.parameters.keys().find(|name| !known.iter().any(|known| known.name == **name)) {
            let names: Vec<_> = known.iter().map(|parameter| parameter.name).collect();
            return wrong(format!("{name} is no parameter of it: it has {}", names.join(", ")));
        }
        let mut values = Vec::new();
        for parameter in known {
            match entry.parameters.get(parameter.name).map(|estimate| estimate.value).or(parameter.held_at) {
                Some(value) => values.push(value),
                None => return wrong(format!("{} is missing", parameter.name)),
            }
        }
        Self::new(effect, values, 1)
    }
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
