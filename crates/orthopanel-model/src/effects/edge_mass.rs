//! `edge-mass`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Reference, Seat};
use crate::{ModelError, Place};

/// The same mass $m$ \[kg\] at each end, $x = \pm a/2$: edge fillers, frames, or a trim that cut them off (negative).
/// $Z = ms^2$ at both; on a plate spread evenly along both edges.
///
/// Limits: as `local-mass`, a twentieth of the piece's mass may be missing at each end. Source: Newton's law.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeMass;

const PARAMETERS: [EffectParameter; 1] =
    [EffectParameter::linear("mass", "kg", [-0.05, 0.5], &[0.01, -0.01, 0.05]).signed(6e-3, 2.2).of(Reference::Mass)];

impl Effect for EdgeMass {
    fn id(&self) -> &'static str {
        "edge-mass"
    }

    fn owner(&self) -> Owner {
        Owner::Panel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let &[mass] = values else { return Ok(vec![]) };
        let half = 0.5 * setting.piece.length;
        let at = |x: f64| PointElement::on_deflection(ElementLaw::Mass { mass }, Seat::AlongEdge(Place { x, y: 0.0 }));
        Ok(vec![Action::Element(at(-half)), Action::Element(at(half))])
    }
}
