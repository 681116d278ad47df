//! `local-mass`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Reference, Seat};
use crate::{ModelError, Place};

/// A mass $m$ \[kg\] at $x$ (on a plate at $x$, $y$), negative where one is missing: $Z = ms^2$.
///
/// Limits: down to a tenth of the piece's mass may be missing. More of it at a free end, where $W_m^2 = 4/M$, would
/// leave a modal mass without meaning. Source: Newton's law.
#[derive(Debug, Clone, Copy)]
pub(super) struct LocalMass;

const PARAMETERS: [EffectParameter; 3] = [
    EffectParameter::linear("mass", "kg", [-0.1, 0.5], &[0.01, -0.01, 0.05]).signed(1.2e-2, 2.2).of(Reference::Mass),
    EffectParameter::place(),
    EffectParameter::place_across(),
];

impl Effect for LocalMass {
    fn id(&self) -> &'static str {
        "local-mass"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn in_words(&self) -> &'static str {
        "a mass"
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[mass, x, y] = values else { return Ok(vec![]) };
        let seat = Seat::At(Place { x, y });
        Ok(vec![Action::Element(PointElement::on_deflection(ElementLaw::Mass { mass }, seat))])
    }
}
