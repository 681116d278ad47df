//! `edge-mass`.

use super::{Action, Effect, EffectParameter, EffectSetting, ElementLaw, Owner, PointElement, Reference, Seat};
use crate::{ModelError, Place};

/// The same mass $m$ \[kg\] at each end, $x = \pm a/2$, and on a plate another at each of $y = \pm b/2$: edge fillers, frames, or a trim that cut them off
/// (negative). $Z = ms^2$; on a plate spread evenly along the edge, $\frac mb\int w^2dy$ and $\frac ma\int w^2dx$.
///
/// A search of a plate takes either pair of edges for itself, and both. Limits: as `local-mass`, a twentieth of the piece's mass may be missing at each
/// edge; a fifth of it at each edge leaves the highest modes that a test asks for 2e-3 too high. Source: Newton's law.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeMass;

const AT_ENDS: EffectParameter = EffectParameter::linear("mass", "kg", [-0.05, 0.5], &[0.01, -0.01, 0.05])
    .signed(6e-3, 2.2)
    .of(Reference::Mass)
    .none_beside_another();

const PARAMETERS: [EffectParameter; 2] = [AT_ENDS, AT_ENDS.across("mass_y")];

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
        let &[at_ends, mass_y] = values else { return Ok(vec![]) };
        let [x, y] = [0.5 * setting.piece.length, 0.5 * setting.piece.width];
        let at = |mass: f64, middle: Place, along_x: bool| {
            let seat = Seat::AlongEdge { middle, along_x };
            Action::Element(PointElement::on_deflection(ElementLaw::Mass { mass }, seat))
        };
        let mut acts: Vec<Action> = [-x, x].map(|x| at(at_ends, Place { x, y: 0.0 }, false)).into();
        if mass_y != 0.0 {
            acts.extend([-y, y].map(|y| at(mass_y, Place { x: 0.0, y }, true)));
        }
        Ok(acts)
    }
}
