//! `sensor-mass`.

use super::{
    Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, RecordSetting, Reference, Seat,
};
use crate::{ModelError, Motion};

/// The sensor's mass $m$ \[kg\] and, where it shows, its moment of inertia $J$ \[kg m²\] about the panel's middle plane, at
/// the record's response place: $Z_w = ms^2$, $Z_\psi = Js^2$. Each record carries its own sensor, and those of one make that
/// sit beside it ([`beside`](super::RecordSetting::beside)).
///
/// Source: Newton's law; coupling of receptances in Bishop and Johnson, The Mechanics of Vibration (1960), chapter 1.
/// Without a response place (natural frequencies heard by ear) there is no sensor and nothing happens.
#[derive(Debug, Clone, Copy)]
pub(super) struct SensorMass;

/// Id of this effect.
pub const SENSOR_MASS: &str = "sensor-mass";

const PARAMETERS: [EffectParameter; 2] = [
    EffectParameter::log("mass", "kg", [1e-5, 0.5], &[0.01, 0.002, 0.05]).sized(8e-3, 2.2).of(Reference::Mass),
    EffectParameter::linear("inertia", "kg m2", [0.0, 1e-3], &[1e-7]).sized(5e-7, 3.0).held_at(0.0),
];

impl Effect for SensorMass {
    fn id(&self) -> &'static str {
        SENSOR_MASS
    }

    fn owner(&self) -> Owner {
        Owner::Rig
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[mass, inertia] = values else { return Ok(vec![]) };
        let RecordSetting { response_at: Some(own), beside, .. } = &setting.record else { return Ok(vec![]) };
        // Where several stay the panel is the same in all records.
        let seats = match &beside[..] {
            [] => vec![Seat::AtResponse],
            others => std::iter::once(own).chain(others).map(|place| Seat::At(*place)).collect(),
        };
        let of_seat = |seat: Seat| {
            let moving = PointElement::on_deflection(ElementLaw::Mass { mass }, seat);
            let turning = PointElement::on_deflection(ElementLaw::Mass { mass: inertia }, seat);
            [moving, PointElement { motion: Motion::Rotation, ..turning }].map(Action::Element)
        };
        Ok(seats.into_iter().flat_map(of_seat).collect())
    }
}
