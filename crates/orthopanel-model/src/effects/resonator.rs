//! `resonator`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Reference, Seat};
use crate::{ModelError, Place};

/// A mass $m$ \[kg\] on a spring and a dashpot at $x$ \[m\] (on a plate at $x$, $y$): a loose bracket, a cable. Alone it has the frequency $\omega_0/2\pi$ \[Hz\] and
/// the damping ratio $\zeta$ \[1\].
/// $$Z(s) = ms^2\,\frac{\omega_0^2 + 2\zeta\omega_0s}{s^2 + 2\zeta\omega_0s + \omega_0^2}$$
///
/// Source: the dynamic absorber, Den Hartog, Mechanical Vibrations (1934), chapter 3.
#[derive(Debug, Clone, Copy)]
pub(super) struct Resonator;

const PARAMETERS: [EffectParameter; 5] = [
    EffectParameter::log("mass", "kg", [1e-5, 0.5], &[0.01, 0.05]).sized(1.2e-2, 2.0).of(Reference::Mass),
    EffectParameter::log("frequency", "Hz", [5.0, 2e4], &[100.0, 300.0, 600.0, 1000.0, 1700.0, 2500.0, 3500.0])
        .sized(800.0, 2.3),
    EffectParameter::log("zeta", "1", [1e-4, 0.9], &[0.02, 0.1]).sized(0.02, 2.0),
    EffectParameter::place(),
    EffectParameter::place_across(),
];

impl Effect for Resonator {
    fn id(&self) -> &'static str {
        "resonator"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn in_words(&self) -> &'static str {
        "a mass on a spring"
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[mass, frequency, zeta, x, y] = values else { return Ok(vec![]) };
        let law = ElementLaw::Resonator { mass, frequency, zeta };
        Ok(vec![Action::Element(PointElement::on_deflection(law, Seat::At(Place { x, y })))])
    }
}
