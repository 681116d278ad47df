//! A place that one effect finds, from which the other effects that sit at a place begin once more.

use orthopanel_model::Effect;
use rayon::prelude::*;

use super::{Inquiry, with_one_more};
use crate::effect_places::has_place;
use crate::hypothesis::Part;
use crate::posterior::{Judged, Point};

/// Rounds of the posterior from there.
const ROUNDS: usize = 4;
/// Places that lie no further apart are one, in parts of the length.
const SAME: f64 = 0.025;

/// The effect that was added last.
fn added(judged: &Judged) -> Option<&Part> {
    judged.hypothesis.parts.last()
}

impl Inquiry<'_> {
    /// Effects that sit at a place of a plate compete at one place: a net of starts may lead a mass elsewhere than the bracket, a mass on a spring, that explains
    /// the same. Each that ended elsewhere, or nowhere, is followed from where the likeliest ends, with its constants, its place and all else that both
    /// have by name.
    pub(super) fn at_found_place(
        &self,
        base: &Judged,
        effects: &[&'static dyn Effect],
        judged: &[(Judged, bool)],
    ) -> Vec<(Judged, bool)> {
        let likeliest = judged.iter().map(|(judged, _)| judged).max_by(|a, b| a.log_odds.total_cmp(&b.log_odds));
        // A beam's net is close enough, and its rates were judged without.
        let Some(found) = likeliest.filter(|_| self.is_plate()) else { return vec![] };
        let Some(part) = added(found).filter(|part| has_place(part.effect)) else { return vec![] };
        let own = base.posterior.point.z.len();
        let near = SAME * self.predictor().piece().length;
        let values = part.named(&found.posterior.point.z[own..]);
        let is_there = |(name, value): &(&str, f64)| {
            let here = values.iter().find(|(other, _)| other == name).map(|(_, here)| here);
            !matches!(*name, "x" | "y") || here.is_some_and(|here| (here - value).abs() < near)
        };
        let ended_there = |effect: &dyn Effect| {
            let of_effect = |judged: &Judged| {
                let part = added(judged).filter(|part| part.effect.id() == effect.id())?;
                Some(part.named(&judged.posterior.point.z[own..]).iter().all(is_there))
            };
            judged.iter().find_map(|(judged, _)| of_effect(judged)).unwrap_or(false)
        };
        let others = effects
            .iter()
            .copied()
            .filter(|effect| has_place(*effect) && effect.id() != part.effect.id() && !ended_there(*effect));
        let others: Vec<&'static dyn Effect> = others.collect();
        let more = others.into_par_iter().filter_map(|effect| self.beside_end_of(found, base, effect));
        more.map(|judged| (judged, true)).collect()
    }

    /// An effect in the place of the last one of a hypothesis, from where that ends.
    fn beside_end_of(&self, found: &Judged, base: &Judged, effect: &'static dyn Effect) -> Option<Judged> {
        let (end, sizes) = (&found.posterior.point, &found.posterior.log_sizes);
        let own = base.posterior.point.z.len();
        let by = self.problem(&found.hypothesis).whitening(&self.stacked.errors(&end.at), sizes)?;
        let values = added(found)?.named(&end.z[own..]);
        let ways = self.ways(effect);
        let start = |way: &Part| -> Option<Judged> {
            let hypothesis = base.hypothesis.with(way.clone());
            let problem = self.problem(&hypothesis);
            let starts = way.starts_at(&values).into_iter();
            let points = starts.filter_map(|start| problem.point([&end.z[..own], &start].concat(), &by));
            let point: Point = points.min_by(|a, b| a.misfit.total_cmp(&b.misfit))?;
            let posterior = problem.posterior(point, *sizes, ROUNDS)?;
            Some(with_one_more(base, hypothesis, posterior, ways.len()))
        };
        ways.iter().filter_map(start).max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))
    }
}
