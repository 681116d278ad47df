//! The smallest disbond that a test would show.

use orthopanel_model::{EffectState, Place, STIFFNESS_LOSS, StructureKind, effect};
use rayon::prelude::*;

use super::further_effect::Score;
use super::{Inquiry, log_prior};
use crate::hypothesis::{Role, even_net};
use crate::judge::ODDS;
use crate::outcome::Detectable;
use crate::posterior::Judged;

/// Places along a beam, and along either side of a plate; how far from the middle they go, in parts of half the size.
const PLACES: usize = 13;
const PLACES_EACH_WAY: usize = 5;
const TO: f64 = 0.8;
/// Part of the shear stiffness that a disbond loses.
const LOST: f64 = 0.98;
/// Smallest side of a disbond that is looked at \[m\], and the largest in parts of the piece's smaller side.
const LEAST: f64 = 0.01;
const MOST: f64 = 0.5;
/// Halvings of the logarithm of its side.
const HALVINGS: usize = 6;

impl Inquiry<'_> {
    /// With $d$ what a disbond changes of all that is predicted, $C$ the covariance of noise and model error and $J$ the derivatives by the free
    /// coordinates, whose precision beforehand is $P$, the logarithm of the likelihood is expected to grow by
    /// $$\tfrac12\left(d^TC^{-1}d - d^TC^{-1}J(J^TC^{-1}J + P)^{-1}J^TC^{-1}d\right) .$$
    /// The smallest disbond is the one from which that outweighs the prior odds and leaves those at which effects are named. What its own parameters
    /// take off the evidence, some units of the logarithm, is left out. `None` where no disbond is looked for, where one was found, and where several
    /// pieces or lists were measured.
    pub(crate) fn detectable(&self, chosen: &Judged) -> Option<Detectable> {
        let disbond = effect(STIFFNESS_LOSS).ok()?;
        let holds =
            chosen.hypothesis.parts.iter().any(|part| part.effect.id() == disbond.id() && part.role == Role::Found);
        let [block] = &self.stacked.blocks[..] else { return None };
        if holds || block.comparison().measured.records.is_empty() || self.hidden(disbond).is_some() {
            return None;
        }
        let (point, problem) = (&chosen.posterior.point, self.problem(&chosen.hypothesis));
        let by = problem.whitening(&problem.errors(&point.at), &chosen.posterior.log_sizes)?;
        let score = Score::about(&problem, point, problem.derivatives(point, 0..point.z.len())?, by)?;
        let (constants, effects) = block.values(&chosen.hypothesis, &point.z).ok()?;
        let records = block.comparison().measured.records.len();
        let wanted = 2.0 * (ODDS.ln() - log_prior(self.ways(disbond).len()));
        let piece = block.predictor.piece();
        let is_plate = block.predictor.structure == StructureKind::MindlinPlate;
        let most = MOST * if is_plate { piece.length.min(piece.width) } else { piece.length };
        let shows = |at: Place, span: f64| {
            let y = if is_plate { at.y } else { f64::NAN };
            let state = EffectState::new(disbond, vec![LOST, span, at.x, y], records).ok()?;
            let with = block.predictor.at(&constants, &[&effects[..], &[state]].concat(), true).ok()?;
            Some(score.told_apart(&point.at.values, &with.values) > wanted)
        };
        let smallest = |at: &Place| {
            // A wide one may lose more than the moments of its strain can follow: then there is no plate with it.
            let narrower = std::iter::successors(Some(most), |side| Some(0.5 * side).filter(|half| *half > LEAST));
            let (widest, is_shown) = narrower.into_iter().find_map(|side| Some((side, shows(*at, side)?)))?;
            if !is_shown {
                return None;
            }
            if shows(*at, LEAST)? {
                return Some(LEAST);
            }
            let (mut low, mut high) = (LEAST.ln(), widest.ln());
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *if shows(*at, middle.exp())? { &mut high } else { &mut low } = middle;
            }
            Some(high.exp())
        };
        let net = |size: f64, count: usize| even_net(count, 0.5 * size * TO);
        let places: Vec<Place> = if is_plate {
            let across = net(piece.width, PLACES_EACH_WAY);
            let along = net(piece.length, PLACES_EACH_WAY).into_iter();
            along.flat_map(|x| across.iter().map(move |&y| Place { x, y })).collect()
        } else {
            net(piece.length, PLACES).into_iter().map(|x| Place { x, y: 0.0 }).collect()
        };
        let mut sides: Vec<Option<f64>> = places.par_iter().map(smallest).collect();
        let of = |side: &Option<f64>| side.unwrap_or(f64::INFINITY);
        sides.sort_by(|a, b| of(a).total_cmp(&of(b)));
        Some(Detectable {
            effect: disbond.id(),
            loss: LOST,
            at_half_of_the_places: sides[sides.len() / 2],
            anywhere: *sides.last()?,
            places: sides.len(),
            most,
        })
    }
}
